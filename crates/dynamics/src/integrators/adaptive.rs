//! Adaptive Dormand–Prince integration through `ode_solvers`: the independent check of the lanes.
//!
//! The run goes from sample to sample, each a fresh solve from the last state, so that memory stays
//! constant and sampling times are exact.
//!
//! Source: E. Hairer, S. P. Nørsett & G. Wanner, Solving Ordinary Differential Equations I (1993).

use ode_solvers::dop_shared::{IntegrationError, OutputType};
use ode_solvers::{DVector, Dop853, Dopri5, System};

use crate::kicks::Kicks;
use crate::network::{NetworkFlow, Outcome, Replica, Simulation, bounded, initial_lanes};
use crate::observables::ErrorSums;
use crate::{DynamicsError, Lanes, Oscillator, Progress};

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
    flow: &NetworkFlow<'_, O, D>,
    simulation: &Simulation<'_>,
    method: Adaptive,
    replica: Replica,
    progress: Progress<'_>,
) -> Result<Outcome, DynamicsError> {
    let (schedule, n_nodes) = (&simulation.schedule, flow.n_nodes());
    let system = Flat { flow, epsilon: replica.epsilon };
    let start = initial_lanes::<O, D, 1>(n_nodes, [replica.seed]);
    let mut y = DVector::from_iterator(D * n_nodes, start.iter().flatten().map(|x| x.0[0]));
    let mut kicks = Kicks::new(simulation.kick, schedule.sampling_interval(), [replica]);
    let mut sums =
        ErrorSums::<1>::new(&simulation.observables, n_nodes, schedule.samples_per_block());
    for sample in 1..=schedule.transient_samples() + schedule.samples() {
        let solved = method.advance(&system, &mut y, schedule.sampling_interval());
        let state: [Vec<Lanes<1>>; D] = std::array::from_fn(|c| {
            y.rows(c * n_nodes, n_nodes).iter().map(|&x| Lanes([x])).collect()
        });
        let state: [&[_]; D] = std::array::from_fn(|c| &state[c][..]);
        let time = schedule.time_of(sample);
        if bounded(state) == [false] {
            return Ok(Outcome::Escaped { time });
        }
        solved.map_err(|reason| DynamicsError::Adaptive { time, reason: reason.to_string() })?;
        if sample > schedule.transient_samples() {
            sums.sample(state);
        }
        if kicks.due(sample) {
            for y in y.iter_mut() {
                let mut kicked = Lanes([*y]);
                kicks.apply(&mut kicked);
                [*y] = kicked.0;
            }
        }
        progress(u64::from(schedule.stride));
    }
    Ok(Outcome::Completed(sums.errors(0)))
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
struct Flat<'a, O, const D: usize> {
    flow: &'a NetworkFlow<'a, O, D>,
    epsilon: f64,
}

impl<O, const D: usize> Clone for Flat<'_, O, D> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<O, const D: usize> Copy for Flat<'_, O, D> {}

impl<O: Oscillator<D>, const D: usize> System<f64, DVector<f64>> for Flat<'_, O, D> {
    fn system(&self, _time: f64, y: &DVector<f64>, slope: &mut DVector<f64>) {
        let n_nodes = self.flow.n_nodes();
        let state = std::array::from_fn(|c| &y.as_slice()[c * n_nodes..(c + 1) * n_nodes]);
        for node in 0..n_nodes {
            for (c, value) in self.flow.at(node, state, self.epsilon).into_iter().enumerate() {
                slope[c * n_nodes + node] = value;
            }
        }
    }
}
