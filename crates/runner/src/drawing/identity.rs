//! Which cluster is which: one colour and one name for it in every panel and every state.
//!
//! From state to state a cluster goes on in the one that has most of its nodes, whether it loses some
//! as ε falls or is joined by others; what is left over begins anew. So the largest part of a cluster
//! that splits keeps its colour, and a cluster that comes back after nodes were alone has its old one.
//! The clusters of the state that the network is coloured by have the first colours, then the largest.
//! A cluster is named after the group that it is, else by its number in `cascade.csv`, that of the
//! first row with these nodes.

use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};

use clustering::State;
use figures::Label;
use graph::Network;

use crate::findings::Findings;
use crate::plan::Plan;

/// What a cluster looks like and is called.
#[derive(Clone, Debug, PartialEq)]
pub struct Identity {
    pub colour: usize,
    pub name: Label,
}

/// The clusters of two nodes or more of every predicted state, in the order of
/// [`clustering::Partition::nontrivial`].
pub struct Identities {
    pub of_state: Vec<Vec<Identity>>,
    /// The state by whose clusters the network is coloured: with the most clusters, the first of equals;
    /// none where no state has clusters beside the one of all nodes.
    pub shown: Option<usize>,
}

/// A cluster as it goes on from state to state.
type Chain = usize;

impl Identities {
    pub fn of(plan: &Plan, findings: &Findings) -> Self {
        let states = &findings.cascade;
        let clusters: Vec<Vec<Vec<usize>>> =
            states.iter().map(|state| state.clusters.nontrivial()).collect();
        let shown = shown(states, &clusters);
        let n_nodes = plan.network.n_nodes();
        let (chains, n_chains) = chains(n_nodes, &clusters);
        let colours = colours(&chains, n_chains, &clusters, shown);
        let mut names = Names::new(plan, findings);
        let of_state =
            clusters.iter().zip(&chains).enumerate().map(|(state, (clusters, chains))| {
                let identity = |(nodes, &chain): (&Vec<usize>, &Chain)| Identity {
                    colour: colours[chain],
                    name: names.name(state, nodes, chain),
                };
                clusters.iter().zip(chains).map(identity).collect()
            });
        Self { of_state: of_state.collect(), shown }
    }
}

/// The name of cluster m of an experiment, with that of the group that it is.
pub fn own_name(network: &Network, m: usize, nodes: &[usize]) -> Label {
    let label = Label::math("C").subscript(&m.to_string());
    let group = network.groups().iter().find(|group| group.nodes == nodes);
    group.map_or(label.clone(), |group| label.with_text(format!(", {}", group.name)))
}

fn shown(states: &[State], clusters: &[Vec<Vec<usize>>]) -> Option<usize> {
    let parted = (0..states.len()).filter(|&state| states[state].clusters.n_clusters() > 1);
    let some = parted.filter(|&state| !clusters[state].is_empty());
    some.max_by_key(|&state| (clusters[state].len(), Reverse(state)))
}

/// The chain of every cluster of every state, and how many chains there are.
fn chains(n_nodes: usize, clusters: &[Vec<Vec<usize>>]) -> (Vec<Vec<Chain>>, usize) {
    // The chain that each node was in last, whether it is alone now or not.
    let mut last: Vec<Option<Chain>> = vec![None; n_nodes];
    let mut n_chains = 0;
    let of_state = clusters.iter().map(|clusters| {
        let chains = followed(&last, clusters, &mut n_chains);
        for (nodes, &chain) in clusters.iter().zip(&chains) {
            nodes.iter().for_each(|&node| last[node] = Some(chain));
        }
        chains
    });
    (of_state.collect(), n_chains)
}

/// For each cluster the mark that most of its nodes had before, every mark once, the most nodes in
/// common first; a new mark, the next number, for those that are left over.
pub fn followed(before: &[Option<usize>], clusters: &[Vec<usize>], next: &mut usize) -> Vec<usize> {
    let mut common: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (cluster, nodes) in clusters.iter().enumerate() {
        for mark in nodes.iter().filter_map(|&node| before[node]) {
            *common.entry((cluster, mark)).or_default() += 1;
        }
    }
    let mut common: Vec<_> = common.into_iter().collect();
    common.sort_by_key(|&(_, count)| Reverse(count));
    let mut marks: Vec<Option<usize>> = vec![None; clusters.len()];
    let mut taken = std::collections::BTreeSet::new();
    for ((cluster, mark), _) in common {
        if marks[cluster].is_none() && taken.insert(mark) {
            marks[cluster] = Some(mark);
        }
    }
    let mut new = || {
        *next += 1;
        *next - 1
    };
    marks.into_iter().map(|mark| mark.unwrap_or_else(&mut new)).collect()
}

/// The colour of every chain.
fn colours(
    chains: &[Vec<Chain>],
    n_chains: usize,
    clusters: &[Vec<Vec<usize>>],
    shown: Option<usize>,
) -> Vec<usize> {
    let mut largest = vec![0; n_chains];
    for (chains, clusters) in chains.iter().zip(clusters) {
        for (&chain, nodes) in chains.iter().zip(clusters) {
            largest[chain] = largest[chain].max(nodes.len());
        }
    }
    let mut place_shown = vec![usize::MAX; n_chains];
    for (place, &chain) in shown.iter().flat_map(|&state| chains[state].iter().enumerate()) {
        place_shown[chain] = place;
    }
    let mut order: Vec<Chain> = (0..n_chains).collect();
    order.sort_by_key(|&chain| (place_shown[chain], Reverse(largest[chain]), chain));
    let mut colours = vec![0; n_chains];
    order.into_iter().enumerate().for_each(|(colour, chain)| colours[chain] = colour);
    colours
}

/// Names of clusters: as long as one has the same nodes it is called the same.
struct Names<'a> {
    plan: &'a Plan,
    /// The number in `cascade.csv` of the cluster that begins in a state with a first node.
    numbers: HashMap<(usize, usize), usize>,
    /// The nodes of each chain when it was named last, and that name.
    named: HashMap<Chain, (Vec<usize>, Label)>,
}

impl<'a> Names<'a> {
    fn new(plan: &'a Plan, findings: &Findings) -> Self {
        let clusters = findings.trees.iter().flat_map(|tree| &tree.clusters);
        let begins = (1..)
            .zip(clusters)
            .map(|(number, cluster)| ((cluster.states.start, cluster.first_node), number));
        Self { plan, numbers: begins.collect(), named: HashMap::new() }
    }

    fn name(&mut self, state: usize, nodes: &[usize], chain: Chain) -> Label {
        if let Some((same, name)) = self.named.get(&chain)
            && same == nodes
        {
            return name.clone();
        }
        let group = self.plan.network.groups().iter().find(|group| group.nodes == nodes);
        let number = || self.numbers.get(&(state, nodes[0]));
        let name = match group {
            Some(group) => Label::text(group.name.as_str()),
            None => number().map_or_else(Label::default, |number| {
                Label::math("C").subscript(&number.to_string())
            }),
        };
        self.named.insert(chain, (nodes.to_vec(), name.clone()));
        name
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_part_goes_on_and_a_cluster_that_comes_back_is_itself() {
        let states: Vec<Vec<Vec<usize>>> = vec![
            vec![(0..10).collect()],
            vec![vec![0, 1, 2], vec![3, 4, 5, 6, 7]],
            vec![vec![0, 1]],
            vec![vec![0, 1, 2], vec![3, 4], vec![6, 7]],
            vec![(0..10).collect()],
        ];
        let (chains, n_chains) = chains(10, &states);
        // Of two halves of the chain of the five nodes the first goes on.
        let expected = [vec![0], vec![1, 0], vec![1], vec![1, 0, 2], vec![1]];
        assert_eq!((&chains[..4], n_chains), (&expected[..4], 3));
        let colours = colours(&chains, n_chains, &states, Some(3));
        assert_eq!(colours, [1, 0, 2], "the state that is shown has the first colours in order");
    }

    #[test]
    fn every_mark_is_given_once() {
        let before = [Some(5), Some(5), Some(5), Some(5), None];
        let mut next = 6;
        assert_eq!(followed(&before, &[vec![0], vec![1, 2, 3], vec![4]], &mut next), [6, 5, 7]);
    }
}
