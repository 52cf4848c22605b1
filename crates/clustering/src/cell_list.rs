//! Cells of nodes that are cut again and again, and which of them wait to be splitters.
//!
//! The nodes of a cell lie side by side in one list, and a cell is cut by moving those of its parts to
//! its end: what stays costs nothing (Paige & Tarjan 1987).

use std::ops::Range;

use crate::Partition;

pub(crate) struct CellList {
    /// All nodes, cell after cell.
    nodes: Vec<u32>,
    /// Where each node is among them.
    place_of: Vec<u32>,
    cell_of: Vec<u32>,
    /// Where the nodes of each cell lie.
    places: Vec<Range<u32>>,
    /// Cells that have not been splitters since they became what they are.
    waiting: Vec<u32>,
    is_waiting: Vec<bool>,
}

impl CellList {
    /// The clusters of a partition as cells, of which none waits.
    ///
    /// # Panics
    /// If there are 2³² nodes or more.
    pub(crate) fn new(partition: &Partition) -> Self {
        let members = partition.members();
        let mut place_of = vec![0; members.nodes.len()];
        (0..).zip(&members.nodes).for_each(|(place, &node)| place_of[node as usize] = place);
        Self {
            nodes: members.nodes,
            place_of,
            cell_of: partition.cluster_of().iter().map(|&cluster| cluster as u32).collect(),
            places: members.starts.windows(2).map(|ends| ends[0]..ends[1]).collect(),
            waiting: Vec::new(),
            is_waiting: vec![false; partition.n_clusters()],
        }
    }

    pub(crate) fn n_cells(&self) -> usize {
        self.places.len()
    }

    pub(crate) fn cell_of(&self, node: usize) -> usize {
        self.cell_of[node] as usize
    }

    /// The nodes of a cell, in no order.
    pub(crate) fn nodes(&self, cell: usize) -> &[u32] {
        let Range { start, end } = self.places[cell];
        &self.nodes[start as usize..end as usize]
    }

    /// Whether a node is a cell of its own.
    pub(crate) fn is_single(&self, node: usize) -> bool {
        self.places[self.cell_of(node)].len() == 1
    }

    /// All cells wait.
    pub(crate) fn await_all(&mut self) {
        (0..self.n_cells() as u32).for_each(|cell| self.await_one(cell));
    }

    fn await_one(&mut self, cell: u32) {
        if !std::mem::replace(&mut self.is_waiting[cell as usize], true) {
            self.waiting.push(cell);
        }
    }

    /// The nodes of a cell that waits, which it does no longer; false if there is none.
    pub(crate) fn take_splitter(&mut self, nodes: &mut Vec<u32>) -> bool {
        nodes.clear();
        let Some(cell) = self.waiting.pop() else { return false };
        self.is_waiting[cell as usize] = false;
        nodes.extend_from_slice(self.nodes(cell as usize));
        true
    }

    /// Cuts cells by the clusters of a partition.
    pub(crate) fn cut_by(&mut self, partition: &Partition) {
        for cell in 0..self.n_cells() {
            let cluster = |&node: &u32| partition.cluster_of()[node as usize];
            let first = cluster(&self.nodes(cell)[0]);
            if self.nodes(cell).iter().all(|node| cluster(node) == first) {
                continue;
            }
            let mut nodes = self.nodes(cell).to_vec();
            nodes.sort_unstable_by_key(cluster);
            let parts = nodes.chunk_by(|a, b| cluster(a) == cluster(b)).collect::<Vec<_>>();
            self.cut(cell, 0, &parts);
        }
    }

    /// Cuts cells where sums differ: those of the nodes given, no node twice, and zero for all others.
    /// They are equal if they differ by no more than `tolerance` of what they are made of.
    pub(crate) fn cut_by_sums(&mut self, given: &[u32], sums: &[(f64, f64)], tolerance: f64) {
        let sum = |&node: &u32| sums[node as usize];
        let mut nodes = given.to_vec();
        nodes.sort_unstable_by(|a, b| {
            let of = |node: &u32| self.cell_of[*node as usize];
            of(a).cmp(&of(b)).then(sum(a).0.total_cmp(&sum(b).0))
        });
        let cells: Vec<&[u32]> =
            nodes.chunk_by(|&a, &b| self.cell_of(a as usize) == self.cell_of(b as usize)).collect();
        for nodes in cells {
            let cell = self.cell_of(nodes[0] as usize);
            let n_others = self.places[cell].len() - nodes.len();
            let values: Vec<(f64, f64)> = nodes.iter().map(sum).collect();
            let mut parts = Vec::new();
            if n_others == 0 {
                cut_sorted(&values, nodes, tolerance, &mut parts);
                self.cut(cell, 0, &parts);
                continue;
            }
            // The others have sums of nothing: one of them stands for all, and what is equal to it
            // stays with them.
            let below = values.partition_point(|value| value.0 < 0.0);
            let with_zero = |mut all: Vec<_>, zero| {
                all.insert(below, zero);
                all
            };
            let values = with_zero(values, (0.0, 0.0));
            let mut marked: Vec<u32> = nodes.to_vec();
            marked.insert(below, u32::MAX);
            cut_sorted(&values, &marked, tolerance, &mut parts);
            parts.retain(|part| !part.contains(&u32::MAX));
            let n_moved: usize = parts.iter().map(|part| part.len()).sum();
            let n_staying = self.places[cell].len() - n_moved;
            self.cut(cell, n_staying, &parts);
        }
    }

    /// Cuts a cell into these parts and `n_staying` other nodes, if that is more than one; all but the
    /// largest become splitters, or all of them if the cell waits to be one.
    fn cut(&mut self, cell: usize, n_staying: usize, parts: &[&[u32]]) {
        let largest = (0..parts.len()).max_by_key(|&part| parts[part].len());
        let Some(largest) = largest else { return };
        // Without others the largest part stays where it is.
        let stays = (n_staying == 0).then_some(largest);
        if stays.is_some() && parts.len() == 1 {
            return;
        }
        let was_waiting = self.is_waiting[cell];
        let is_rest_largest = stays.is_some() || n_staying >= parts[largest].len();
        if !is_rest_largest {
            self.await_one(cell as u32);
        }
        for (number, part) in parts.iter().enumerate().filter(|&(number, _)| Some(number) != stays)
        {
            let new = self.n_cells() as u32;
            let end = self.places[cell].end;
            for &node in *part {
                self.places[cell].end -= 1;
                self.swap_places(self.place_of[node as usize], self.places[cell].end);
                self.cell_of[node as usize] = new;
            }
            self.places.push(self.places[cell].end..end);
            self.is_waiting.push(false);
            if was_waiting || is_rest_largest || number != largest {
                self.await_one(new);
            }
        }
    }

    fn swap_places(&mut self, a: u32, b: u32) {
        self.nodes.swap(a as usize, b as usize);
        for place in [a, b] {
            self.place_of[self.nodes[place as usize] as usize] = place;
        }
    }

    pub(crate) fn partition(&self) -> Partition {
        let mut roots = vec![0; self.nodes.len()];
        for cell in 0..self.n_cells() {
            let nodes = self.nodes(cell);
            nodes.iter().for_each(|&node| roots[node as usize] = nodes[0]);
        }
        Partition::from_roots(&roots)
    }
}

/// Cuts ascending sums, and the nodes that have them, at gaps beyond the tolerance; what still spans
/// more than that, a chain, at its widest gaps.
fn cut_sorted<'a>(
    values: &[(f64, f64)],
    nodes: &'a [u32],
    tolerance: f64,
    parts: &mut Vec<&'a [u32]>,
) {
    let size = values.iter().map(|value| value.1).fold(0.0, f64::max);
    let width = values[values.len() - 1].0 - values[0].0;
    let is_wide = width > tolerance * size;
    if !is_wide {
        parts.push(nodes);
        return;
    }
    let gap = |pair: &[(f64, f64)]| pair[1].0 - pair[0].0;
    let limit = |pair: &[(f64, f64)]| tolerance * pair[0].1.max(pair[1].1);
    let is_chain = values.windows(2).all(|pair| gap(pair) <= limit(pair));
    let widest = values.windows(2).map(gap).fold(0.0, f64::max);
    let is_cut = |pair: &[(f64, f64)]| {
        if is_chain { gap(pair) >= 0.5 * widest } else { gap(pair) > limit(pair) }
    };
    let mut start = 0;
    let ends = values.windows(2).enumerate().filter(|(_, pair)| is_cut(pair)).map(|(k, _)| k + 1);
    for end in ends.chain([values.len()]) {
        cut_sorted(&values[start..end], &nodes[start..end], tolerance, parts);
        start = end;
    }
}
