//! GraphML: graphs as XML, with declared attributes of nodes and edges.
//!
//! ```xml
//! <graphml xmlns="http://graphml.graphdrawing.org/xmlns">
//!   <key id="d0" for="edge" attr.name="weight" attr.type="double"/>
//!   <graph edgedefault="directed">
//!     <node id="V1"/> <node id="A1"/>
//!     <edge source="V1" target="A1"> <data key="d0">1.5</data> </edge>
//!   </graph>
//! </graphml>
//! ```
//!
//! The source of a directed edge drives its target: a_ij is the weight of the edge from j to i.
//!
//! Source: Brandes, Eiglsperger, Herman, Himsolt & Marshall, "GraphML Progress Report", Lecture
//! Notes in Computer Science 2265, 501 (2002).

mod document;
mod error;
mod graph;
mod keys;

use std::io::Read;

use self::document::Document;
pub use self::error::GraphMlError;
use self::graph::Graph;
use self::keys::Keys;
use super::format::{Choice, Format};
use super::options::Attributes;
use crate::RawNetwork;

/// GraphML.
pub const FORMAT: Format = Format {
    name: "graphml",
    summary: "GraphML; `attributes` names what is read beside nodes and links",
    endings: &["graphml", "xml"],
    lists_links: true,
    choices: &[Choice::Attributes],
    read: |source, options| Ok(read(source, &options.attributes)?),
};

/// Reads a network from the one graph of a GraphML file; the module describes the format.
///
/// Nodes stand in the order of the file. A graph may hold directed and undirected edges side by
/// side. Keeps one tag or run of text at a time; O(N + L log L) for N nodes and L edges.
///
/// # Errors
/// [`GraphMlError`], naming the first line at fault; edges of unknown nodes and duplicate edges
/// are looked for when the whole graph has been read.
pub fn read(source: impl Read, attributes: &Attributes) -> Result<RawNetwork, GraphMlError> {
    if !matches!(attributes.position.len(), 0 | 2 | 3) {
        return Err(GraphMlError::PositionNames { found: attributes.position.len() });
    }
    let mut document = Document::new(source);
    document.root()?;
    let mut keys = Keys::default();
    let mut graph: Option<Graph> = None;
    while let Some(element) = document.child("graphml")? {
        match element.name.as_str() {
            "key" => keys.declare(&element, &mut document)?,
            "graph" if graph.is_some() => {
                let (line, column) = (element.place.line, element.place.column);
                let (expected, found) = ("one graph", "a second one".to_owned());
                return Err(GraphMlError::Unexpected { line, column, expected, found });
            }
            "graph" => {
                let wanted = keys.find(attributes)?;
                graph = Some(Graph::read(&element, &mut document, &keys, &wanted)?);
            }
            // Descriptions, and data of the file as a whole.
            _ => document.skip(&element.name)?,
        }
    }
    document.end()?;
    graph.ok_or(GraphMlError::NoGraph)?.into_network()
}
