//! Nodes in consecutive communities, and random links of unit weight within and between them.

use std::ops::Range;

use super::trials::Trials;
use crate::{GeneratorError, Group, Network, numbered_labels};

/// Above this many expected links the adjacency matrix alone would need 100 GB.
const MAX_LINKS: f64 = 4_294_967_295.0;

/// A network that is being linked, block by block.
///
/// The order of the calls and, within a call, that of the pairs of nodes decide what a seed means.
pub(super) struct Blocks {
    /// Where each community begins, and the number of nodes at the end.
    starts: Vec<usize>,
    links: Vec<(usize, usize, f64)>,
    expected_links: f64,
    trials: Trials,
}

impl Blocks {
    pub(super) fn new(
        sizes: impl Iterator<Item = usize>,
        seed: u64,
    ) -> Result<Self, GeneratorError> {
        let mut starts = vec![0];
        let mut n_nodes = 0usize;
        for (index, size) in sizes.enumerate() {
            if size == 0 {
                return Err(GeneratorError::EmptyCommunity { community: index + 1 });
            }
            n_nodes = n_nodes.saturating_add(size);
            starts.push(n_nodes);
        }
        if n_nodes == 0 {
            return Err(GeneratorError::NoCommunities);
        }
        if u32::try_from(n_nodes).is_err() {
            return Err(GeneratorError::TooManyNodes { n_nodes });
        }
        Ok(Self { starts, links: Vec::new(), expected_links: 0.0, trials: Trials::new(seed) })
    }

    /// Links the nodes of one community, pairs (j, i) with j < i by rows i.
    pub(super) fn link_within(&mut self, index: usize, p: f64) -> Result<(), GeneratorError> {
        let nodes = self.community(index);
        let n = nodes.len() as u64;
        self.link_rows(nodes.clone(), |i| nodes.start..i, n * (n - 1) / 2, p)
    }

    /// Links the nodes of two communities, by rows of the second.
    pub(super) fn link_between(
        &mut self,
        first: usize,
        second: usize,
        p: f64,
    ) -> Result<(), GeneratorError> {
        let (columns, rows) = (self.community(first), self.community(second));
        let width = columns.len() as u64;
        let n_pairs = width * rows.len() as u64;
        self.expect_links(n_pairs, p)?;
        let pair = |position| {
            let (row, column) = ((position / width) as usize, (position % width) as usize);
            (columns.start + column, rows.start + row, 1.0)
        };
        self.links.extend(self.trials.successes(n_pairs, p).map(pair));
        Ok(())
    }

    /// Links nodes of different communities with one probability for all, by rows.
    ///
    /// O(N + L) however many communities there are.
    pub(super) fn link_all_between(&mut self, p: f64) -> Result<(), GeneratorError> {
        let n_nodes = *self.starts.last().expect("starts end with the number of nodes");
        let starts: Vec<usize> = (0..self.n_communities())
            .flat_map(|index| self.community(index).map(move |_| index))
            .map(|index| self.starts[index])
            .collect();
        let n_pairs = starts.iter().map(|&start| start as u64).sum();
        self.link_rows(0..n_nodes, |i| 0..starts[i], n_pairs, p)
    }

    /// Labels "1", "2", … and groups "C1", "C2", ….
    pub(super) fn into_network(self) -> Network {
        let groups = (0..self.n_communities()).map(|index| Group {
            name: format!("C{}", index + 1),
            nodes: self.community(index).collect(),
        });
        let groups = groups.collect();
        let n_nodes = *self.starts.last().expect("starts end with the number of nodes");
        Network::undirected(numbered_labels(n_nodes), &self.links)
            .and_then(|network| network.with_groups(groups))
            .expect("every pair of nodes is tried once, and communities are disjoint")
    }

    pub(super) fn n_communities(&self) -> usize {
        self.starts.len() - 1
    }

    fn community(&self, index: usize) -> Range<usize> {
        self.starts[index]..self.starts[index + 1]
    }

    /// Links each row's node with partners, walking from row to row along the successes.
    fn link_rows(
        &mut self,
        mut rows: Range<usize>,
        partners: impl Fn(usize) -> Range<usize>,
        n_pairs: u64,
        p: f64,
    ) -> Result<(), GeneratorError> {
        self.expect_links(n_pairs, p)?;
        let mut row = rows.start;
        let (mut row_begin, mut row_end) = (0, 0);
        for success in self.trials.successes(n_pairs, p) {
            while success >= row_end {
                row = rows.next().expect("the rows hold n_pairs pairs");
                (row_begin, row_end) = (row_end, row_end + partners(row).len() as u64);
            }
            let partner = partners(row).start + (success - row_begin) as usize;
            self.links.push((partner, row, 1.0));
        }
        Ok(())
    }

    fn expect_links(&mut self, n_pairs: u64, p: f64) -> Result<(), GeneratorError> {
        self.expected_links += p * n_pairs as f64;
        if self.expected_links > MAX_LINKS {
            let expected = self.expected_links;
            return Err(GeneratorError::TooManyLinks { expected, limit: MAX_LINKS });
        }
        Ok(())
    }
}
