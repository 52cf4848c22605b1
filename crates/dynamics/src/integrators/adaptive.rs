//! Adaptive Dormand–Prince integration through `ode_solvers`: the independent check of the lanes.
//!
//! The run goes from sample to sample, each a fresh solve from the last state, so that memory stays
//! constant and sampling times are exact.
//!
//! Source: E. Hairer, S. P. Nørsett & G. Wanner, Solving Ordinary Differential Equations I (1993).

use ode_solvers::dop_shared::{IntegrationError, OutputType};
use ode_solvers::{DVector, Dop853, Dopri5, System};

use crate::kernel::WIDTH;
use crate::kicks::Kicks;
use crate::observables::ErrorSums;
use crate::random::initial_states;
use crate::{
    Coupling, DynamicsError, ESCAPE_RADIUS, Oscillator, Outcome, Progress, Replica, Simulation,
    SparseMatrix,
};

/// Order of the adaptive method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AdaptiveOrder {
    /// Dormand–Prince 5(4).
    Five,
    /// Dormand–Prince 8(5,3).
    Eight,
}

/// An adaptive method with its tolerances on the local error of each component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// Which of the two.
    pub order: AdaptiveOrder,
    /// Relative tolerance.
    pub relative_tolerance: f64,
    /// Absolute tolerance, in the units of the components.
    pub absolute_tolerance: f64,
}

/// Runs one replica to its end.
pub(crate) fn run<O: Oscillator<D>, const D: usize>(
    oscillator: O,
    simulation: &Simulation<'_>,
    method: Adaptive,
    replica: Replica,
    progress: Progress<'_>,
) -> Result<Outcome, DynamicsError> {
    let Simulation { schedule, observables, coupling, matrix, kick, .. } = simulation;
    let n_nodes = matrix.rows();
    let system = Flat::<O, D> { oscillator, coupling: *coupling, matrix, epsilon: replica.epsilon };
    let start = initial_states::<O, D>(n_nodes, replica.seed);
    let mut y = DVector::from_fn(D * n_nodes, |row, _| start[row % n_nodes][row / n_nodes]);
    let mut kicks = Kicks::new(*kick, schedule.sampling_interval(), [replica]);
    let mut sums = ErrorSums::<1>::new(observables, n_nodes, schedule.samples_per_block());
    for sample in 1..=schedule.transient_samples() + schedule.samples() {
        let solved = method.advance(&system, &mut y, schedule.sampling_interval());
        let time = schedule.time_of(sample);
        if !y.iter().all(|x| x.abs() < ESCAPE_RADIUS) {
            return Ok(Outcome::Escaped { time });
        }
        solved.map_err(|reason| DynamicsError::Adaptive { time, reason: reason.to_string() })?;
        if sample > schedule.transient_samples() {
            sums.sample(runs(&y.as_slice()[observables.component * n_nodes..][..n_nodes]).iter());
        }
        if kicks.due(sample) {
            y.iter_mut().for_each(|y| kicks.apply(std::array::from_mut(y)));
        }
        progress(u64::from(schedule.stride));
    }
    Ok(Outcome::Completed(sums.errors(0)))
}

/// Numbers cut into runs, the last filled up with zeros.
fn runs(numbers: &[f64]) -> Vec<[f64; WIDTH]> {
    let run = |numbers: &[f64]| {
        std::array::from_fn(|place| numbers.get(place).copied().unwrap_or_default())
    };
    numbers.chunks(WIDTH).map(run).collect()
}

impl Adaptive {
    /// Takes y forward by a time, or as far as the solver gets.
    fn advance<O: Oscillator<D>, const D: usize>(
        self,
        system: &Flat<'_, O, D>,
        y: &mut DVector<f64>,
        time: f64,
    ) -> Result<(), IntegrationError> {
        let (relative, absolute) = (self.relative_tolerance, self.absolute_tolerance);
        macro_rules! solve {
            ($method:ident) => {{
                let mut solver =
                    $method::new(*system, 0.0, time, time, y.clone(), relative, absolute);
                solver.set_output(OutputType::Sparse);
                let solved = solver.integrate();
                if let Some(last) = solver.y_out().last() {
                    y.copy_from(last);
                }
                solved.map(|_| ())
            }};
        }
        match self.order {
            AdaptiveOrder::Five => solve!(Dopri5),
            AdaptiveOrder::Eight => solve!(Dop853),
        }
    }
}

/// A network at one coupling as one flat system: all nodes of the first component, then the next.
#[derive(Clone, Copy)]
struct Flat<'a, O, const D: usize> {
    oscillator: O,
    coupling: Coupling,
    matrix: &'a SparseMatrix,
    epsilon: f64,
}

impl<O: Oscillator<D>, const D: usize> System<f64, DVector<f64>> for Flat<'_, O, D> {
    fn system(&self, _time: f64, y: &DVector<f64>, slope: &mut DVector<f64>) {
        let n_nodes = self.matrix.rows();
        let source = &y.as_slice()[self.coupling.from * n_nodes..][..n_nodes];
        for (node, row) in self.matrix.outer_iterator().enumerate() {
            let flow = self.oscillator.flow(std::array::from_fn(|c| y[c * n_nodes + node]));
            for (c, value) in flow.into_iter().enumerate() {
                slope[c * n_nodes + node] = value;
            }
            let input: f64 = row.iter().map(|(j, &w)| w * source[j]).sum();
            slope[self.coupling.to * n_nodes + node] += self.epsilon * input;
        }
    }
}
