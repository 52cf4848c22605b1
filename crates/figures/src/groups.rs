//! Groups of consecutive nodes, such as communities or divisions, which panels set apart.

use std::ops::Range;

use super::error::FigureError;
use super::label::Label;

/// Consecutive nodes with a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// Its name, such as C₁; an empty label for none.
    pub label: Label,
    /// Its nodes, from 0.
    pub nodes: Range<usize>,
}

impl Group {
    /// The group as a span of node numbers, which begin at 1: half a node beyond its first and
    /// last.
    pub(super) fn span(&self) -> [f64; 2] {
        [self.nodes.start, self.nodes.end].map(|node| node as f64 + 0.5)
    }
}

/// Checks that no group is empty or reaches beyond the nodes.
pub(super) fn check(groups: &[Group], n_nodes: usize, panel: &str) -> Result<(), FigureError> {
    match groups.iter().find(|g| g.nodes.is_empty() || g.nodes.end > n_nodes) {
        Some(Group { nodes: Range { start, end }, .. }) => {
            Err(FigureError::BadGroup { panel: panel.into(), from: *start, to: *end, n_nodes })
        }
        None => Ok(()),
    }
}

/// Nodes before which a group begins or ends, in ascending order, the first and last of all left
/// out.
pub(super) fn boundaries(groups: &[Group], n_nodes: usize) -> Vec<usize> {
    let mut ends: Vec<usize> = groups.iter().flat_map(|g| [g.nodes.start, g.nodes.end]).collect();
    ends.sort_unstable();
    ends.dedup();
    ends.retain(|&node| node > 0 && node < n_nodes);
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(nodes: Range<usize>) -> Group {
        Group { label: Label::default(), nodes }
    }

    #[test]
    fn groups_that_touch_share_a_boundary() {
        let groups = [group(0..30), group(30..60), group(70..90)];
        assert_eq!(boundaries(&groups, 90), [30, 60, 70]);
        assert_eq!(groups[1].span(), [30.5, 60.5]);
    }

    #[test]
    fn empty_groups_and_those_beyond_the_nodes_are_refused() {
        assert!(check(&[group(0..3), group(3..5)], 5, "(a)").is_ok());
        for nodes in [2..2, 3..6] {
            let refused = check(&[group(nodes)], 5, "(a)");
            assert!(matches!(refused, Err(FigureError::BadGroup { n_nodes: 5, .. })));
        }
    }
}
