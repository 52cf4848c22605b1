//! F, DF and B Dh at many states at once, as matrices: columns are what the equations make of the tangents
//! along the axes. A clock is not perturbed, and has neither row nor column.

use crate::{Coupling, InstructionSet, Linearised, LinearisedMut, NodeDynamics};

/// Matrices at some states, one after the other, each row by row.
pub(crate) struct Jacobians {
    /// Components that are perturbed: the size of a matrix.
    pub n_free: usize,
    /// F, component by component, of one state after the other.
    pub flow: Vec<f64>,
    /// DF.
    pub matrices: Vec<f64>,
}

impl Jacobians {
    /// Those of F at states, component by component, one state after the other.
    pub fn of_flow(dynamics: &dyn NodeDynamics, states: &[f64]) -> Self {
        let (n, n_free) = (dynamics.start().len(), dynamics.n_free());
        let apply = |at: Linearised<'_>, to: LinearisedMut<'_, '_>| {
            dynamics.tangent_flow(InstructionSet::Baseline, at, to);
        };
        let [values, tangents] = along_axes((states, n, n_free), n, apply);
        let n_states = states.len() / n;
        let flow = (0..n_states).flat_map(|k| values.iter().map(move |row| row[k * n_free]));
        let entry = |k: usize, row: usize, column: usize| tangents[row][k * n_free + column];
        Self { n_free, flow: flow.collect(), matrices: by_state((n_states, n_free), entry) }
    }

    /// B Dh at the same states, one after the other, each row by row.
    pub fn of_coupling(
        dynamics: &dyn NodeDynamics,
        coupling: &Coupling,
        states: &[f64],
    ) -> Vec<f64> {
        let (n, n_free) = (dynamics.start().len(), dynamics.n_free());
        let apply = |at: Linearised<'_>, to: LinearisedMut<'_, '_>| {
            coupling.send(InstructionSet::Baseline, at, to);
        };
        let [_, sent] = along_axes((states, n, n_free), coupling.n_channels(), apply);
        by_state((states.len() / n, n_free), |k, row, column| {
            let gains = coupling.gains().iter().filter(|gain| gain.equation == row);
            gains.map(|gain| gain.weight * sent[gain.channel][k * n_free + column]).sum()
        })
    }

    /// The matrix of one state.
    pub fn matrix(&self, state: usize) -> &[f64] {
        let size = self.n_free * self.n_free;
        &self.matrices[state * size..][..size]
    }
}

/// Values and tangents, `[row][state and axis]`, of a function at states with the tangents along the axes.
fn along_axes(
    (states, n, n_free): (&[f64], usize, usize),
    n_rows: usize,
    apply: impl FnOnce(Linearised<'_>, LinearisedMut<'_, '_>),
) -> [Vec<Vec<f64>>; 2] {
    let n_numbers = states.len() / n * n_free;
    let numbers = |of: &dyn Fn(usize, usize) -> f64, c: usize| -> Vec<f64> {
        (0..n_numbers).map(|number| of(c, number)).collect()
    };
    let value = |c: usize, number: usize| states[number / n_free * n + c];
    let axis = |c: usize, number: usize| f64::from(u8::from(number % n_free == c));
    let [values, axes] = [&value as &dyn Fn(usize, usize) -> f64, &axis]
        .map(|of| (0..n).map(|c| numbers(of, c)).collect::<Vec<_>>());
    let mut to = [vec![vec![0.0; n_numbers]; n_rows], vec![vec![0.0; n_numbers]; n_rows]];
    {
        let [value, tangent] =
            [&values, &axes].map(|rows| rows.iter().map(Vec::as_slice).collect());
        let (value, tangent): (Vec<&[f64]>, Vec<&[f64]>) = (value, tangent);
        let [to_value, to_tangent] = &mut to;
        let mut to_value: Vec<&mut [f64]> = to_value.iter_mut().map(Vec::as_mut_slice).collect();
        let mut to_tangent: Vec<&mut [f64]> =
            to_tangent.iter_mut().map(Vec::as_mut_slice).collect();
        apply(
            Linearised { value: &value, tangent: &tangent },
            LinearisedMut { value: &mut to_value, tangent: &mut to_tangent },
        );
    }
    to
}

fn by_state((n_states, n): (usize, usize), entry: impl Fn(usize, usize, usize) -> f64) -> Vec<f64> {
    let places =
        (0..n_states).flat_map(|k| (0..n).flat_map(move |row| (0..n).map(move |c| (k, row, c))));
    places.map(|(k, row, column)| entry(k, row, column)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lorenz, Model};

    #[test]
    fn the_matrices_of_lorenz_stand_row_by_row_state_by_state() {
        let model = Model::Lorenz(Lorenz { alpha: 10.0, r: 28.0, b: 2.0 });
        let states = [1.0, 2.0, 3.0, -4.0, 5.0, 6.0];
        let of_flow = Jacobians::of_flow(&model, &states);
        assert_eq!(of_flow.flow, [10.0, 23.0, -4.0, 90.0, -93.0, -32.0]);
        assert_eq!(of_flow.matrix(0), [-10.0, 10.0, 0.0, 25.0, -1.0, -1.0, 2.0, 1.0, -2.0]);
        assert_eq!(of_flow.matrix(1), [-10.0, 10.0, 0.0, 22.0, -1.0, 4.0, 5.0, -4.0, -2.0]);
        let coupling = Coupling::matrix(&[vec![0.0; 3], vec![2.0, 0.0, 0.5], vec![0.0; 3]]);
        let of_coupling = Jacobians::of_coupling(&model, &coupling, &states);
        assert_eq!(of_coupling[..9], [0.0, 0.0, 0.0, 2.0, 0.0, 0.5, 0.0, 0.0, 0.0]);
        assert_eq!(of_coupling[9..], of_coupling[..9]);
    }
}
