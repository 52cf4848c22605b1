//! The coarsest equitable refinement of a partition: its clusters cut into as few cells as possible
//! such that all nodes of a cell have the same total weight to every cell.
//!
//! Cut where the sums to a splitter C differ, s_i = Σ_{j∈C} w_ij, until none do. Once the sums to a
//! cell agree, those to all but one of its parts say what that to the last one is, so that the largest
//! part need not be a splitter: every link is looked at O(log N) times (Hopcroft's rule), which makes
//! O((N + M) log N) of it but for sorting. Splitters are taken in any order: the coarsest refinement is
//! one.
//!
//! **Rounding.** Sums to a cell are equal when they differ by no more than a tolerance times the
//! larger Σ_{j∈C} |w_ij|: each sum is held against what it was made of, not against the strength of
//! its node, so that a weak link beside a strong one counts. Sorted, they are cut at gaps beyond
//! that, and chains of small gaps at their wider ones until none spans more. What was known only as
//! the rest of a larger sum has the error of that: in the end every sum of every cell is taken afresh,
//! and where some differ all cells become splitters once more.
//!
//! The own cell is the one exception: where rows sum to zero, as those of W do, the weight to it is
//! minus that to all others, and is not asked for in the last check; the sums of whole rows stand for
//! it in general.
//!
//! Sources: Hopcroft, in: Theory of Machines and Computations, 189 (1971); Cardon & Crochemore, Theor.
//! Comput. Sci. 19, 85 (1982), and Paige & Tarjan, SIAM J. Comput. 16, 973 (1987), for graphs; Valmari
//! & Franceschinis, Proc. TACAS, LNCS 6015, 38 (2010), for weights.

use sprs::CsMatViewI;

use crate::cell_list::CellList;
use crate::equitability::check_weights;
use crate::modes::check_threshold;
use crate::{ClusteringError, Partition};

/// A sum of weights, and that of their moduli.
type Sum = (f64, f64);

/// Refines partitions of the nodes of one matrix, each from what is known of the last.
pub struct Refiner {
    /// Row i holds what node i receives from others.
    rows: Links,
    /// Row j holds what node j sends.
    columns: Links,
    /// Σ_j w_ij.
    row_sums: Vec<Sum>,
    tolerance: f64,
    cells: CellList,
    /// The partition whose refinement the cells are.
    of: Option<Partition>,
    /// s_i for the splitter at hand; zero at all other times, as is the next.
    sums: Vec<Sum>,
    is_reached: Vec<bool>,
}

impl Refiner {
    /// For a matrix of which w_ij is what node i receives from node j, and sums that are equal up to
    /// `tolerance` of what they are made of. 1e-9 tells rounding from structure.
    ///
    /// # Errors
    /// [`ClusteringError::BadThreshold`] for a tolerance that is negative or not finite, and
    /// [`ClusteringError::WeightNotFinite`].
    ///
    /// # Panics
    /// If the matrix is not square, or has 2³² nodes or more.
    pub fn new(
        matrix: CsMatViewI<'_, f64, u32, usize>,
        tolerance: f64,
    ) -> Result<Self, ClusteringError> {
        check_threshold(tolerance)?;
        let n = matrix.rows();
        assert!(matrix.cols() == n, "a matrix of shape {:?}", matrix.shape());
        check_weights(matrix)?;
        let rows = Links::of(matrix);
        let row_sum = |i| rows.of_node(i).fold((0.0, 0.0), |sum, (_, w)| plus(sum, w));
        Ok(Self {
            row_sums: (0..n).map(row_sum).collect(),
            rows,
            columns: Links::of(matrix.transpose_view()),
            tolerance,
            cells: CellList::new(&Partition::one_cluster(n)),
            of: None,
            sums: vec![(0.0, 0.0); n],
            is_reached: vec![false; n],
        })
    }

    /// The coarsest equitable refinement of a partition.
    ///
    /// Where it refines the partition before, only what that changes is computed: O(N) for what is
    /// left as it is.
    ///
    /// # Panics
    /// If it is of other nodes.
    pub fn coarsest(&mut self, partition: &Partition) -> Partition {
        let (n, n_divided) = (self.row_sums.len(), partition.n_nodes());
        assert_eq!(n, n_divided, "weights of {n} nodes, a partition of {n_divided}");
        if self.of.as_ref().is_some_and(|of| partition.is_refinement_of(of)) {
            self.cells.cut_by(partition);
        } else {
            self.cells = CellList::new(partition);
            let tolerance = self.tolerance;
            let whole: Vec<u32> = (0..n as u32).collect();
            self.cells.cut_by_sums(&whole, &self.row_sums, tolerance);
            self.cells.await_all();
        }
        self.of = Some(partition.clone());
        self.use_splitters();
        while !self.is_equitable() {
            let n_cells = self.cells.n_cells();
            self.cells.await_all();
            self.use_splitters();
            // Sums in another order round otherwise.
            if self.cells.n_cells() == n_cells {
                break;
            }
        }
        self.cells.partition()
    }

    /// Cuts cells by their sums to those that wait to be splitters, until none waits.
    fn use_splitters(&mut self) {
        let mut nodes = Vec::new();
        let mut reached = Vec::new();
        while self.cells.take_splitter(&mut nodes) {
            for &j in &nodes {
                for (i, weight) in self.columns.of_node(j as usize) {
                    if self.cells.is_single(i) {
                        continue;
                    }
                    if !std::mem::replace(&mut self.is_reached[i], true) {
                        reached.push(i as u32);
                    }
                    self.sums[i] = plus(self.sums[i], weight);
                }
            }
            self.cells.cut_by_sums(&reached, &self.sums, self.tolerance);
            for i in reached.drain(..) {
                self.is_reached[i as usize] = false;
                self.sums[i as usize] = (0.0, 0.0);
            }
        }
    }

    /// Whether nodes of a cell have the same total weight to every other cell, each sum taken afresh.
    fn is_equitable(&mut self) -> bool {
        let mut totals = Totals::new(self.cells.n_cells());
        let cells = &self.cells;
        (0..cells.n_cells()).filter(|&cell| cells.nodes(cell).len() > 1).all(|cell| {
            for &node in cells.nodes(cell) {
                let to_others = self.rows.of_node(node as usize);
                let to_others = to_others.map(|(j, weight)| (cells.cell_of(j), weight));
                totals.add(to_others.filter(|&(other, _)| other != cell));
            }
            totals.are_equal(cells.nodes(cell).len(), self.tolerance)
        })
    }
}

/// The coarsest equitable refinement of one partition; see [`Refiner`].
///
/// # Errors
/// Those of [`Refiner::new`].
///
/// # Panics
/// If the matrix is not of the nodes of the partition.
pub fn equitable_refinement(
    matrix: CsMatViewI<'_, f64, u32, usize>,
    partition: &Partition,
    tolerance: f64,
) -> Result<Partition, ClusteringError> {
    Ok(Refiner::new(matrix, tolerance)?.coarsest(partition))
}

fn plus(sum: Sum, weight: f64) -> Sum {
    (sum.0 + weight, sum.1 + weight.abs())
}

/// The entries of a matrix, row by row.
struct Links {
    starts: Vec<usize>,
    ends: Vec<u32>,
    weights: Vec<f64>,
}

impl Links {
    fn of(matrix: CsMatViewI<'_, f64, u32, usize>) -> Self {
        let by_rows = (!matrix.is_csr()).then(|| matrix.to_csr());
        let matrix = by_rows.as_ref().map_or(matrix, |by_rows| by_rows.view());
        let mut starts = vec![0];
        let (mut ends, mut weights) = (Vec::new(), Vec::new());
        for row in matrix.outer_iterator() {
            ends.extend_from_slice(row.indices());
            weights.extend_from_slice(row.data());
            starts.push(ends.len());
        }
        Self { starts, ends, weights }
    }

    fn of_node(&self, node: usize) -> impl Iterator<Item = (usize, f64)> {
        let places = self.starts[node]..self.starts[node + 1];
        let ends = self.ends[places.clone()].iter().map(|&j| j as usize);
        ends.zip(self.weights[places].iter().copied())
    }
}

/// Total weights of the nodes of one cell to other cells.
struct Totals {
    /// Of the node at hand to each cell.
    sum: Vec<Sum>,
    /// The least and the largest total of the nodes so far that have a link, and the largest of what
    /// they are made of.
    range: Vec<(f64, f64, f64)>,
    /// How many nodes have a link.
    n_linked: Vec<usize>,
    /// The cells to which some node has a link.
    linked: Vec<usize>,
    /// Those to which the node at hand has one.
    reached: Vec<usize>,
}

impl Totals {
    fn new(n_cells: usize) -> Self {
        Self {
            sum: vec![(0.0, 0.0); n_cells],
            range: vec![(0.0, 0.0, 0.0); n_cells],
            n_linked: vec![0; n_cells],
            linked: Vec::new(),
            reached: Vec::new(),
        }
    }

    /// Adds one node, with the cell of each of its neighbours and the weight of the link.
    fn add(&mut self, neighbours: impl Iterator<Item = (usize, f64)>) {
        for (cell, weight) in neighbours {
            if self.sum[cell].1 == 0.0 && weight != 0.0 {
                self.reached.push(cell);
            }
            self.sum[cell] = plus(self.sum[cell], weight);
        }
        while let Some(cell) = self.reached.pop() {
            let (sum, size) = std::mem::take(&mut self.sum[cell]);
            if self.n_linked[cell] == 0 {
                self.linked.push(cell);
                self.range[cell] = (sum, sum, size);
            }
            let (low, high, largest) = self.range[cell];
            self.range[cell] = (low.min(sum), high.max(sum), largest.max(size));
            self.n_linked[cell] += 1;
        }
    }

    /// Whether these so many nodes have equal totals to every cell; forgets them.
    fn are_equal(&mut self, n_nodes: usize, tolerance: f64) -> bool {
        let mut are_equal = true;
        for cell in std::mem::take(&mut self.linked) {
            let (low, high, largest) = self.range[cell];
            // A node without a link has the total 0.
            let has_zero = std::mem::take(&mut self.n_linked[cell]) < n_nodes;
            let (low, high) = if has_zero { (low.min(0.0), high.max(0.0)) } else { (low, high) };
            are_equal &= high - low <= tolerance * largest;
        }
        are_equal
    }
}
