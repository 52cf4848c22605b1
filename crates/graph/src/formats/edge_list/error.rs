//! Why an edge list could not be read.

use thiserror::Error;

use crate::GraphError;
use crate::formats::text::TextError;

/// Why an edge list could not be read. Lines and columns count from 1, columns in characters.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EdgeListError {
    /// The source failed, or is not text.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A comma without a value on one of its sides.
    #[error("line {line}, column {column}: expected a value, found nothing between the separators")]
    EmptyField {
        /// The line.
        line: usize,
        /// Where the value was expected.
        column: usize,
    },
    /// A character that a bare value cannot hold, or one straight after a closing quote.
    #[error("line {line}, column {column}: expected {expected}, found {found:?}")]
    UnexpectedCharacter {
        /// The line.
        line: usize,
        /// Where the character stands.
        column: usize,
        /// The character.
        found: char,
        /// What could have stood there.
        expected: &'static str,
    },
    /// A quote that is not closed on its line.
    #[error("line {line}, column {column}: expected a closing quote before the end of the line")]
    UnclosedQuote {
        /// The line.
        line: usize,
        /// Where the quote opens.
        column: usize,
    },
    /// A fourth column.
    #[error(
        "line {line}, column {column}: expected at most two nodes and a weight, found `{found}` \
         as a fourth value"
    )]
    TooManyColumns {
        /// The line.
        line: usize,
        /// Where the fourth value begins.
        column: usize,
        /// How it begins.
        found: String,
    },
    /// A third column that is not a finite number above zero.
    #[error(
        "line {line}, column {column}: expected a weight (a finite number above zero), found \
         `{found}`"
    )]
    BadWeight {
        /// The line.
        line: usize,
        /// Where the weight begins.
        column: usize,
        /// How it begins.
        found: String,
    },
    /// A link from a node to itself.
    #[error("line {line}, column {column}: expected a second node, found `{node}` again")]
    SelfLoop {
        /// The line.
        line: usize,
        /// Where the second label begins.
        column: usize,
        /// How the label begins.
        node: String,
    },
    /// A link that an earlier line gave, in this direction or the other.
    #[error("line {line}: the link `{from}`–`{to}` was already given in line {first_line}")]
    DuplicateLink {
        /// The repeating line.
        line: usize,
        /// The line that gave the link first.
        first_line: usize,
        /// How the first label of the repeating line begins.
        from: String,
        /// How its second label begins.
        to: String,
    },
    /// No node in the whole source.
    #[error("expected at least one link or node, found none in {lines} lines")]
    Empty {
        /// Number of lines read.
        lines: usize,
    },
    /// What [`crate::Network::undirected`] refuses beyond the above.
    #[error(transparent)]
    Network(#[from] GraphError),
}
