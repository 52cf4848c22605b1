//! Nodes in the order in which a file first names them, and the order in which a network has them.
//!
//! Labels that are whole numbers are kept as such and not as text: a file of ten million links asks
//! for twenty million of them.

use std::collections::HashMap;

/// Digits of a number that surely fits 64 bits.
const MAX_DIGITS: usize = 18;

/// Least length of the table of small numbers.
const LEAST_TABLE: usize = 1 << 16;

/// Numbers that the table holds for each node: its size stays in proportion to the network.
const NUMBERS_A_NODE: usize = 8;

/// No node, in the table of small numbers.
const NONE: u32 = u32::MAX;

/// Nodes numbered from 0 in order of first appearance.
#[derive(Default)]
pub(crate) struct Labels {
    labels: Vec<Label>,
    /// The node of each small number, or [`NONE`]: looked up in a tenth of the time of a hash.
    of_small: Vec<u32>,
    /// Of the numbers that were not small when they came.
    of_integer: HashMap<u64, u32>,
    of_text: HashMap<String, u32>,
}

enum Label {
    Integer(u64),
    Text(String),
}

impl Labels {
    /// Number of nodes so far.
    pub(crate) fn len(&self) -> usize {
        self.labels.len()
    }

    /// The node of a label, a new one for a new label; none where there is no number left.
    pub(crate) fn node(&mut self, label: &str) -> Option<u32> {
        if let Some(number) = whole_number(label) {
            return self.node_of_integer(number);
        }
        if let Some(&node) = self.of_text.get(label) {
            return Some(node);
        }
        let node = self.next()?;
        self.labels.push(Label::Text(label.to_owned()));
        self.of_text.insert(label.to_owned(), node);
        Some(node)
    }

    /// The node whose label is this number as it is written without superfluous zeros.
    #[inline]
    pub(crate) fn node_of_integer(&mut self, number: u64) -> Option<u32> {
        match self.of_small.get(usize::try_from(number).ok()?) {
            Some(&node) if node != NONE => Some(node),
            _ => self.node_of_new_or_large(number),
        }
    }

    fn node_of_new_or_large(&mut self, number: u64) -> Option<u32> {
        let known = self.of_integer.get(&number).copied();
        let node = known.or_else(|| self.next())?;
        if known.is_none() {
            self.labels.push(Label::Integer(number));
        }
        let place = usize::try_from(number).ok()?;
        if place < LEAST_TABLE + NUMBERS_A_NODE * self.labels.len() {
            self.of_small.resize(self.of_small.len().max(place + 1), NONE);
            self.of_small[place] = node;
        } else if known.is_none() {
            self.of_integer.insert(number, node);
        }
        Some(node)
    }

    fn next(&self) -> Option<u32> {
        u32::try_from(self.labels.len()).ok().filter(|&node| node != NONE)
    }

    /// The labels in their final order, numeric where all are non-negative integers and of first
    /// appearance otherwise, and the final number of each node.
    pub(crate) fn numbered(self) -> (Vec<String>, Vec<u32>) {
        let Self { labels, .. } = self;
        let mut order: Vec<u32> = (0..).take(labels.len()).collect();
        let integers: Option<Vec<u64>> = labels.iter().map(Label::integer).collect();
        let mut texts: Vec<String> = labels.into_iter().map(Label::into_text).collect();
        if let Some(integers) = integers {
            order.sort_unstable_by_key(|&node| integers[node as usize]);
        } else if texts.iter().all(|text| text.bytes().all(|byte| byte.is_ascii_digit())) {
            order.sort_by_key(|&node| numeric_order(&texts[node as usize]));
        }
        let mut number = vec![0; order.len()];
        let sorted = (0..).zip(&order).map(|(new, &old)| {
            number[old as usize] = new;
            std::mem::take(&mut texts[old as usize])
        });
        (sorted.collect(), number)
    }
}

impl Label {
    fn integer(&self) -> Option<u64> {
        match self {
            Self::Integer(number) => Some(*number),
            Self::Text(_) => None,
        }
    }

    fn into_text(self) -> String {
        match self {
            Self::Integer(number) => number.to_string(),
            Self::Text(text) => text,
        }
    }
}

/// The number that is written so and in no other way.
fn whole_number(label: &str) -> Option<u64> {
    let is_plain = label.len() <= MAX_DIGITS && label.bytes().all(|byte| byte.is_ascii_digit());
    let has_zeros = label.len() > 1 && label.starts_with('0');
    if is_plain && !has_zeros { label.parse().ok() } else { None }
}

/// A key that sorts strings of digits by value, however long, and equal values by their zeros.
fn numeric_order(digits: &str) -> (usize, &str, usize) {
    let significant = digits.trim_start_matches('0');
    (significant.len(), significant, digits.len())
}

#[cfg(test)]
mod tests {
    use super::Labels;

    #[test]
    fn a_number_keeps_its_node_whether_it_was_small_when_it_came_or_not() {
        let mut labels = Labels::default();
        let large = 100_000;
        assert_eq!(labels.node_of_integer(large), Some(0));
        // So many nodes make the table long enough to hold it.
        assert!((1..10_000).all(|number| labels.node(&number.to_string()) == Some(number)));
        assert_eq!(labels.node("100000"), Some(0));
        assert_eq!(labels.node_of_integer(large), Some(0));
        assert_eq!(labels.len(), 10_000);
    }

    #[test]
    fn numbers_written_with_zeros_are_other_nodes_in_numeric_order() {
        let mut labels = Labels::default();
        let written = ["10", "2", "02", "99999999999999999999", "0"];
        assert_eq!(written.map(|label| labels.node(label)), [0, 1, 2, 3, 4].map(Some));
        let (sorted, number) = labels.numbered();
        assert_eq!(sorted, ["0", "2", "02", "10", "99999999999999999999"]);
        assert_eq!(number, [3, 1, 2, 4, 0]);
    }
}
