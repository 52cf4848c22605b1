//! Whether a network falls apart easily: a cheap estimate of the fill of its factor.
//!
//! A network whose halves are separated by s nodes has a factor with a dense triangle of at least
//! about s² / 2 entries (George, SIAM J. Numer. Anal. 10, 345 (1973)). Leaves fill nothing, so they
//! are taken off first, again and again; in what is left, the levels of a breadth-first search from a
//! far end of each component are separators, and the narrowest one that cuts off at least a quarter
//! on both sides is taken. Grids, roads, trees and rings pass; random networks, whose levels hold a
//! fair part of all nodes, do not.

use std::borrow::Cow;

use graph::SparseMatrix;

/// A cut is small when its square is smaller than the component by this factor: what it fills counts
/// for little.
const SMALL: usize = 100;

const UNSEEN: u32 = u32::MAX;

/// What the levels of breadth-first searches tell of a network.
pub(crate) struct Shape {
    /// Σ s² / 2 over the components.
    pub fill: f64,
    /// Levels of the longest component: a polynomial of S of a lower degree does not even carry a
    /// signal from one end to the other.
    pub levels: usize,
    /// The nodes of a small level that cuts the largest component in halves, if there is one.
    pub cut: Option<Vec<u32>>,
}

/// Searches the network.
pub(crate) fn shape(matrix: &SparseMatrix) -> Shape {
    let mut core = Core::of(matrix);
    let mut shape = Shape { fill: 0.0, levels: 0, cut: None };
    let mut largest = 0;
    for first in 0..matrix.rows() {
        if core.taken[first] {
            continue;
        }
        let end = core.levels_from(first).last_node();
        let levels = core.levels_from(end);
        levels.nodes.iter().for_each(|&node| core.taken[node as usize] = true);
        let width = levels.narrowest() as f64;
        shape.fill += 0.5 * width * width;
        shape.levels = shape.levels.max(levels.sizes.len());
        if levels.nodes.len() > largest {
            largest = levels.nodes.len();
            shape.cut = levels.cut();
        }
    }
    shape
}

/// The network without trees.
struct Core<'a> {
    starts: Cow<'a, [usize]>,
    columns: &'a [u32],
    /// Nodes that are leaves of trees, or of components that have been looked at.
    taken: Vec<bool>,
    /// Level of each node in the latest search.
    level: Vec<u32>,
}

/// Nodes of a component in the order of a breadth-first search.
struct Levels {
    nodes: Vec<u32>,
    sizes: Vec<usize>,
}

impl<'a> Core<'a> {
    fn of(matrix: &'a SparseMatrix) -> Self {
        let n_nodes = matrix.rows();
        let mut core = Self {
            starts: matrix.proper_indptr(),
            columns: matrix.indices(),
            taken: vec![false; n_nodes],
            level: vec![UNSEEN; n_nodes],
        };
        let degree = |i: usize| core.row(i).iter().filter(|&&j| j as usize != i).count();
        let mut degrees: Vec<usize> = (0..n_nodes).map(degree).collect();
        let mut leaves: Vec<usize> = (0..n_nodes).filter(|&i| degrees[i] <= 1).collect();
        while let Some(leaf) = leaves.pop() {
            core.taken[leaf] = true;
            for &neighbour in core.row(leaf) {
                let neighbour = neighbour as usize;
                if !core.taken[neighbour] {
                    degrees[neighbour] -= 1;
                    if degrees[neighbour] == 1 {
                        leaves.push(neighbour);
                    }
                }
            }
        }
        core
    }

    /// Linked nodes, and the node itself.
    fn row(&self, i: usize) -> &'a [u32] {
        &self.columns[self.starts[i]..self.starts[i + 1]]
    }

    fn levels_from(&mut self, first: usize) -> Levels {
        let mut levels = Levels { nodes: vec![first as u32], sizes: vec![1] };
        self.level[first] = 0;
        let mut next = 0;
        while let Some(&node) = levels.nodes.get(next) {
            next += 1;
            let level = self.level[node as usize] + 1;
            for &neighbour in self.row(node as usize) {
                let j = neighbour as usize;
                if self.level[j] == UNSEEN && !self.taken[j] {
                    self.level[j] = level;
                    levels.nodes.push(neighbour);
                    levels.sizes.resize(level as usize + 1, 0);
                    levels.sizes[level as usize] += 1;
                }
            }
        }
        levels.nodes.iter().for_each(|&node| self.level[node as usize] = UNSEEN);
        levels
    }
}

impl Levels {
    fn last_node(&self) -> usize {
        self.nodes[self.nodes.len() - 1] as usize
    }

    /// The level of the middle node, if it is small.
    fn cut(&self) -> Option<Vec<u32>> {
        let total = self.nodes.len();
        let mut before = 0;
        let cut = self.sizes.iter().find_map(|&size| {
            let level = before..before + size;
            before += size;
            (2 * before > total).then_some(level)
        });
        cut.filter(|level| level.len().pow(2) <= total / SMALL)
            .map(|level| self.nodes[level].to_vec())
    }

    /// The size of the smallest level with at most three quarters of the nodes before and behind it.
    fn narrowest(&self) -> usize {
        let total = self.nodes.len();
        let mut before = 0;
        let middle = self.sizes.iter().filter(|&&size| {
            let behind = total - before - size;
            let cuts = 4 * before <= 3 * total && 4 * behind <= 3 * total;
            before += size;
            cuts
        });
        middle.copied().min().expect("the level that holds the middle node cuts")
    }
}
