//! Declarations of attributes: `<key id="d0" for="edge" attr.name="weight">`, maybe a default.

use std::collections::HashMap;
use std::io::Read;

use super::document::{Document, Element};
use super::error::GraphMlError;
use crate::formats::archive::listed;
use crate::formats::options::Attributes;
use crate::formats::text::quoted;

/// What an attribute belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Domain {
    Nodes,
    Edges,
    All,
    /// The graph or the file as a whole, ports, hyperedges.
    Other,
}

struct Key {
    domain: Domain,
    name: String,
    default: Option<String>,
}

/// All keys of a file, by declaration and by `id`.
#[derive(Default)]
pub(super) struct Keys {
    keys: Vec<Key>,
    of_id: HashMap<String, usize>,
}

/// An attribute to be read: its key, its name and its value where a node or edge has none.
#[derive(Clone)]
pub(super) struct Wanted {
    pub(super) key: usize,
    pub(super) name: String,
    pub(super) default: Option<String>,
}

/// Keys of the attributes to be read.
pub(super) struct WantedKeys {
    pub(super) weight: Option<Wanted>,
    pub(super) label: Option<Wanted>,
    pub(super) group: Option<Wanted>,
    pub(super) position: Vec<Wanted>,
}

impl Keys {
    /// Takes a `key` element with its content.
    pub(super) fn declare<R: Read>(
        &mut self,
        element: &Element,
        document: &mut Document<R>,
    ) -> Result<(), GraphMlError> {
        let id = element.required("id")?;
        if self.of_id.insert(id.to_owned(), self.keys.len()).is_some() {
            let (line, column) = (element.place.line, element.place.column);
            return Err(GraphMlError::DuplicateId { line, column, what: "key", id: quoted(id) });
        }
        let domains = [
            ("node", Domain::Nodes),
            ("edge", Domain::Edges),
            ("all", Domain::All),
            ("graph", Domain::Other),
            ("graphml", Domain::Other),
            ("port", Domain::Other),
            ("hyperedge", Domain::Other),
            ("endpoint", Domain::Other),
        ];
        let domain = element.choice("for", "`node`, `edge`, `graph` or `all`", &domains)?;
        let name = element.attribute("attr.name").unwrap_or(id).to_owned();
        let mut default = None;
        while let Some(child) = document.child("key")? {
            match child.name.as_str() {
                "default" => default = document.text("default")?,
                _ => document.skip(&child.name)?,
            }
        }
        self.keys.push(Key { domain: domain.unwrap_or(Domain::All), name, default });
        Ok(())
    }

    /// The key that a `data` element refers to.
    pub(super) fn key(&self, data: &Element) -> Result<usize, GraphMlError> {
        let id = data.required("key")?;
        self.of_id.get(id).copied().ok_or_else(|| {
            let (line, column) = (data.place.line, data.place.column);
            GraphMlError::UnknownKey { line, column, key: quoted(id) }
        })
    }

    /// Finds the attributes to be read, which must be declared by now.
    pub(super) fn find(&self, attributes: &Attributes) -> Result<WantedKeys, GraphMlError> {
        let one = |name: &Option<String>, domain| {
            name.as_ref().map(|name| self.wanted(name, domain)).transpose()
        };
        let position = attributes.position.iter().map(|name| self.wanted(name, Domain::Nodes));
        Ok(WantedKeys {
            weight: one(&attributes.weight, Domain::Edges)?,
            label: one(&attributes.label, Domain::Nodes)?,
            group: one(&attributes.group, Domain::Nodes)?,
            position: position.collect::<Result<_, _>>()?,
        })
    }

    fn wanted(&self, name: &str, domain: Domain) -> Result<Wanted, GraphMlError> {
        let is_of_domain = |key: &Key| key.domain == domain || key.domain == Domain::All;
        let found = self.keys.iter().position(|key| key.name == name && is_of_domain(key));
        let Some(key) = found else {
            let names = self.keys.iter().filter(|key| is_of_domain(key));
            let names: Vec<String> = names.map(|key| key.name.clone()).collect();
            let domain = if domain == Domain::Edges { "edges" } else { "nodes" };
            let (wanted, found) = (quoted(name), listed(&names));
            return Err(GraphMlError::NoSuchAttribute { wanted, domain, found });
        };
        Ok(Wanted { key, name: name.to_owned(), default: self.keys[key].default.clone() })
    }
}
