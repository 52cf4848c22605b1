//! Single linkage below a threshold without a look at every pair, by a tree of cells.
//!
//! Three observations make it cheap: all nodes of a cell no wider than the threshold are linked;
//! cells whose boxes are further apart than the threshold have no link; and between two cells that
//! are one cluster each, one link is enough, and none is needed once they are the same cluster.
//! Cells are split only where none of the three settles the matter.
//!
//! Few modes take O(N log N). Where many cells are within the threshold of one another and are not
//! linked, or only just not, it comes to O(N²): in clouds of no structure that fills six or more
//! dimensions, each box has a neighbour on every side and corner.
//!
//! Source: cells below the threshold and the closest pair of two of them as Gan & Tao, Proc. SIGMOD
//! 519 (2015), have them for a grid.

use crate::Partition;
use crate::cell_tree::{CellTree, Points};
use crate::disjoint_sets::DisjointSets;
use crate::metric::Bounds;

/// Most nodes of a cell that is not split: measured, and of no consequence but for the time.
const LEAF: usize = 12;

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
    let mut linkage = Linkage {
        points,
        threshold,
        sets: DisjointSets::new(members.nodes.len()),
        tree: CellTree::new(points, members.nodes),
        is_whole: Vec::new(),
        work,
    };
    let groups = members.starts.windows(2).map(|ends| ends[0] as usize..ends[1] as usize);
    for group in groups.filter(|group| group.len() > 1) {
        linkage.tree.restart(group);
        linkage.is_whole.clear();
        linkage.enter(0, false);
        linkage.link_within(0);
    }
    let is_done = *linkage.work > 0;
    is_done.then(|| Partition::from_roots(&linkage.sets.roots()))
}

struct Linkage<'a> {
    points: Points<'a>,
    threshold: f64,
    tree: CellTree<'a>,
    /// Whether all nodes of a cell are known to be in one cluster.
    is_whole: Vec<bool>,
    sets: DisjointSets,
    /// How many components may still be looked at.
    work: &'a mut usize,
}

impl Linkage<'_> {
    /// Links all pairs in a cell.
    fn link_within(&mut self, cell: usize) {
        if self.is_whole[cell] || *self.work == 0 {
            return;
        }
        if self.tree.size(cell) <= LEAF {
            return self.link_pairs_within(cell);
        }
        let (left, right) = self.halves(cell);
        self.link_within(left);
        self.link_within(right);
        let gap = self.gap(left, right);
        self.link_between(left, right, gap);
    }

    /// Links all pairs of two cells that are linked within already and `gap` apart.
    fn link_between(&mut self, a: usize, b: usize, gap: f64) {
        if gap > self.threshold || *self.work == 0 {
            return;
        }
        let clusters = [self.cluster_of(a), self.cluster_of(b)];
        if let [Some(one), Some(other)] = clusters
            && (one == other || self.link(self.first(a), self.first(b)))
        {
            return;
        }
        let (small, large) = if self.tree.size(a) < self.tree.size(b) { (a, b) } else { (b, a) };
        if self.tree.size(large) <= LEAF {
            return self.link_pairs_between([a, b], clusters);
        }
        let (left, right) = self.halves(large);
        let (to_left, to_right) = (self.gap(small, left), self.gap(small, right));
        // The nearer first: a link found there often settles the other.
        if to_left <= to_right {
            self.link_between(small, left, to_left);
            self.link_between(small, right, to_right);
        } else {
            self.link_between(small, right, to_right);
            self.link_between(small, left, to_left);
        }
    }

    fn link_pairs_within(&mut self, cell: usize) {
        let nodes = self.tree.nodes(cell).to_vec();
        for (place, &i) in nodes.iter().enumerate() {
            for &j in &nodes[place + 1..] {
                self.link(i, j);
            }
        }
    }

    /// Links all pairs of two cells with the clusters that they are part of, if it is one each.
    fn link_pairs_between(&mut self, [a, b]: [usize; 2], clusters: [Option<u32>; 2]) {
        let of_a = self.nodes_near(a, b, clusters[1]);
        if of_a.is_empty() {
            return;
        }
        let of_b = self.nodes_near(b, a, clusters[0]);
        let one_is_enough = clusters.iter().all(Option::is_some);
        for &i in &of_a {
            for &j in &of_b {
                if self.link(i, j) && one_is_enough {
                    return;
                }
            }
        }
    }

    /// The nodes of a cell that may be near some of another and are not in this cluster already.
    fn nodes_near(&mut self, cell: usize, other: usize, cluster: Option<u32>) -> Vec<u32> {
        let Self { points, threshold, tree, sets, .. } = self;
        let mut near = tree.nodes(cell).to_vec();
        near.retain(|&node| cluster.is_none_or(|cluster| sets.root(node) != cluster));
        *self.work = self.work.saturating_sub(near.len() * points.metric.width());
        let bounds = tree.bounds(other);
        near.retain(|&node| {
            let row = points.row(node as usize);
            let point = Bounds { low: row, high: row };
            points.metric.gap_up_to(*threshold, point, bounds) <= *threshold
        });
        near
    }

    /// Links two nodes if they are near.
    fn link(&mut self, i: u32, j: u32) -> bool {
        let metric = self.points.metric;
        *self.work = self.work.saturating_sub(metric.width());
        let (a, b) = (self.points.row(i as usize), self.points.row(j as usize));
        let is_near = metric.distance_up_to(self.threshold, a, b) <= self.threshold;
        if is_near {
            self.sets.join(i, j);
        }
        is_near
    }

    /// The cluster of a cell whose nodes are all known to be in one.
    fn cluster_of(&mut self, cell: usize) -> Option<u32> {
        let cluster = self.sets.root(self.first(cell));
        if !self.is_whole[cell] {
            self.is_whole[cell] = match self.tree.children(cell) {
                Some(left) => {
                    let are_whole = self.is_whole[left] && self.is_whole[left + 1];
                    are_whole && self.sets.root(self.first(left + 1)) == cluster
                }
                None => {
                    let sets = &mut self.sets;
                    self.tree.nodes(cell).iter().all(|&node| sets.root(node) == cluster)
                }
            };
        }
        self.is_whole[cell].then_some(cluster)
    }

    fn first(&self, cell: usize) -> u32 {
        self.tree.nodes(cell)[0]
    }

    /// The halves of a cell, split at the first call.
    fn halves(&mut self, cell: usize) -> (usize, usize) {
        let left = self.tree.children(cell).unwrap_or_else(|| {
            let left = self.tree.split(cell);
            self.enter(left, self.is_whole[cell]);
            self.enter(left + 1, self.is_whole[cell]);
            left
        });
        (left, left + 1)
    }

    /// Links all nodes of a new cell if it is no wider than the threshold.
    fn enter(&mut self, cell: usize, is_whole: bool) {
        let Self { points, threshold, tree, sets, .. } = self;
        *self.work = self.work.saturating_sub(tree.size(cell) * points.metric.width());
        let diameter = points.metric.diameter_up_to(*threshold, tree.bounds(cell));
        let is_narrow = diameter <= *threshold;
        if is_narrow && !is_whole {
            let nodes = tree.nodes(cell);
            nodes[1..].iter().for_each(|&node| sets.join(nodes[0], node));
        }
        self.is_whole.push(is_whole || is_narrow);
    }

    fn gap(&mut self, a: usize, b: usize) -> f64 {
        let metric = self.points.metric;
        *self.work = self.work.saturating_sub(metric.width());
        metric.gap_up_to(self.threshold, self.tree.bounds(a), self.tree.bounds(b))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::metric::{Block, Metric};

    /// Blocks of these widths and factors.
    fn metric(blocks: &[(usize, f64)]) -> Metric {
        let mut end = 0;
        let block = |&(width, factor): &(usize, f64)| {
            end += width;
            Block { columns: end - width..end, factor }
        };
        Metric { blocks: blocks.iter().map(block).collect() }
    }

    fn clusters(points: Points, threshold: f64, groups: &Partition) -> Partition {
        clusters_within_groups(points, threshold, groups, &mut { usize::MAX }).unwrap()
    }

    fn all_pairs(points: Points, threshold: f64, groups: &Partition) -> Partition {
        let group = groups.cluster_of();
        let distance = |i: usize, j: usize| match group[i] == group[j] {
            true => points.metric.distance_up_to(f64::INFINITY, points.row(i), points.row(j)),
            false => f64::INFINITY,
        };
        Partition::single_linkage(groups.n_nodes(), distance, threshold)
    }

    fn blocks() -> impl Strategy<Value = Metric> {
        prop::collection::vec((1usize..4, 0.01..2.0), 1..5).prop_map(|blocks| metric(&blocks))
    }

    /// Points of no structure, on a lattice (where distances tie), or in a few clumps.
    fn component(kind: u8, (place, clump): (f64, u8)) -> f64 {
        match kind {
            0 => place,
            1 => (10.0 * place).round() / 10.0,
            _ => f64::from(clump) + 0.01 * place,
        }
    }

    proptest! {
        #[test]
        fn the_tree_links_as_all_pairs_do(
            n_nodes in 1usize..200,
            metric in blocks(),
            kind in 0u8..3,
            places in prop::collection::vec((-1.0..1.0, 0u8..3), 400),
            groups in prop::collection::vec(0usize..3, 200),
            threshold in prop::sample::select(vec![0.0, 0.001, 0.01, 0.1, 0.2, 0.5, 1.0, 3.0]),
        ) {
            let components = places.into_iter().cycle().map(|place| component(kind, place));
            let rows: Vec<f64> = components.take(n_nodes * metric.width()).collect();
            let points = Points { rows: &rows, metric: &metric };
            let groups = Partition::from_marks(&groups[..n_nodes]);
            for groups in [Partition::one_cluster(n_nodes), groups] {
                let expected = all_pairs(points, threshold, &groups);
                prop_assert_eq!(clusters(points, threshold, &groups), expected);
            }
        }

        #[test]
        fn boxes_promise_no_more_than_rounded_distances_keep(
            metric in blocks(),
            places in prop::collection::vec(-1.0..1.0, 6 * 12),
            threshold in 0.0..3.0,
        ) {
            let width = metric.width();
            let rows: Vec<&[f64]> = places.chunks(width).take(6).collect();
            let bounds = |rows: &[&[f64]]| -> (Vec<f64>, Vec<f64>) {
                let of = |pick: fn(f64, f64) -> f64, c: usize| rows.iter().map(|r| r[c]).reduce(pick);
                (0..width).map(|c| (of(f64::min, c).unwrap(), of(f64::max, c).unwrap())).unzip()
            };
            let ((low_a, high_a), (low_b, high_b)) = (bounds(&rows[..3]), bounds(&rows[3..]));
            let a = Bounds { low: &low_a, high: &high_a };
            let b = Bounds { low: &low_b, high: &high_b };
            let gap = metric.gap_up_to(f64::INFINITY, a, b);
            let diameter = metric.diameter_up_to(f64::INFINITY, a);
            for x in &rows[..3] {
                for y in &rows[3..] {
                    prop_assert!(gap <= metric.distance_up_to(f64::INFINITY, x, y));
                }
                for y in &rows[..3] {
                    prop_assert!(metric.distance_up_to(f64::INFINITY, x, y) <= diameter);
                }
            }
            prop_assert_eq!(gap <= threshold, metric.gap_up_to(threshold, a, b) <= threshold);
        }
    }

    /// How many components are looked at for nodes at these places in the plane.
    fn work(n_nodes: usize, place: impl Fn(usize) -> [f64; 2], threshold: f64) -> usize {
        let rows: Vec<f64> = (0..n_nodes).flat_map(place).collect();
        let mut left = usize::MAX;
        let metric = metric(&[(1, 1.0), (1, 1.0)]);
        let points = Points { rows: &rows, metric: &metric };
        let groups = Partition::one_cluster(n_nodes);
        clusters_within_groups(points, threshold, &groups, &mut left).unwrap();
        usize::MAX - left
    }

    /// Numbers in [0, 1) without a pattern that the tree could meet.
    fn scattered(i: usize, multiplier: f64) -> f64 {
        (i as f64 * multiplier).fract()
    }

    #[test]
    fn sixteen_times_the_nodes_are_at_most_thirty_times_the_work() {
        // N log N grows by a factor of 16 · (log 64,000 / log 4,000) < 22.
        let (golden, silver) = (0.618_033_988_749_895, 0.414_213_562_373_095);
        let plane = |i: usize| [scattered(i, golden), scattered(i, silver)];
        let clumps = |i: usize| plane(i).map(|x| f64::from((i % 8) as u32) + 0.01 * x);
        let growth = |small: usize, large: usize| large as f64 / small as f64;
        let (few, many) = (4_000, 64_000);
        for threshold in [0.0, 0.001, 0.01, 0.1, 3.0] {
            let grown = growth(work(few, clumps, threshold), work(many, clumps, threshold));
            assert!(grown < 30.0, "clumps at {threshold}: {grown}");
        }
        for reach in [0.1, 1.0, 3.0, 10.0] {
            let threshold = |n: usize| reach / (n as f64).sqrt();
            let grown =
                growth(work(few, plane, threshold(few)), work(many, plane, threshold(many)));
            assert!(grown < 30.0, "plane at {reach} steps: {grown}");
        }
    }

    #[test]
    fn too_much_work_has_no_answer() {
        let rows: Vec<f64> = (0..100).map(f64::from).collect();
        let metric = metric(&[(1, 1.0)]);
        let points = Points { rows: &rows, metric: &metric };
        let groups = Partition::one_cluster(100);
        assert_eq!(clusters_within_groups(points, 0.5, &groups, &mut 150), None);
        let mut work = 10_000;
        assert!(clusters_within_groups(points, 0.5, &groups, &mut work).is_some());
        assert!(0 < work && work < 9_900);
    }
}
