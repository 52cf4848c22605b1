//! Edge lists: one undirected link a line, `node node [weight]`.
//!
//! ```text
//! # everything after # or % is a comment
//! 1 2            columns are separated by blanks, tabs or one comma
//! 2, 3, 1.5      a weight, finite and above zero; 1 where there is none
//! "area 17" 4    quotes allow blanks, commas, semicolons, # and %; "" inside them is one quote
//! 5              a line with a single label declares a node, which may stay isolated
//! ```
//!
//! Each link is given once, in either direction. `#` and `%` begin a comment only where a column
//! could begin, so `a#1` is a label. Labels compare as text: `1` and `01` are two nodes.
//!
//! Where all labels are non-negative integers, nodes are numbered in numeric order; otherwise in
//! order of first appearance. Text is UTF-8, with or without a byte order mark, lines end in LF or
//! CRLF and are at most [`MAX_LINE_BYTES`](super::MAX_LINE_BYTES) long.

use std::collections::HashMap;
use std::io::Read;

use thiserror::Error;

use super::TextError;
use super::fields::{Field, Fields};
use super::text::{Lines, quoted};
use crate::{GraphError, Network};

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
    /// What [`Network::undirected`] refuses beyond the above.
    #[error(transparent)]
    Network(#[from] GraphError),
}

/// Reads an undirected network from an edge list; the module describes the format.
///
/// Keeps one line of text at a time. O(N + L log L) for N nodes and L links, the logarithm from
/// the search for duplicates.
///
/// # Errors
/// [`EdgeListError`], naming the first line at fault; duplicate links are looked for when every
/// line has been read.
pub fn read(source: impl Read) -> Result<Network, EdgeListError> {
    let mut nodes = Nodes::default();
    let mut links = Vec::new();
    let mut lines = Lines::new(source);
    let mut n_lines = 0;
    while let Some((line, text)) = lines.next_line()? {
        n_lines = line;
        links.extend(read_line(line, text, &mut nodes)?);
    }
    if nodes.labels.is_empty() {
        return Err(EdgeListError::Empty { lines: n_lines });
    }
    refuse_duplicates(&links, &nodes.labels)?;
    let (labels, number) = nodes.numbered();
    let links: Vec<_> = links.iter().map(|l| (number[l.from], number[l.to], l.weight)).collect();
    Ok(Network::undirected(labels, &links)?)
}

/// A link between nodes in order of first appearance.
struct Link {
    from: usize,
    to: usize,
    weight: f64,
    line: usize,
}

/// Nodes in order of first appearance.
#[derive(Default)]
struct Nodes {
    labels: Vec<String>,
    of_label: HashMap<String, usize>,
}

impl Nodes {
    fn node(&mut self, label: &str) -> usize {
        if let Some(&node) = self.of_label.get(label) {
            return node;
        }
        let node = self.labels.len();
        self.labels.push(label.to_owned());
        self.of_label.insert(label.to_owned(), node);
        node
    }

    /// The labels in their final order, and the final number of each node.
    fn numbered(self) -> (Vec<String>, Vec<usize>) {
        let mut order: Vec<usize> = (0..self.labels.len()).collect();
        let is_integer = |label: &String| label.bytes().all(|b| b.is_ascii_digit());
        if self.labels.iter().all(is_integer) {
            order.sort_by_key(|&node| numeric_order(&self.labels[node]));
        }
        let mut number = vec![0; order.len()];
        let mut labels = self.labels;
        let sorted = order
            .iter()
            .enumerate()
            .map(|(new, &old)| {
                number[old] = new;
                std::mem::take(&mut labels[old])
            })
            .collect();
        (sorted, number)
    }
}

/// A key that sorts strings of digits by value, however long, and equal values by their zeros.
fn numeric_order(digits: &str) -> (usize, &str, usize) {
    let significant = digits.trim_start_matches('0');
    (significant.len(), significant, digits.len())
}

fn read_line(line: usize, text: &str, nodes: &mut Nodes) -> Result<Option<Link>, EdgeListError> {
    let mut fields = Fields::new(line, text);
    let Some(first) = fields.next_field()? else { return Ok(None) };
    let from = nodes.node(&first.text);
    let Some(second) = fields.next_field()? else { return Ok(None) };
    let to = nodes.node(&second.text);
    if from == to {
        let (column, node) = (second.column(text), quoted(&second.text));
        return Err(EdgeListError::SelfLoop { line, column, node });
    }
    let weight = match fields.next_field()? {
        Some(field) => weight(line, text, &field)?,
        None => 1.0,
    };
    if let Some(fourth) = fields.next_field()? {
        let (column, found) = (fourth.column(text), quoted(&fourth.text));
        return Err(EdgeListError::TooManyColumns { line, column, found });
    }
    Ok(Some(Link { from, to, weight, line }))
}

fn weight(line: usize, text: &str, field: &Field<'_>) -> Result<f64, EdgeListError> {
    match field.text.parse::<f64>() {
        Ok(weight) if weight.is_finite() && weight > 0.0 => Ok(weight),
        _ => {
            let (column, found) = (field.column(text), quoted(&field.text));
            Err(EdgeListError::BadWeight { line, column, found })
        }
    }
}

/// Sorts by link and then line, so that a repetition stands beside what it repeats.
fn refuse_duplicates(links: &[Link], labels: &[String]) -> Result<(), EdgeListError> {
    let mut order: Vec<&Link> = links.iter().collect();
    let ends = |l: &Link| (l.from.min(l.to), l.from.max(l.to));
    order.sort_unstable_by_key(|l| (ends(l), l.line));
    let repeated = order
        .windows(2)
        .filter(|pair| ends(pair[0]) == ends(pair[1]))
        .min_by_key(|pair| pair[1].line);
    match repeated {
        None => Ok(()),
        Some(pair) => Err(EdgeListError::DuplicateLink {
            line: pair[1].line,
            first_line: pair[0].line,
            from: quoted(&labels[pair[1].from]),
            to: quoted(&labels[pair[1].to]),
        }),
    }
}
