//! The assignment problem: one column for each row so that the sum of weights is largest.
//!
//! Shortest augmenting paths with potentials u_i + v_j ≤ cost_ij (Jonker & Volgenant, Computing 38,
//! 325 (1987)), cost = −weight.

/// Weights, shape (rows, columns), row by row, no more rows than columns.
pub(crate) struct Weights {
    pub(crate) n_rows: usize,
    pub(crate) n_columns: usize,
    pub(crate) values: Vec<i64>,
}

/// The column of each row in an assignment of the largest total weight. O(rows² · columns).
pub(crate) fn maximum_assignment(weights: &Weights) -> Vec<usize> {
    assert!(
        weights.n_rows <= weights.n_columns
            && weights.values.len() == weights.n_rows * weights.n_columns,
        "{} weights for {} rows and {} columns",
        weights.values.len(),
        weights.n_rows,
        weights.n_columns
    );
    let mut solver = Solver {
        weights,
        row_potential: vec![0; weights.n_rows],
        column_potential: vec![0; weights.n_columns],
        row_of: vec![None; weights.n_columns],
    };
    for row in 0..weights.n_rows {
        solver.assign(row);
    }
    let mut column_of = vec![0; weights.n_rows];
    for (column, row) in solver.row_of.iter().enumerate() {
        if let Some(row) = *row {
            column_of[row] = column;
        }
    }
    column_of
}

struct Solver<'a> {
    weights: &'a Weights,
    row_potential: Vec<i64>,
    column_potential: Vec<i64>,
    row_of: Vec<Option<usize>>,
}

impl Solver<'_> {
    /// Assigns one more row along the shortest path of reduced costs to a free column.
    fn assign(&mut self, start: usize) {
        let n_columns = self.weights.n_columns;
        let mut distance = vec![i64::MAX; n_columns];
        let mut reached_from = vec![None; n_columns];
        let mut visited: Vec<usize> = Vec::new();
        let mut is_visited = vec![false; n_columns];
        let (mut row, mut row_distance, mut via) = (start, 0, None);
        let free = loop {
            for column in (0..n_columns).filter(|&c| !is_visited[c]) {
                let through = row_distance + self.reduced_cost(row, column);
                if through < distance[column] {
                    distance[column] = through;
                    reached_from[column] = via;
                }
            }
            let nearest = (0..n_columns)
                .filter(|&c| !is_visited[c])
                .min_by_key(|&c| distance[c])
                .expect("there are no more rows than columns");
            let Some(next) = self.row_of[nearest] else { break nearest };
            is_visited[nearest] = true;
            visited.push(nearest);
            (row, row_distance, via) = (next, distance[nearest], Some(nearest));
        };
        self.shift_potentials(start, &visited, &distance, distance[free]);
        self.flip(start, free, &reached_from);
    }

    fn reduced_cost(&self, row: usize, column: usize) -> i64 {
        let cost = -self.weights.values[row * self.weights.n_columns + column];
        cost - self.row_potential[row] - self.column_potential[column]
    }

    /// Keeps reduced costs non-negative, and zero along the path.
    fn shift_potentials(&mut self, start: usize, visited: &[usize], distance: &[i64], total: i64) {
        self.row_potential[start] += total;
        for &column in visited {
            let row = self.row_of[column].expect("visited columns are taken");
            self.row_potential[row] += total - distance[column];
            self.column_potential[column] -= total - distance[column];
        }
    }

    /// Hands every column of the path to the row it was reached from.
    fn flip(&mut self, start: usize, free: usize, reached_from: &[Option<usize>]) {
        let mut column = free;
        while let Some(previous) = reached_from[column] {
            self.row_of[column] = self.row_of[previous];
            column = previous;
        }
        self.row_of[column] = Some(start);
    }
}
