//! Why GraphML could not be read.

use std::sync::Arc;

use thiserror::Error;

use crate::GraphError;

/// Why a GraphML file could not be read. Lines and columns count from 1, columns in characters.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
pub enum GraphMlError {
    /// The source itself failed, or a tag or text is too long.
    #[error("line {line}: reading failed: {source}")]
    Io {
        /// The line that was being read.
        line: usize,
        /// What the source said.
        source: Arc<std::io::Error>,
    },
    /// Not XML in UTF-8.
    #[error("line {line}, column {column}: {reason}")]
    Malformed {
        /// The line.
        line: usize,
        /// Where the tag or text at fault begins.
        column: usize,
        /// What the XML lacks.
        reason: String,
    },
    /// Something that does not belong there, or that no network has.
    #[error("line {line}, column {column}: expected {expected}, found {found}")]
    Unexpected {
        /// The line.
        line: usize,
        /// Where it begins.
        column: usize,
        /// What could have stood there.
        expected: &'static str,
        /// What does.
        found: String,
    },
    /// The file ends within an element.
    #[error("line {line}: expected the end of `{element}` before the end of the file")]
    Unclosed {
        /// The last line.
        line: usize,
        /// The element.
        element: String,
    },
    /// A tag without an attribute that it needs.
    #[error("line {line}, column {column}: expected the attribute `{attribute}` in <{element}>")]
    MissingAttribute {
        /// The line.
        line: usize,
        /// Where the tag begins.
        column: usize,
        /// Name of the element.
        element: String,
        /// Name of the attribute.
        attribute: &'static str,
    },
    /// An attribute of a tag with a value that it cannot have.
    #[error("line {line}, column {column}: expected {attribute} to be {expected}, found `{found}`")]
    BadAttribute {
        /// The line.
        line: usize,
        /// Where the tag begins.
        column: usize,
        /// Name of the attribute.
        attribute: &'static str,
        /// What it could be.
        expected: &'static str,
        /// What it is.
        found: String,
    },
    /// Two keys or two nodes of one `id`.
    #[error("line {line}, column {column}: the {what} `{id}` was already declared")]
    DuplicateId {
        /// The line.
        line: usize,
        /// Where the tag begins.
        column: usize,
        /// What it declares.
        what: &'static str,
        /// Its `id`.
        id: String,
    },
    /// Data of a key that is not declared before.
    #[error(
        "line {line}, column {column}: expected the `id` of a key declared before, found `{key}`"
    )]
    UnknownKey {
        /// The line.
        line: usize,
        /// Where the tag begins.
        column: usize,
        /// The key.
        key: String,
    },
    /// An attribute to be read that the file does not declare.
    #[error("expected an attribute called `{wanted}` of {domain}; the file declares: {found}")]
    NoSuchAttribute {
        /// Name of the attribute.
        wanted: String,
        /// What should have it.
        domain: &'static str,
        /// Those that are declared.
        found: String,
    },
    /// A node or an edge without a value for an attribute to be read.
    #[error("line {line}, column {column}: expected a value of `{attribute}` for this {element}")]
    MissingValue {
        /// The line.
        line: usize,
        /// Where the node or edge begins.
        column: usize,
        /// What it is.
        element: &'static str,
        /// Name of the attribute.
        attribute: String,
    },
    /// A value to be read that is not a finite number.
    #[error(
        "line {line}, column {column}: expected `{attribute}` to be a finite number, found `{found}`"
    )]
    BadNumber {
        /// The line.
        line: usize,
        /// Where the node or edge begins.
        column: usize,
        /// Name of the attribute.
        attribute: String,
        /// Its value.
        found: String,
    },
    /// An edge of a node that the file does not declare.
    #[error("line {line}, column {column}: expected the `id` of a node, found `{node}`")]
    UnknownNode {
        /// The line.
        line: usize,
        /// Where the edge begins.
        column: usize,
        /// The `id` found.
        node: String,
    },
    /// An edge that an earlier one gave, in the same direction or in both.
    #[error("line {line}: the edge from `{from}` to `{to}` was already given in line {first_line}")]
    DuplicateEdge {
        /// The line of the repeating edge.
        line: usize,
        /// The line of the edge that it repeats.
        first_line: usize,
        /// `id` of its source.
        from: String,
        /// `id` of its target.
        to: String,
    },
    /// A position of other than two or three coordinates.
    #[error("expected two or three attributes as a position, found {found}")]
    PositionNames {
        /// Number of attributes.
        found: usize,
    },
    /// A file without a graph.
    #[error("expected an element `graph` in `graphml`, found none")]
    NoGraph,
    /// What [`crate::RawNetwork`] refuses beyond the above.
    #[error(transparent)]
    Network(#[from] GraphError),
}
