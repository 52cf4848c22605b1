//! Where the clusters of each state stand, in nodes from the top, and which bands go on from state
//! to state.
//!
//! A strand is a band over the states in which a cluster is the largest part of what it came from, and
//! has its colour, or a block of clusters too thin to tell apart. What comes from a strand lies within its extent,
//! first the clusters thick enough for bands of their own by falling size, then one block of all
//! others, then the nodes that have become alone.

use std::cmp::Reverse;

use super::panel::{CascadeCluster, CascadePanel};

/// A band or block over consecutive states.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Strand {
    /// The first state it is in.
    pub(super) first: usize,
    /// Its extents in that state and those that follow.
    pub(super) stretches: Vec<Stretch>,
    /// Number of its colour: that of its cluster in the first state it is in; a block has that of the
    /// band it came from.
    pub(super) colour: usize,
    /// Whether it is a block.
    pub(super) is_block: bool,
}

/// The extent of a strand in one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    /// Nodes above it.
    pub(super) from: usize,
    /// One past its last node.
    pub(super) to: usize,
    /// Its clusters.
    pub(super) clusters: Clusters,
}

/// The clusters of a strand in one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Clusters {
    /// The one at this position among those of the state.
    One(usize),
    /// So many, too thin for bands of their own.
    Block(usize),
}

impl Strand {
    /// Its extent in a state; none where it has not begun or has ended.
    pub(super) fn at(&self, state: usize) -> Option<&Stretch> {
        self.stretches.get(state.checked_sub(self.first)?)
    }
}

/// The strands of a cascade; clusters below `least` nodes are in blocks.
pub(super) fn strands(panel: &CascadePanel, least: usize) -> Vec<Strand> {
    let mut layout = Layout { strands: Vec::new(), least };
    let mut strand_of = Vec::new();
    for (number, state) in panel.states.iter().enumerate() {
        let rooms = layout.rooms(number, &state.clusters, &strand_of);
        strand_of = layout.fill(number, &state.clusters, rooms, &strand_of);
    }
    layout.strands
}

/// An extent that clusters of the next state share.
struct Room {
    /// The strand whose extent it is; none for the whole network.
    strand: Option<usize>,
    /// Nodes above it.
    from: usize,
    /// Positions of the clusters.
    clusters: Vec<usize>,
}

struct Layout {
    strands: Vec<Strand>,
    least: usize,
}

impl Layout {
    /// The extents of the strands of the state before, from the top, with the clusters that come
    /// from them. `strand_of` has the strand of each cluster of that state.
    fn rooms(&self, state: usize, clusters: &[CascadeCluster], strand_of: &[usize]) -> Vec<Room> {
        let parents: Option<Vec<usize>> = clusters.iter().map(|c| c.parent).collect();
        let Some(parents) = parents.filter(|_| state > 0) else {
            return vec![Room { strand: None, from: 0, clusters: (0..clusters.len()).collect() }];
        };
        let mut of_strand: Vec<Vec<usize>> = vec![Vec::new(); self.strands.len()];
        for (cluster, parent) in parents.into_iter().enumerate() {
            of_strand[strand_of[parent]].push(cluster);
        }
        let rooms = of_strand.into_iter().enumerate().filter_map(|(strand, clusters)| {
            let from = self.strands[strand].at(state - 1)?.from;
            Some(Room { strand: Some(strand), from, clusters })
        });
        let mut rooms: Vec<Room> = rooms.collect();
        rooms.sort_by_key(|room| room.from);
        rooms
    }

    /// Adds a state to the strands; returns the strand of each of its clusters.
    fn fill(
        &mut self,
        state: usize,
        clusters: &[CascadeCluster],
        rooms: Vec<Room>,
        before: &[usize],
    ) -> Vec<usize> {
        let heirs = heirs(clusters, before.len());
        let mut strand_of = vec![0; clusters.len()];
        for room in rooms {
            let (mut thick, thin): (Vec<usize>, Vec<usize>) =
                room.clusters.iter().partition(|&&c| clusters[c].n_nodes >= self.least);
            thick.sort_by_key(|&c| (Reverse(clusters[c].n_nodes), c));
            let mut from = room.from;
            for c in thick {
                // What a thick cluster came from was thick too, so that it had a band.
                let goes_on = |p: &usize| {
                    heirs[*p] == Some(c) && self.strands[before[*p]].colour == clusters[c].colour
                };
                let parent = clusters[c].parent.filter(goes_on);
                let strand = match parent {
                    Some(parent) => before[parent],
                    None => self.begin(state, clusters[c].colour, false),
                };
                let to = from + clusters[c].n_nodes;
                self.strands[strand].stretches.push(Stretch {
                    from,
                    to,
                    clusters: Clusters::One(c),
                });
                strand_of[c] = strand;
                from = to;
            }
            if !thin.is_empty() {
                let strand = self.block(state, room.strand, clusters[thin[0]].colour);
                let to = from + thin.iter().map(|&c| clusters[c].n_nodes).sum::<usize>();
                let stretch = Stretch { from, to, clusters: Clusters::Block(thin.len()) };
                self.strands[strand].stretches.push(stretch);
                thin.iter().for_each(|&c| strand_of[c] = strand);
            }
        }
        strand_of
    }

    /// The block of a room: the one of the state before, or a new one of the colour of its band, or of
    /// its first cluster where it is in none.
    fn block(&mut self, state: usize, room: Option<usize>, first: usize) -> usize {
        match room {
            Some(strand) if self.strands[strand].is_block => strand,
            Some(strand) => self.begin(state, self.strands[strand].colour, true),
            None => self.begin(state, first, true),
        }
    }

    fn begin(&mut self, first: usize, colour: usize, is_block: bool) -> usize {
        self.strands.push(Strand { first, stretches: Vec::new(), colour, is_block });
        self.strands.len() - 1
    }
}

/// The largest cluster, the first of equals, that comes from each cluster of the state before.
fn heirs(clusters: &[CascadeCluster], n_before: usize) -> Vec<Option<usize>> {
    let mut heirs: Vec<Option<usize>> = vec![None; n_before];
    for (c, cluster) in clusters.iter().enumerate() {
        let Some(heir) = cluster.parent.map(|parent| &mut heirs[parent]) else { continue };
        if heir.is_none_or(|other| clusters[other].n_nodes < cluster.n_nodes) {
            *heir = Some(c);
        }
    }
    heirs
}
