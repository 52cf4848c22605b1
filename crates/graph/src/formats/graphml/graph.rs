//! The nodes and edges of a `graph` element, and the network that they make.

use std::collections::HashMap;
use std::io::Read;

use super::document::{Document, Element, Place};
use super::error::GraphMlError;
use super::keys::{Keys, Wanted, WantedKeys};
use crate::formats::text::quoted;
use crate::{Group, RawNetwork};

/// All that is read of a graph. Nodes count in order of first mention until the end.
#[derive(Default)]
pub(super) struct Graph {
    of_id: HashMap<String, usize>,
    ids: Vec<String>,
    /// Place of each node among the declared ones.
    numbers: Vec<Option<usize>>,
    nodes: Vec<Node>,
    edges: Vec<Edge>,
    directed: bool,
    has_positions: bool,
}

struct Node {
    label: String,
    group: Option<String>,
    position: [f64; 3],
}

struct Edge {
    source: usize,
    target: usize,
    weight: f64,
    directed: bool,
    place: Place,
}

/// Values of a node or an edge, by key.
type Values = Vec<(usize, String)>;

impl Graph {
    /// Takes a `graph` element with its content.
    pub(super) fn read<R: Read>(
        element: &Element,
        document: &mut Document<R>,
        keys: &Keys,
        wanted: &WantedKeys,
    ) -> Result<Self, GraphMlError> {
        let defaults = [("directed", true), ("undirected", false)];
        let expected = "`directed` or `undirected`";
        element.required("edgedefault")?;
        let directed = element.choice("edgedefault", expected, &defaults)? == Some(true);
        let has_positions = !wanted.position.is_empty();
        let mut graph = Self { directed, has_positions, ..Self::default() };
        while let Some(child) = document.child("graph")? {
            match child.name.as_str() {
                "node" => graph.add_node(&child, document, keys, wanted)?,
                "edge" => graph.add_edge(&child, document, keys, wanted)?,
                "desc" | "data" | "locator" => document.skip(&child.name)?,
                name => return Err(unexpected(&child, "a node or an edge", name)),
            }
        }
        Ok(graph)
    }

    fn add_node<R: Read>(
        &mut self,
        element: &Element,
        document: &mut Document<R>,
        keys: &Keys,
        wanted: &WantedKeys,
    ) -> Result<(), GraphMlError> {
        let id = element.required("id")?;
        let node = self.mention(id);
        if self.numbers[node].replace(self.nodes.len()).is_some() {
            let Place { line, column } = element.place;
            return Err(GraphMlError::DuplicateId { line, column, what: "node", id: quoted(id) });
        }
        let values = values("node", document, keys)?;
        let label = match &wanted.label {
            Some(wanted) => value(&values, wanted)
                .ok_or_else(|| missing_value(element, "node", wanted))?
                .to_owned(),
            None => id.to_owned(),
        };
        let group = wanted.group.as_ref().and_then(|wanted| value(&values, wanted));
        let group = group.map(str::to_owned);
        let mut position = [0.0; 3];
        for (coordinate, wanted) in position.iter_mut().zip(&wanted.position) {
            *coordinate = number(element, "node", &values, wanted)?;
        }
        self.nodes.push(Node { label, group, position });
        Ok(())
    }

    fn add_edge<R: Read>(
        &mut self,
        element: &Element,
        document: &mut Document<R>,
        keys: &Keys,
        wanted: &WantedKeys,
    ) -> Result<(), GraphMlError> {
        let source = self.mention(element.required("source")?);
        let target = self.mention(element.required("target")?);
        let words = [("true", true), ("false", false), ("1", true), ("0", false)];
        let own = element.choice("directed", "`true` or `false`", &words)?;
        let values = values("edge", document, keys)?;
        let weight = match &wanted.weight {
            Some(wanted) => number(element, "edge", &values, wanted)?,
            None => 1.0,
        };
        let directed = own.unwrap_or(self.directed);
        self.edges.push(Edge { source, target, weight, directed, place: element.place });
        Ok(())
    }

    /// The node of that `id`, which may be declared later.
    fn mention(&mut self, id: &str) -> usize {
        if let Some(&node) = self.of_id.get(id) {
            return node;
        }
        let node = self.ids.len();
        self.of_id.insert(id.to_owned(), node);
        self.ids.push(id.to_owned());
        self.numbers.push(None);
        node
    }

    pub(super) fn into_network(self) -> Result<RawNetwork, GraphMlError> {
        self.refuse_unknown_nodes()?;
        self.refuse_duplicates()?;
        let number = |node: usize| self.numbers[node].expect("unknown nodes have been refused");
        let mut entries = Vec::with_capacity(2 * self.edges.len());
        for edge in &self.edges {
            let (source, target) = (number(edge.source), number(edge.target));
            entries.push((target, source, edge.weight));
            if !edge.directed && source != target {
                entries.push((source, target, edge.weight));
            }
        }
        // Without edges, what they would be by default decides.
        let directed = match self.edges.as_slice() {
            [] => self.directed,
            edges => edges.iter().any(|edge| edge.directed),
        };
        let groups = groups(&self.nodes);
        let positions = self.has_positions.then(|| self.nodes.iter().map(|n| n.position).collect());
        let labels = self.nodes.into_iter().map(|node| node.label).collect();
        let network = RawNetwork::new(labels, &entries, directed)?.with_groups(groups)?;
        Ok(match positions {
            Some(positions) => network.with_positions(positions)?,
            None => network,
        })
    }

    fn refuse_unknown_nodes(&self) -> Result<(), GraphMlError> {
        for edge in &self.edges {
            let ends = [edge.source, edge.target];
            if let Some(&node) = ends.iter().find(|&&node| self.numbers[node].is_none()) {
                let Place { line, column } = edge.place;
                let node = quoted(&self.ids[node]);
                return Err(GraphMlError::UnknownNode { line, column, node });
            }
        }
        Ok(())
    }

    /// Sorts by direction and then line, so that a repetition stands beside what it repeats.
    fn refuse_duplicates(&self) -> Result<(), GraphMlError> {
        let mut arcs = Vec::with_capacity(2 * self.edges.len());
        for (e, edge) in self.edges.iter().enumerate() {
            arcs.push((edge.source, edge.target, e));
            if !edge.directed && edge.source != edge.target {
                arcs.push((edge.target, edge.source, e));
            }
        }
        arcs.sort_unstable();
        let is_repeated =
            |pair: &&[(usize, usize, usize)]| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1);
        let Some(pair) = arcs.windows(2).filter(is_repeated).min_by_key(|pair| pair[1].2) else {
            return Ok(());
        };
        let (first, second) = (&self.edges[pair[0].2], &self.edges[pair[1].2]);
        Err(GraphMlError::DuplicateEdge {
            line: second.place.line,
            first_line: first.place.line,
            from: quoted(&self.ids[second.source]),
            to: quoted(&self.ids[second.target]),
        })
    }
}

/// Reads the `data` of a node or an edge; nothing else in it makes a network.
fn values<R: Read>(
    parent: &'static str,
    document: &mut Document<R>,
    keys: &Keys,
) -> Result<Values, GraphMlError> {
    let mut values = Values::new();
    while let Some(child) = document.child(parent)? {
        match child.name.as_str() {
            "data" => {
                let key = keys.key(&child)?;
                if let Some(text) = document.text("data")? {
                    values.push((key, text));
                }
            }
            "desc" | "port" | "locator" => document.skip(&child.name)?,
            name => return Err(unexpected(&child, "data", name)),
        }
    }
    Ok(values)
}

fn unexpected(element: &Element, expected: &'static str, name: &str) -> GraphMlError {
    let Place { line, column } = element.place;
    GraphMlError::Unexpected { line, column, expected, found: format!("<{}>", quoted(name)) }
}

fn value<'a>(values: &'a Values, wanted: &'a Wanted) -> Option<&'a str> {
    let own = values.iter().find(|(key, _)| *key == wanted.key).map(|(_, text)| text);
    own.or(wanted.default.as_ref()).map(String::as_str)
}

fn missing_value(element: &Element, kind: &'static str, wanted: &Wanted) -> GraphMlError {
    let Place { line, column } = element.place;
    let attribute = quoted(&wanted.name);
    GraphMlError::MissingValue { line, column, element: kind, attribute }
}

fn number(
    element: &Element,
    kind: &'static str,
    values: &Values,
    wanted: &Wanted,
) -> Result<f64, GraphMlError> {
    let Some(text) = value(values, wanted) else {
        return Err(missing_value(element, kind, wanted));
    };
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => {
            let Place { line, column } = element.place;
            let (attribute, found) = (quoted(&wanted.name), quoted(text));
            Err(GraphMlError::BadNumber { line, column, attribute, found })
        }
    }
}

/// Groups in order of their first node.
fn groups(nodes: &[Node]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut of_name = HashMap::new();
    for (node, name) in nodes.iter().enumerate().filter_map(|(i, n)| Some((i, n.group.as_ref()?))) {
        let group = *of_name.entry(name).or_insert_with(|| {
            groups.push(Group { name: name.clone(), nodes: Vec::new() });
            groups.len() - 1
        });
        groups[group].nodes.push(node);
    }
    groups
}
