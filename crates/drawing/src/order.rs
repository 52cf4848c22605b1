//! The order of nodes along matrices and eigenvectors: by groups, else by predicted clusters.

use clustering::Partition;
use eigensync::Findings;
use figures::{Group, Label};

use crate::identity::Identities;
use experiment::Plan;

/// Which node stands at which place.
pub struct Order {
    nodes: Vec<usize>,
}

/// The predicted state at a coupling strength.
pub fn state(findings: &Findings, epsilon: f64) -> Option<usize> {
    findings.cascade.iter().position(|state| state.holds_at(epsilon))
}

/// Whether a state has clusters beside the one of all nodes.
pub fn is_parted(findings: &Findings, state: usize) -> bool {
    let clusters = &findings.cascade[state].clusters;
    (2..clusters.n_nodes()).contains(&clusters.n_clusters())
}

impl Order {
    /// The nodes of a group together, in the order of first nodes; without groups the nodes of the
    /// clusters of these states, the largest cluster first, those of the first state above all.
    pub fn of(plan: &Plan, findings: &Findings, states: &[Option<usize>]) -> Self {
        let groups = plan.study.network.groups();
        if !groups.is_empty() {
            let mut first: Vec<usize> = (0..plan.study.network.n_nodes()).collect();
            for group in groups {
                let least = group.nodes.iter().copied().min().unwrap_or(0);
                group.nodes.iter().for_each(|&node| first[node] = least);
            }
            return Self::by(plan.study.network.n_nodes(), &[first]);
        }
        let states = states.iter().flatten();
        let ranks: Vec<Vec<usize>> =
            states.map(|&state| ranks(&findings.cascade[state].clusters)).collect();
        Self::by(plan.study.network.n_nodes(), &ranks)
    }

    /// By the first key, those of the same by the next, and by their numbers in the end.
    fn by(n_nodes: usize, keys: &[Vec<usize>]) -> Self {
        let mut nodes: Vec<usize> = (0..n_nodes).collect();
        nodes.sort_by(|&a, &b| keys.iter().map(|key| key[a]).cmp(keys.iter().map(|key| key[b])));
        Self { nodes }
    }

    /// Whether places are numbers of nodes.
    pub fn is_of_nodes(&self) -> bool {
        self.nodes.is_sorted()
    }

    /// Values of nodes, in this order.
    pub fn arranged(&self, values: &[f64]) -> Vec<f64> {
        self.nodes.iter().map(|&node| values[node]).collect()
    }

    /// A matrix over pairs of nodes, row by row, in this order.
    pub fn arranged_pairs(&self, values: &[f64]) -> Vec<f64> {
        let n = self.nodes.len();
        self.nodes.iter().flat_map(|&i| self.arranged(&values[i * n..][..n])).collect()
    }

    /// The groups, else the clusters of a state, that stand together in this order. Where places are no
    /// numbers of nodes and nothing has a name, a word in place of wrong numbers.
    pub fn groups(
        &self,
        plan: &Plan,
        findings: &Findings,
        identities: &Identities,
        state: Option<usize>,
    ) -> Vec<Group> {
        let named = plan.study.network.groups();
        let mut groups: Vec<Group> = if named.is_empty() {
            let state = state.filter(|&state| is_parted(findings, state));
            let clusters = state.iter().flat_map(|&state| {
                let clusters = findings.cascade[state].clusters.nontrivial();
                clusters.into_iter().zip(&identities.of_state[state])
            });
            clusters.filter_map(|(nodes, is)| self.together(&nodes, is.name.clone())).collect()
        } else {
            let label = |name: &str| Label::text(name);
            named.iter().filter_map(|g| self.together(&g.nodes, label(&g.name))).collect()
        };
        if groups.is_empty() && !self.is_of_nodes() {
            let label = Label::text("nodes");
            groups.push(Group { label, nodes: 0..self.nodes.len() });
        }
        groups
    }

    fn together(&self, nodes: &[usize], label: Label) -> Option<Group> {
        let mut places: Vec<usize> =
            (0..self.nodes.len()).filter(|&place| nodes.contains(&self.nodes[place])).collect();
        places.sort_unstable();
        let (first, last) = (*places.first()?, *places.last()?);
        (last - first + 1 == places.len()).then_some(Group { label, nodes: first..last + 1 })
    }
}

/// For every node the place of its cluster by falling size, the first of equals first.
fn ranks(clusters: &Partition) -> Vec<usize> {
    let sizes = clusters.sizes();
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&cluster| std::cmp::Reverse(sizes[cluster]));
    let mut rank = vec![0; sizes.len()];
    order.into_iter().enumerate().for_each(|(place, cluster)| rank[cluster] = place);
    clusters.cluster_of().iter().map(|&cluster| rank[cluster]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_clusters_come_first_and_parts_stand_within_them() {
        let coarse = ranks(&Partition::from_marks(&[0, 1, 1, 0, 1]));
        let fine = ranks(&Partition::from_marks(&[0, 1, 2, 0, 1]));
        let order = Order::by(5, &[coarse, fine]);
        assert_eq!(order.nodes, [1, 4, 2, 0, 3]);
        assert!(!order.is_of_nodes());
        assert_eq!(order.arranged(&[0.0, 1.0, 2.0, 3.0, 4.0]), [1.0, 4.0, 2.0, 0.0, 3.0]);
        let whole = order.arranged_pairs(&(0..25).map(f64::from).collect::<Vec<_>>());
        assert_eq!(whole[..5], [6.0, 9.0, 7.0, 5.0, 8.0]);
        let group = order.together(&[4, 1, 2], Label::text("C")).unwrap();
        assert_eq!(group.nodes, 0..3);
        assert!(order.together(&[1, 3], Label::text("C")).is_none());
    }
}
