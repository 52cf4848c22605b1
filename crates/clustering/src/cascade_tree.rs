//! The cascade as a tree: which cluster splits into which, and at which ε.
//!
//! As ε falls, the clusters of one state either stay or split while each state's partition refines
//! that of the state above, as exact clusters do above one critical σ_c. Where some clusters merge
//! again (a bounded stable set; a threshold on δe, which is a mean over modes) no tree describes the
//! states across that ε: one tree ends there and another begins.
//!
//! Where the nodes of a cluster stay together but its cells change between one and several, exact
//! synchrony is lost in it, or found: it ends there, and is its own only part.

use std::ops::Range;

use crate::{ClusterKind, ClusterLabel, State, StateLabels};

/// The clusters of a run of states in which they only split, from the largest ε down.
#[derive(Clone, Debug, PartialEq)]
pub struct CascadeTree {
    /// The states it covers, as places among those it was made of.
    pub states: Range<usize>,
    /// All clusters, numbered by their place: those of the first state by first node, then those of
    /// each further split. The parts of one cluster follow one another, by first node.
    pub clusters: Vec<TreeCluster>,
    /// Why it ends.
    pub end: TreeEnd,
    /// Number of nodes that are in no listed cluster from the first state on.
    pub n_unlisted: usize,
}

/// Why a tree ends at the lower end of its last state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TreeEnd {
    /// There is no smaller coupling: the cascade is complete.
    ZeroCoupling,
    /// Modes beyond those computed may become unstable.
    ModesNotComputed,
    /// Some clusters merge below this ε: the next tree begins there.
    ClustersMerge {
        /// The coupling.
        epsilon: f64,
    },
}

/// One cluster, for as long as its nodes stay together, no others join, and it is one cell or is not.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeCluster {
    /// The cluster it is a part of; none for those of the first state.
    pub parent: Option<usize>,
    /// Its listed parts, as places among the clusters; empty where it does not split, or into
    /// clusters too small to be listed.
    pub children: Range<usize>,
    /// Whether it splits or stops being exact at the lower end of its range of ε, rather than the tree
    /// ends there.
    pub splits: bool,
    /// Open range of the coupling, from below; no upper end where it is unbounded.
    pub epsilon: (f64, Option<f64>),
    /// The states in which it exists.
    pub states: Range<usize>,
    /// Number of nodes.
    pub size: usize,
    /// Its lowest node.
    pub first_node: usize,
    /// Number of its nodes that end up in clusters too small to be listed when it splits.
    pub n_unlisted: usize,
    /// Its label, once [`CascadeTree::label`] has been asked for it: the worst of those in its
    /// states.
    pub label: Option<ClusterLabel>,
}

/// A cluster in flat form: one line of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeRow {
    /// Its number.
    pub id: usize,
    /// The number of the cluster that it is a part of.
    pub parent: Option<usize>,
    /// Lower end of its range of ε, where it splits or the tree ends.
    pub epsilon_from: f64,
    /// Upper end, where it appears; none where it is there at every larger coupling.
    pub epsilon_to: Option<f64>,
    /// Number of nodes.
    pub size: usize,
    /// Its lowest node.
    pub first_node: usize,
    /// Its kind, if it was labelled or is of one node.
    pub kind: Option<ClusterKind>,
}

impl CascadeTree {
    /// The trees of a cascade, one for each longest run of states in which clusters only split.
    ///
    /// There is one tree for exact clusters and a stable set σ > σ_c. Clusters of fewer nodes than
    /// `smallest` are not listed, only their nodes are counted: a million single nodes tell nothing.
    /// O(N · states).
    ///
    /// # Panics
    /// If the states are not of the same nodes.
    pub fn of_each_run(states: &[State], smallest: usize) -> Vec<Self> {
        let is_last = |s: usize| {
            s + 1 == states.len() || !states[s + 1].clusters.is_refinement_of(&states[s].clusters)
        };
        let mut start = 0;
        let mut trees = Vec::new();
        for last in (0..states.len()).filter(|&s| is_last(s)) {
            trees.push(Self::of_run(states, start..last + 1, smallest));
            start = last + 1;
        }
        trees
    }

    fn of_run(states: &[State], run: Range<usize>, smallest: usize) -> Self {
        let mut growth = Growth::new(&states[run.start], run.start, smallest);
        for number in run.start + 1..run.end {
            growth.split(&states[number - 1], &states[number], number);
        }
        let last = &states[run.end - 1];
        let end = match last {
            _ if run.end < states.len() => TreeEnd::ClustersMerge { epsilon: last.epsilon.0 },
            State { truncated: true, .. } => TreeEnd::ModesNotComputed,
            _ => TreeEnd::ZeroCoupling,
        };
        growth.finish(last, run, end)
    }

    /// The tree in flat form, one row a cluster, in the order of their numbers.
    pub fn rows(&self) -> impl Iterator<Item = TreeRow> {
        let row = |(id, cluster): (usize, &TreeCluster)| TreeRow {
            id,
            parent: cluster.parent,
            epsilon_from: cluster.epsilon.0,
            epsilon_to: cluster.epsilon.1,
            size: cluster.size,
            first_node: cluster.first_node,
            kind: match cluster.size {
                1 => Some(ClusterKind::Single),
                _ => cluster.label.map(|label| label.kind),
            },
        };
        self.clusters.iter().enumerate().map(row)
    }

    /// The nodes of a cluster, ascending. O(N).
    ///
    /// # Panics
    /// If there is no such cluster, or the states are not those the tree was made of.
    pub fn members(&self, states: &[State], cluster: usize) -> Vec<usize> {
        let TreeCluster { states: of, first_node, .. } = &self.clusters[cluster];
        let cluster_of = states[of.start].clusters.cluster_of();
        let number = cluster_of[*first_node];
        (0..cluster_of.len()).filter(|&node| cluster_of[node] == number).collect()
    }

    /// For every node, the smallest listed cluster that it is ever in; none for a node in no listed
    /// cluster. Its parents are the other clusters of the node. O(N · states).
    ///
    /// # Panics
    /// If the states are not those the tree was made of.
    pub fn innermost(&self, states: &[State]) -> Vec<Option<usize>> {
        let mut innermost = Vec::new();
        let mut appearing = (0..self.clusters.len()).peekable();
        for number in self.states.clone() {
            let partition = &states[number].clusters;
            innermost.resize(partition.n_nodes(), None);
            let mut listed = vec![None; partition.n_clusters()];
            let starts_here = |&id: &usize| self.clusters[id].states.start == number;
            while let Some(id) = appearing.next_if(starts_here) {
                listed[partition.cluster_of()[self.clusters[id].first_node]] = Some(id);
            }
            for (innermost, &cluster) in innermost.iter_mut().zip(partition.cluster_of()) {
                *innermost = listed[cluster].or(*innermost);
            }
        }
        innermost
    }

    /// Labels every cluster with the worst of its labels in the states where it exists.
    ///
    /// # Panics
    /// If these are not the states the tree was made of and their labels.
    pub fn label(&mut self, states: &[State], labels: &[StateLabels]) {
        for number in self.states.clone() {
            let cluster_of = states[number].clusters.cluster_of();
            let labels = &labels[number].labels;
            for cluster in self.clusters.iter_mut().filter(|c| c.states.contains(&number)) {
                let label = labels[cluster_of[cluster.first_node]];
                cluster.label = Some(cluster.label.map_or(label, |so_far| so_far.worse(label)));
            }
        }
    }
}

/// A tree while states are added.
struct Growth {
    smallest: usize,
    clusters: Vec<TreeCluster>,
    n_unlisted: usize,
    /// Of every cluster of the last state, the number in the tree; none where it is not listed.
    alive: Vec<Option<usize>>,
}

impl Growth {
    fn new(first: &State, number: usize, smallest: usize) -> Self {
        let mut growth = Self { smallest, clusters: Vec::new(), n_unlisted: 0, alive: Vec::new() };
        let partition = &first.clusters;
        for (first_node, size) in partition.first_nodes().into_iter().zip(partition.sizes()) {
            let part = Part { parent: None, first_node, size };
            let listed = growth.add(&part, first, number);
            growth.alive.push(listed);
        }
        growth
    }

    /// Goes on to a state whose clusters are those of the state above, or parts of them.
    fn split(&mut self, above: &State, state: &State, number: usize) {
        let sizes_above = above.clusters.sizes();
        let mut alive = vec![None; state.clusters.n_clusters()];
        let mut parts = Vec::new();
        let sizes = state.clusters.sizes();
        let (was_one_cell, is_one_cell) = (one_cell(above), one_cell(state));
        for (cluster, first_node) in state.clusters.first_nodes().into_iter().enumerate() {
            let of = above.clusters.cluster_of()[first_node];
            let parent = self.alive[of];
            if sizes[cluster] == sizes_above[of] && is_one_cell[cluster] == was_one_cell[of] {
                alive[cluster] = parent;
            } else if parent.is_some() {
                parts.push((cluster, Part { parent, first_node, size: sizes[cluster] }));
            }
        }
        parts.sort_by_key(|(_, part)| part.parent);
        for (cluster, part) in &parts {
            self.end(part.parent, above, number, true);
            alive[*cluster] = self.add(part, state, number);
        }
        self.alive = alive;
    }

    /// Lists a cluster that appears in a state, if it is large enough; its number.
    fn add(&mut self, part: &Part, state: &State, number: usize) -> Option<usize> {
        if part.size < self.smallest {
            match part.parent {
                Some(parent) => self.clusters[parent].n_unlisted += part.size,
                None => self.n_unlisted += part.size,
            }
            return None;
        }
        let id = self.clusters.len();
        if let Some(parent) = part.parent {
            let children = &mut self.clusters[parent].children;
            let start = if children.end == 0 { id } else { children.start };
            *children = start..id + 1;
        }
        self.clusters.push(TreeCluster {
            parent: part.parent,
            children: 0..0,
            splits: false,
            epsilon: state.epsilon,
            states: number..number + 1,
            size: part.size,
            first_node: part.first_node,
            n_unlisted: 0,
            label: None,
        });
        Some(id)
    }

    /// Ends a cluster after a state, the one before `number`.
    fn end(&mut self, cluster: Option<usize>, last: &State, number: usize, splits: bool) {
        if let Some(cluster) = cluster {
            let cluster = &mut self.clusters[cluster];
            cluster.epsilon.0 = last.epsilon.0;
            cluster.states.end = number;
            cluster.splits = splits;
        }
    }

    fn finish(mut self, last: &State, states: Range<usize>, end: TreeEnd) -> CascadeTree {
        for cluster in std::mem::take(&mut self.alive) {
            self.end(cluster, last, states.end, false);
        }
        let Self { clusters, n_unlisted, .. } = self;
        CascadeTree { states, clusters, end, n_unlisted }
    }
}

/// Whether each cluster of a state is one cell.
fn one_cell(state: &State) -> Vec<bool> {
    let (sizes, cells) = (state.clusters.sizes(), &state.cells);
    let cell_sizes = cells.sizes();
    let first_nodes = state.clusters.first_nodes();
    let is_one = |(first, size): (usize, usize)| cell_sizes[cells.cluster_of()[first]] == size;
    first_nodes.into_iter().zip(sizes).map(is_one).collect()
}

/// A cluster that appears in a state.
struct Part {
    parent: Option<usize>,
    first_node: usize,
    size: usize,
}
