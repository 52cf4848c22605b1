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

mod error;
mod fields;

use std::io::Read;

pub use self::error::EdgeListError;
use self::fields::{Field, Fields};
use super::format::Format;
use super::labels::Labels;
use super::plain::{Plain, plain};
use super::text::{Lines, quoted};
use crate::network::first_repeated;
use crate::{GraphError, Network};

/// Edge lists.
pub const FORMAT: Format = Format {
    name: "edge_list",
    summary: "A link a line: two labels and, if it is not 1, a weight",
    endings: &["edges", "edgelist", "el", "txt", "tsv", ""],
    lists_links: true,
    choices: &[],
    read: |source, _| Ok(read(source)?.into()),
};

/// Reads an undirected network from an edge list; the module describes the format.
///
/// Keeps one line of text at a time and 16 bytes a link. O(N log N + L log k) for N nodes and L
/// links, at most k at a node.
///
/// # Errors
/// [`EdgeListError`], naming the first line at fault; duplicate links are looked for when every
/// line has been read.
pub fn read(source: impl Read) -> Result<Network, EdgeListError> {
    let mut file = File { nodes: Labels::default(), links: Vec::new(), runs: Vec::new() };
    let mut lines = Lines::new(source);
    let mut n_lines = 0;
    while let Some((line, text)) = lines.next_line()? {
        n_lines = line;
        let link = match file.plain_link(text)? {
            None => file.link(line, text)?,
            link => link,
        };
        if let Some(link) = link {
            file.add(line, link);
        }
    }
    if file.nodes.len() == 0 {
        return Err(EdgeListError::Empty { lines: n_lines });
    }
    file.network()
}

/// A link between nodes in order of first appearance, and its weight.
type Link = (u32, u32, f64);

/// What has been read.
struct File {
    nodes: Labels,
    links: Vec<Link>,
    /// Where links follow one another line by line: the first of each run, and its line.
    runs: Vec<(usize, usize)>,
}

impl File {
    /// The link of a line of the commonest form, in which nothing is wrong.
    fn plain_link(&mut self, text: &str) -> Result<Option<Link>, EdgeListError> {
        let Some(Plain { first, second, value }) = plain(text, true) else { return Ok(None) };
        let weight = value.map_or(Ok(1.0), str::parse::<f64>).ok().filter(is_weight);
        let Some(weight) = weight.filter(|_| first != second) else { return Ok(None) };
        let [from, to] = [first, second].map(|number| self.nodes.node_of_integer(number));
        Ok(Some((self.numbered(from)?, self.numbered(to)?, weight)))
    }

    /// The link of any line, if it has one.
    fn link(&mut self, line: usize, text: &str) -> Result<Option<Link>, EdgeListError> {
        let mut fields = Fields::new(line, text);
        let Some(first) = fields.next_field()? else { return Ok(None) };
        let from = self.node(&first)?;
        let Some(second) = fields.next_field()? else { return Ok(None) };
        let to = self.node(&second)?;
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
        Ok(Some((from, to, weight)))
    }

    fn node(&mut self, field: &Field<'_>) -> Result<u32, EdgeListError> {
        let node = self.nodes.node(&field.text);
        self.numbered(node)
    }

    fn numbered(&self, node: Option<u32>) -> Result<u32, EdgeListError> {
        Ok(node.ok_or(GraphError::TooManyNodes { n_nodes: self.nodes.len() + 1 })?)
    }

    fn add(&mut self, line: usize, link: Link) {
        let next = self.runs.last().map(|&(first, line)| line + self.links.len() - first);
        if next != Some(line) {
            self.runs.push((self.links.len(), line));
        }
        self.links.push(link);
    }

    fn network(self) -> Result<Network, EdgeListError> {
        let Self { nodes, mut links, runs } = self;
        let (labels, number) = nodes.numbered();
        for (from, to, _) in &mut links {
            (*from, *to) = (number[*from as usize], number[*to as usize]);
        }
        let line = |link: usize| {
            let (first, line) = runs[runs.partition_point(|&(first, _)| first <= link) - 1];
            line + link - first
        };
        Network::of_distinct_ends(labels, &links).map_err(|error| match error {
            GraphError::DuplicateLink { from, to } => {
                let ends = links.iter().map(|&(from, to, _)| (from as usize, to as usize));
                let [first, repeated] = first_repeated(ends).expect("a link that is repeated");
                let (line, first_line) = (line(repeated), line(first));
                let [from, to] = [from, to].map(|label| quoted(&label));
                EdgeListError::DuplicateLink { line, first_line, from, to }
            }
            error => error.into(),
        })
    }
}

fn is_weight(weight: &f64) -> bool {
    weight.is_finite() && *weight > 0.0
}

fn weight(line: usize, text: &str, field: &Field<'_>) -> Result<f64, EdgeListError> {
    match field.text.parse::<f64>() {
        Ok(weight) if is_weight(&weight) => Ok(weight),
        _ => {
            let (column, found) = (field.column(text), quoted(&field.text));
            Err(EdgeListError::BadWeight { line, column, found })
        }
    }
}
