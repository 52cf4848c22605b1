//! Connected components: sets of nodes between which links lead, whatever their direction.

use crate::SparseMatrix;

const NONE: usize = usize::MAX;

/// The connected component of every node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Components {
    of_node: Vec<usize>,
    count: usize,
}

impl Components {
    /// Those of a matrix in compressed rows whose pattern is symmetric.
    pub fn of(symmetric: &SparseMatrix) -> Self {
        let row = |i| symmetric.outer_view(i).expect("a node has a row").into_raw_storage().0;
        Self::among(symmetric.rows(), row, |_| true)
    }

    /// Those of what is left of a network without some of its nodes.
    ///
    /// - `neighbours`: of each node, in both directions of every link.
    /// - `is_left`: whether a node is.
    pub fn among<'a>(
        n_nodes: usize,
        neighbours: impl Fn(usize) -> &'a [u32],
        is_left: impl Fn(usize) -> bool,
    ) -> Self {
        let mut of_node = vec![NONE; n_nodes];
        let mut count = 0;
        let mut reached = Vec::new();
        for first in 0..n_nodes {
            if of_node[first] != NONE || !is_left(first) {
                continue;
            }
            of_node[first] = count;
            reached.push(first);
            while let Some(node) = reached.pop() {
                for &j in neighbours(node) {
                    let j = j as usize;
                    if of_node[j] == NONE && is_left(j) {
                        of_node[j] = count;
                        reached.push(j);
                    }
                }
            }
            count += 1;
        }
        Self { of_node, count }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The number of a node's component, from 0 in the order of their first nodes; none for a node that
    /// was left out.
    pub fn of_node(&self, node: usize) -> Option<usize> {
        Some(self.of_node[node]).filter(|&component| component != NONE)
    }

    /// The nodes of each, ascending.
    pub fn nodes(&self) -> Vec<Vec<usize>> {
        let mut nodes = vec![Vec::new(); self.count];
        for (node, &component) in self.of_node.iter().enumerate().filter(|&(_, &c)| c != NONE) {
            nodes[component].push(node);
        }
        nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_that_are_left_out_part_what_they_joined() {
        // A path 0 – 1 – 2 – 3 and a pair 4 – 5.
        let neighbours: [&[u32]; 6] = [&[1], &[0, 2], &[1, 3], &[2], &[5], &[4]];
        let all = Components::among(6, |i| neighbours[i], |_| true);
        assert_eq!(all.nodes(), [vec![0, 1, 2, 3], vec![4, 5]]);
        let parted = Components::among(6, |i| neighbours[i], |i| i != 2);
        assert_eq!(parted.nodes(), [vec![0, 1], vec![3], vec![4, 5]]);
        assert_eq!((parted.of_node(2), parted.of_node(3)), (None, Some(1)));
    }
}
