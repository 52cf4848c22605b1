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
use eigensync::Findings;
use figures::Label;
use graph::Network;

use experiment::Plan;

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
    /// The state by whose clusters the network is coloured; none where none has clusters beside the one
    /// of all nodes.
    pub shown: Option<usize>,
}

/// A cluster as it goes on from state to state.
type Chain = usize;

impl Identities {
    /// With the state to be shown that has the most clusters beside the one of all nodes.
    pub fn of(plan: &Plan, findings: &Findings) -> Self {
        Self::showing(plan, findings, shown(&findings.cascade))
    }

    /// With this state to be shown, whose clusters have the first colours.
    pub fn showing(plan: &Plan, findings: &Findings, shown: Option<usize>) -> Self {
        let states = &findings.cascade;
        let clusters: Vec<Vec<Vec<usize>>> =
            states.iter().map(|state| state.clusters.nontrivial()).collect();
        let (chains, n_chains) = chains(plan.study.network.n_nodes(), &clusters);
        let names = names(plan, findings, &clusters, &chains);
        let mut first: Vec<(usize, Chain)> = shown.map_or_else(Vec::new, |state| {
            names[state].iter().map(|(number, _)| *number).zip(chains[state].clone()).collect()
        });
        first.sort_unstable();
        let first: Vec<Chain> = first.into_iter().map(|(_, chain)| chain).collect();
        let colours = colours(&chains, n_chains, &clusters, &first);
        let of_state = names.into_iter().zip(&chains).map(|(names, chains)| {
            let named = names.into_iter().zip(chains);
            named.map(|((_, name), &chain)| Identity { colour: colours[chain], name }).collect()
        });
        Self { of_state: of_state.collect(), shown }
    }

    /// How many clusters are shown.
    pub fn n_shown(&self) -> usize {
        self.shown.map_or(0, |state| self.of_state[state].len())
    }

    /// The colour of each node's cluster in the state to be shown.
    pub fn shown_colours(&self, findings: &Findings, n_nodes: usize) -> Vec<Option<usize>> {
        let mut colours = vec![None; n_nodes];
        if let Some(state) = self.shown {
            let clusters = findings.cascade[state].clusters.nontrivial();
            for (nodes, identity) in clusters.iter().zip(&self.of_state[state]) {
                nodes.iter().for_each(|&node| colours[node] = Some(identity.colour));
            }
        }
        colours
    }
}

/// The name of cluster m of an experiment, with that of the group that it is.
pub fn own_name(network: &Network, m: usize, nodes: &[usize]) -> Label {
    let label = Label::math("C").subscript(&m.to_string());
    let group = network.groups().iter().find(|group| group.nodes == nodes);
    group.map_or(label.clone(), |group| label.with_text(format!(", {}", group.name)))
}

fn shown(states: &[State]) -> Option<usize> {
    let n_clusters = |state: usize| {
        let sizes = states[state].clusters.sizes();
        if sizes.len() > 1 { sizes.into_iter().filter(|&size| size > 1).count() } else { 0 }
    };
    let counts = (0..states.len()).map(|state| (n_clusters(state), Reverse(state)));
    counts.filter(|&(n, _)| n > 0).max().map(|(_, Reverse(state))| state)
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

/// The colour of every chain: the first colours for these, then by falling size.
fn colours(
    chains: &[Vec<Chain>],
    n_chains: usize,
    clusters: &[Vec<Vec<usize>>],
    first: &[Chain],
) -> Vec<usize> {
    let mut largest = vec![0; n_chains];
    for (chains, clusters) in chains.iter().zip(clusters) {
        for (&chain, nodes) in chains.iter().zip(clusters) {
            largest[chain] = largest[chain].max(nodes.len());
        }
    }
    let mut place_shown = vec![usize::MAX; n_chains];
    for (place, &chain) in first.iter().enumerate() {
        place_shown[chain] = place;
    }
    let mut order: Vec<Chain> = (0..n_chains).collect();
    order.sort_by_key(|&chain| (place_shown[chain], Reverse(largest[chain]), chain));
    let mut colours = vec![0; n_chains];
    order.into_iter().enumerate().for_each(|(colour, chain)| colours[chain] = colour);
    colours
}

/// The number and the name of every cluster of every state. As long as one has the same nodes it is called
/// the same.
fn names(
    plan: &Plan,
    findings: &Findings,
    clusters: &[Vec<Vec<usize>>],
    chains: &[Vec<Chain>],
) -> Vec<Vec<(usize, Label)>> {
    let rows = (1..).zip(findings.trees.iter().flat_map(|tree| &tree.clusters));
    let begins = rows.map(|(number, row)| ((row.states.start, row.first_node), number));
    let numbers: HashMap<(usize, usize), usize> = begins.collect();
    // The nodes of each chain when it was named last, and their number.
    let mut last: HashMap<Chain, (&[usize], usize)> = HashMap::new();
    let states = clusters.iter().zip(chains).enumerate().map(|(state, (clusters, chains))| {
        clusters
            .iter()
            .zip(chains)
            .map(|(nodes, &chain)| {
                let number = match last.get(&chain) {
                    Some((same, number)) if *same == &nodes[..] => *number,
                    _ => numbers.get(&(state, nodes[0])).copied().unwrap_or(0),
                };
                last.insert(chain, (nodes, number));
                (number, name_of(&plan.study.network, number, nodes))
            })
            .collect()
    });
    states.collect()
}

/// The name of the group that a cluster is, else its number.
fn name_of(network: &Network, number: usize, nodes: &[usize]) -> Label {
    match network.groups().iter().find(|group| group.nodes == nodes) {
        Some(group) => Label::text(group.name.as_str()),
        None => Label::math("C").subscript(&number.to_string()),
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
        let colours = colours(&chains, n_chains, &states, &chains[3]);
        assert_eq!(colours, [1, 0, 2], "the state that is shown has the first colours in order");
    }

    #[test]
    fn every_mark_is_given_once() {
        let before = [Some(5), Some(5), Some(5), Some(5), None];
        let mut next = 6;
        assert_eq!(followed(&before, &[vec![0], vec![1, 2, 3], vec![4]], &mut next), [6, 5, 7]);
    }
}
