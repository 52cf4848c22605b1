//! Which cluster is which: one colour and one name for it in every panel and every state.
//!
//! From state to state a cluster goes on in the one that has most of its nodes, whether it loses some
//! as ε falls or is joined by others; what is left over begins anew. So the largest part of a cluster
//! that splits keeps its colour, and a cluster that comes back after nodes were alone has its old one.
//! The clusters of the state that the network is coloured by have the first colours, then the largest.
//! Above all the same nodes are the same cluster. One is named after the group that it is, else by its
//! number in `cascade.csv`, that of the first row with these nodes.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, HashMap};

use clustering::State;
use eigensync::Findings;
use figures::Label;
use graph::Network;

use crate::stretches::{Stretch, stretches};
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

/// Least width of a state to be shown, of the whole cascade on a logarithmic scale: what a reader sees of
/// it.
const LEAST_SHOWN: f64 = 0.05;

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
        let names = names(plan, findings, &clusters);
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

/// The state with the most clusters beside the one of all nodes, of those that are wide enough to be
/// seen; the first of equals.
fn shown(states: &[State]) -> Option<usize> {
    let n_clusters = |state: usize| {
        let sizes = states[state].clusters.sizes();
        if sizes.len() > 1 { sizes.into_iter().filter(|&size| size > 1).count() } else { 0 }
    };
    let seen = stretches(states);
    // Ends of the whole on a logarithmic scale; states that go on beyond them are wide.
    let width = |(from, to): (f64, Option<f64>)| match to {
        Some(to) if from > 0.0 => (to / from).ln(),
        _ => f64::INFINITY,
    };
    let whole: f64 = seen.iter().map(|s| width(s.epsilon)).filter(|w| w.is_finite()).sum();
    let is_wide = |stretch: &Stretch| width(stretch.epsilon) >= LEAST_SHOWN * whole;
    let parted = seen.iter().map(|stretch| {
        let first = stretch.states.start;
        (n_clusters(first), is_wide(stretch), Reverse(first))
    });
    let parted = parted.filter(|&(n, ..)| n > 0);
    // One too narrow is better than none.
    let best = parted.max_by_key(|&(n, is_wide, first)| (is_wide, n, first));
    best.map(|(.., Reverse(first))| first)
}

/// The chain of every cluster of every state, and how many chains there are.
fn chains(n_nodes: usize, clusters: &[Vec<Vec<usize>>]) -> (Vec<Vec<Chain>>, usize) {
    // The chain that each node was in last, whether it is alone now or not.
    let mut last: Vec<Option<Chain>> = vec![None; n_nodes];
    let mut known: HashMap<&[usize], Chain> = HashMap::new();
    let mut n_chains = 0;
    let of_state = clusters.iter().map(|clusters| {
        // The same nodes are the same cluster, whatever they were in between.
        let same: Vec<Option<Chain>> =
            clusters.iter().map(|nodes| known.get(&nodes[..]).copied()).collect();
        let chains = followed_from(same, &last, clusters, &mut n_chains);
        for (nodes, &chain) in clusters.iter().zip(&chains) {
            nodes.iter().for_each(|&node| last[node] = Some(chain));
            known.entry(nodes).or_insert(chain);
        }
        chains
    });
    (of_state.collect(), n_chains)
}

/// For each cluster the mark that most of its nodes had before, every mark once, the most nodes in
/// common first; a new mark, the next number, for those that are left over.
pub fn followed(before: &[Option<usize>], clusters: &[Vec<usize>], next: &mut usize) -> Vec<usize> {
    followed_from(vec![None; clusters.len()], before, clusters, next)
}

/// The same with marks that some clusters have already, the first of those that have the same one.
fn followed_from(
    mut marks: Vec<Option<usize>>,
    before: &[Option<usize>],
    clusters: &[Vec<usize>],
    next: &mut usize,
) -> Vec<usize> {
    let mut taken = BTreeSet::new();
    marks.iter_mut().for_each(|mark| *mark = mark.filter(|&mark| taken.insert(mark)));
    let mut common: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (cluster, nodes) in clusters.iter().enumerate() {
        for mark in nodes.iter().filter_map(|&node| before[node]) {
            *common.entry((cluster, mark)).or_default() += 1;
        }
    }
    let mut common: Vec<_> = common.into_iter().collect();
    common.sort_by_key(|&(_, count)| Reverse(count));
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

/// The number and the name of every cluster of every state: those of the first state in which there was one
/// of the same nodes.
fn names(
    plan: &Plan,
    findings: &Findings,
    clusters: &[Vec<Vec<usize>>],
) -> Vec<Vec<(usize, Label)>> {
    let rows = (1..).zip(findings.trees.iter().flat_map(|tree| &tree.clusters));
    let begins = rows.map(|(number, row)| ((row.states.start, row.first_node), number));
    let numbers: HashMap<(usize, usize), usize> = begins.collect();
    let mut number_of: HashMap<&[usize], usize> = HashMap::new();
    let mut names = Vec::with_capacity(clusters.len());
    for (state, clusters) in clusters.iter().enumerate() {
        let mut of_state = Vec::with_capacity(clusters.len());
        for nodes in clusters {
            let new = || numbers.get(&(state, nodes[0])).copied().unwrap_or(0);
            let number = *number_of.entry(nodes).or_insert_with(new);
            of_state.push((number, name_of(&plan.study.network, number, nodes)));
        }
        names.push(of_state);
    }
    names
}

/// The name of the group that a cluster is, else its number.
fn name_of(network: &Network, number: usize, nodes: &[usize]) -> Label {
    match network.groups().iter().find(|group| group.nodes == nodes) {
        Some(group) => Label::text(group.name.as_str()),
        None => Label::math(letter(network)).subscript(&number.to_string()),
    }
}

/// C, or K where a group is called C1 or C_1, which would read as a cluster of that number.
fn letter(network: &Network) -> &'static str {
    let is_number = |name: &str| {
        let number =
            name.strip_prefix(['C', 'c']).map(|rest| rest.trim_start_matches(['_', ' ', '-']));
        number.is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit()))
    };
    if network.groups().iter().any(|group| is_number(&group.name)) { "K" } else { "C" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stretches::tests::state;

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
    fn the_same_nodes_are_the_same_cluster_whatever_they_were_in_between() {
        let parts = || vec![vec![0, 1, 2], vec![3, 4]];
        let states =
            vec![parts(), vec![(0..7).collect()], vec![vec![0, 1, 2], vec![3, 4], vec![5, 6]]];
        let (chains, n_chains) = chains(7, &states);
        assert_eq!(chains, [vec![0, 1], vec![0], vec![0, 1, 2]]);
        assert_eq!(n_chains, 3);
    }

    #[test]
    fn a_state_too_narrow_to_be_seen_is_shown_only_where_no_other_has_clusters() {
        let (all, two, three) = ([0; 6], [0, 0, 0, 1, 1, 1], [0, 0, 1, 1, 2, 2]);
        let mut states = vec![
            state((3.0, None), &all),
            state((1.01, Some(3.0)), &two),
            state((1.0, Some(1.01)), &three),
            state((0.5, Some(1.0)), &[0, 1, 2, 3, 4, 5]),
        ];
        assert_eq!(shown(&states), Some(1));
        states[1].clusters = states[0].clusters.clone();
        assert_eq!(shown(&states), Some(2));
        states[2] = state((0.8, Some(1.01)), &three);
        states[1] = state((1.01, Some(3.0)), &two);
        states[3].epsilon.1 = Some(0.8);
        assert_eq!(shown(&states), Some(2));
    }

    #[test]
    fn every_mark_is_given_once() {
        let before = [Some(5), Some(5), Some(5), Some(5), None];
        let mut next = 6;
        assert_eq!(followed(&before, &[vec![0], vec![1, 2, 3], vec![4]], &mut next), [6, 5, 7]);
    }
}
