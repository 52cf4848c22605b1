//! Single linkage below a threshold without a look at every pair, by dividing the nodes in space.
//!
//! A cell of nodes is cut across its longest side. Once both halves are linked within, only those
//! nodes matter that are near the box around the other half: a strip on either side of the cut. The
//! strips are cut in turn, and each half meets what is near it of the other strip. Where a strip is
//! most of its cell, the halves of one cell meet the other cell instead.
//!
//! Three observations settle much at once: all nodes of a cell no wider than the threshold are
//! linked; between nodes of one cluster and nodes of another, one link is enough; and nodes that are
//! in the other side's one cluster already need no more.
//!
//! Space is that of [`crate::coordinates`], which bound the distance.
//!
//! Few modes take O(N log N) where cells are linked at once or strips are short, as on lines and
//! surfaces, and hardly more in clouds without structure as long as strips are narrow. Where every
//! node is within the threshold of some others in a cloud of six or more dimensions, the threshold is
//! hardly smaller than the cloud for any N of practice, and it comes to O(N²).
//!
//! Source: strips and their halves as Bentley & Shamos, Proc. STOC 220 (1976); cells below the
//! threshold and one link between two of them as Gan & Tao, Proc. SIGMOD 519 (2015), for a grid.

#[cfg(test)]
mod tests;

use std::cell::Cell as Shared;
use std::ops::Range;

use crate::Partition;
use crate::cells::{Bounds, Points, Rows};
use crate::coordinates::Coordinates;
use crate::disjoint_sets::DisjointSets;

/// Most nodes of a cell that is not halved: measured, as the next two, and of no consequence but for
/// the time.
const LEAF: usize = 24;

/// Most pairs of nodes of two strips that are looked at one by one.
const PAIRS: usize = 256;

/// Two cells give strips if these are at most so wide against the cells; otherwise each half of the
/// larger cell meets the other cell.
const NARROW: f64 = 0.3;

/// The clusters of single linkage within the groups of nodes of a partition: links lead from one
/// group to no other.
///
/// None if it takes more than `work` components to be looked at.
pub(crate) fn clusters_within_groups(
    points: Points,
    threshold: f64,
    groups: &Partition,
    work: &mut usize,
) -> Option<Partition> {
    let members = groups.members();
    let sets = DisjointSets::new(members.nodes.len());
    let large = members.clusters().filter(|group| group.len() > LEAF);
    let coordinates = Coordinates::new(points, large.flatten(), threshold);
    let mut row = vec![0.0; coordinates.order()];
    let mut rows = Rows::new(coordinates.order());
    let mut linkage = Linkage { points, threshold, coordinates, sets, work };
    for group in members.clusters().filter(|group| group.len() > 1) {
        if group.len() <= LEAF {
            linkage.link_all(group);
            continue;
        }
        rows.restart(group.len());
        for &node in group {
            linkage.coordinates.write(points.row(node as usize), &mut row);
            rows.push(node, &row);
        }
        linkage.link_within(&mut rows, 0..group.len());
    }
    let is_done = *linkage.work > 0;
    is_done.then(|| Partition::from_roots(&linkage.sets.roots()))
}

struct Linkage<'a> {
    points: Points<'a>,
    threshold: f64,
    /// Coordinates of the rows, in which cells and strips are cut.
    coordinates: Coordinates,
    sets: DisjointSets,
    /// How many components may still be looked at.
    work: &'a mut usize,
}

/// Places whose nodes are linked within.
struct Cell {
    places: Range<usize>,
    bounds: Bounds,
    /// Whether all nodes are known to be in one cluster.
    is_whole: Shared<bool>,
    /// What it had to be halved into to be linked.
    halves: Option<Box<[Cell; 2]>>,
}

/// Nodes that are linked within, to be linked with those of another part.
struct Part<'a> {
    rows: &'a Rows,
    places: Range<usize>,
    bounds: &'a Bounds,
    /// The cluster of all nodes, where they are known to be in one.
    cluster: Option<u32>,
}

impl Linkage<'_> {
    /// Links all pairs of a few nodes.
    fn link_all(&mut self, nodes: &[u32]) {
        for (k, &i) in nodes.iter().enumerate() {
            self.spend(nodes.len() - k);
            for &j in &nodes[k + 1..] {
                self.link_nodes(i, j);
            }
        }
    }

    /// Links all pairs in some places.
    fn link_within(&mut self, rows: &mut Rows, places: Range<usize>) -> Cell {
        self.spend(places.len());
        let bounds = rows.bounds(places.clone());
        if self.coordinates.are_linked(&bounds) {
            let nodes = rows.nodes(places.clone());
            nodes[1..].iter().for_each(|&node| self.sets.join(nodes[0], node));
            return Cell { places, bounds, is_whole: true.into(), halves: None };
        }
        let mut halves = None;
        if places.len() <= LEAF {
            for i in places.clone() {
                (i + 1..places.end).for_each(|j| _ = self.link(rows, i, rows, j));
            }
        } else if *self.work > 0 {
            let middle = rows.halve(places.clone(), bounds.longest_side(), &bounds);
            let left = self.link_within(rows, places.start..middle);
            let right = self.link_within(rows, middle..places.end);
            self.link_cells(rows, &left, &right);
            halves = Some(Box::new([left, right]));
        }
        Cell { places, bounds, is_whole: false.into(), halves }
    }

    /// Links all pairs of two cells.
    fn link_cells(&mut self, rows: &Rows, a: &Cell, b: &Cell) {
        let (of_a, of_b) = (self.part(rows, a), self.part(rows, b));
        if self.are_settled(&of_a, &of_b) {
            return;
        }
        let (small, large) = if a.places.len() < b.places.len() { (a, b) } else { (b, a) };
        let (column, width) = self.coordinates.narrowest_overlap(&a.bounds, &b.bounds);
        match &large.halves {
            Some(halves) if width > NARROW => {
                halves.iter().for_each(|half| self.link_cells(rows, small, half));
            }
            _ => self.link_strips(&of_a, &of_b, column),
        }
    }

    /// Links all pairs of two parts through the nodes of each that may be near some of the other.
    fn link_strips(&mut self, a: &Part, b: &Part, column: usize) {
        let one_is_enough = a.cluster.is_some() && b.cluster.is_some();
        let near_b = self.near(a, b, column);
        if near_b.len() == 0 {
            return;
        }
        let (a, b) = (near_b, self.near(b, a, column));
        let (small, mut large) = if a.len() < b.len() { (a, b) } else { (b, a) };
        if small.len() * large.len() <= PAIRS {
            return self.link_pairs(&small, &large, one_is_enough);
        }
        let around_small = small.bounds(0..small.len());
        let around_large = large.bounds(0..large.len());
        let middle = large.halve(0..large.len(), around_large.longest_side(), &around_large);
        for places in [0..middle, middle..large.len()] {
            let bounds = large.bounds(places.clone());
            let cluster = self.cluster_of(large.nodes(places.clone()));
            let half = Part { rows: &large, places, bounds: &bounds, cluster };
            let (places, cluster) = (0..small.len(), self.cluster_of(small.nodes(0..small.len())));
            let small = Part { rows: &small, places, bounds: &around_small, cluster };
            if !self.are_settled(&half, &small) {
                let (column, _) = self.coordinates.narrowest_overlap(&bounds, &around_small);
                self.link_strips(&half, &small, column);
            }
        }
    }

    /// Links all pairs of two lists of rows, or one.
    fn link_pairs(&mut self, a: &Rows, b: &Rows, one_is_enough: bool) {
        for i in 0..a.len() {
            for j in 0..b.len() {
                if self.link(a, i, b, j) && one_is_enough {
                    return;
                }
            }
        }
    }

    /// Links the nodes in two places if they are near.
    fn link(&mut self, a: &Rows, i: usize, b: &Rows, j: usize) -> bool {
        self.spend(1);
        self.coordinates.may_be_linked(a.row(i), b.row(j)) && self.link_nodes(a.node(i), b.node(j))
    }

    /// Links two nodes if they are near.
    fn link_nodes(&mut self, i: u32, j: u32) -> bool {
        let (a, b) = (self.points.row(i as usize), self.points.row(j as usize));
        let is_near = self.points.metric.distance_up_to(self.threshold, a, b) <= self.threshold;
        if is_near {
            self.sets.join(i, j);
        }
        is_near
    }

    /// Whether two parts are too far apart for a link, or one cluster, if need be by a link of their
    /// first nodes.
    fn are_settled(&mut self, a: &Part, b: &Part) -> bool {
        self.spend(1);
        if !self.coordinates.may_meet(a.bounds, b.bounds) || *self.work == 0 {
            return true;
        }
        a.cluster.zip(b.cluster).is_some_and(|(of_a, of_b)| {
            of_a == of_b || self.link(a.rows, a.places.start, b.rows, b.places.start)
        })
    }

    /// The nodes of a part that may be near some of another and are not known to be in its cluster.
    fn near(&mut self, part: &Part, other: &Part, column: usize) -> Rows {
        let Part { rows, places, .. } = part;
        self.spend(places.len());
        let Self { coordinates, sets, .. } = self;
        let reach = coordinates.reach;
        let (low, high) = (other.bounds.low[column], other.bounds.high[column]);
        let mut near = Rows::new(coordinates.order());
        for (row, &node) in rows.rows(places.clone()).zip(rows.nodes(places.clone())) {
            let x = row[column];
            if low - x <= reach
                && x - high <= reach
                && coordinates.may_be_near(row, other.bounds)
                && other.cluster.is_none_or(|cluster| sets.root(node) != cluster)
            {
                near.push(node, row);
            }
        }
        near
    }

    fn part<'a>(&mut self, rows: &'a Rows, cell: &'a Cell) -> Part<'a> {
        let cluster = self.cluster_of_cell(rows, cell);
        Part { rows, places: cell.places.clone(), bounds: &cell.bounds, cluster }
    }

    /// The cluster of a cell whose nodes are all known to be in one: cells become so in time.
    fn cluster_of_cell(&mut self, rows: &Rows, cell: &Cell) -> Option<u32> {
        let nodes = rows.nodes(cell.places.clone());
        let cluster = self.sets.root(nodes[0]);
        if !cell.is_whole.get() {
            cell.is_whole.set(match &cell.halves {
                Some(halves) => {
                    halves.iter().all(|half| half.is_whole.get())
                        && self.sets.root(rows.node(halves[1].places.start)) == cluster
                }
                None => nodes.iter().all(|&node| self.sets.root(node) == cluster),
            });
        }
        cell.is_whole.get().then_some(cluster)
    }

    /// The cluster that these nodes are in, if it is one.
    fn cluster_of(&mut self, nodes: &[u32]) -> Option<u32> {
        let cluster = self.sets.root(nodes[0]);
        nodes.iter().all(|&node| self.sets.root(node) == cluster).then_some(cluster)
    }

    /// Counts the components of this many rows.
    fn spend(&mut self, n_rows: usize) {
        *self.work = self.work.saturating_sub(n_rows * self.coordinates.order());
    }
}
