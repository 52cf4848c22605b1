//! Adaptive Dormand–Prince integration through `ode_solvers`: the independent check of the lanes.
//!
//! The run goes from sample to sample, each a fresh solve from the last state, so that memory stays
//! constant and sampling times are exact.
//!
//! Source: E. Hairer, S. P. Nørsett & G. Wanner, Solving Ordinary Differential Equations I (1993).

use ode_solvers::dop_shared::{IntegrationError, OutputType};
use ode_solvers::{DVector, Dop853, Dopri5, System};

use super::{Adaptive, AdaptiveOrder};
use crate::batches::Numbered;
use crate::coupling::Gain;
use crate::kicks::Kicks;
use crate::observables::ErrorSums;
use crate::random::initial_states;
use crate::recorder::Recorder;
use crate::tile::{slices, slices_mut};
use crate::{Next, Observer, Outcome, Simulation, Snapshot, Start};

/// Runs one replica to its end; none when the observer wanted to stop.
pub(crate) fn run(
    simulation: &Simulation<'_>,
    method: Adaptive,
    (number, start): Numbered,
    observer: &dyn Observer,
) -> Option<Outcome> {
    let Simulation { schedule, observables, matrix, .. } = simulation;
    let n_nodes = matrix.rows();
    let system = Flat { simulation, epsilon: start.replica.epsilon };
    let transient = schedule.transient_samples();
    let (done, end) = (start.sample(), transient + schedule.samples());
    let mut orbit = Orbit::begin(simulation, start);
    let (n_components, n_free) = (simulation.dynamics.start().len(), simulation.dynamics.n_free());
    let radius = simulation.dynamics.escape_radius();
    let mut recorder = Recorder::new(simulation.series.as_ref(), schedule, n_components);
    let mut record = |sample: u64, y: &DVector<f64>| {
        if recorder.due(sample) {
            let state = |component: usize, node: usize| y[component * n_nodes + node];
            recorder.tell((number, observer), (sample, schedule.time_of(sample)), state);
        }
    };
    if done == 0 {
        record(0, &orbit.y);
    }
    let ended = |outcome: Outcome| {
        observer.finished(number, &outcome);
        Some(outcome)
    };
    for sample in done + 1..=end {
        let Orbit { y, sums, kicks } = &mut orbit;
        let solved = method.advance(&system, y, schedule.sampling_interval());
        if !y.iter().take(n_free * n_nodes).all(|x| x.abs() < radius) {
            return ended(Outcome::Escaped { time: schedule.time_of(sample) });
        }
        if let Err(error) = solved {
            let (since, reason) = told(&error);
            let time = schedule.time_of(sample - 1) + since;
            return ended(Outcome::Failed { time, reason });
        }
        if sample > transient {
            let component = &y.as_slice()[observables.component * n_nodes..][..n_nodes];
            sums.sample(component.as_chunks().0.iter());
        }
        record(sample, y);
        if kicks.due(sample) {
            y.iter_mut().take(n_free * n_nodes).for_each(|y| kicks.apply(std::array::from_mut(y)));
        }
        match observer.advanced(&[number], u64::from(schedule.stride)) {
            Next::Snapshot if sample < end => {
                let sums = if sample > transient { sums.kept(0) } else { Vec::new() };
                let state = y.as_slice().to_vec();
                observer.snapshot(number, Snapshot { sample, state, sums });
            }
            Next::Stop if sample < end => return None,
            Next::GoOn | Next::Snapshot | Next::Stop => {}
        }
    }
    ended(Outcome::Completed(orbit.sums.errors(0)))
}

/// When the solver gave up, from where it began, and why.
fn told(error: &IntegrationError) -> (f64, String) {
    match *error {
        IntegrationError::MaxNumStepReached { x, n_step } => {
            (x, format!("{n_step} steps did not reach the next sample"))
        }
        IntegrationError::StepSizeUnderflow { x } => (x, "its step became too small".into()),
        IntegrationError::StiffnessDetected { x } => {
            (x, "the equations are too stiff for an explicit method".into())
        }
    }
}

/// All that changes while a replica runs.
struct Orbit {
    /// All nodes of the first component, then of the next.
    y: DVector<f64>,
    sums: ErrorSums<1>,
    kicks: Kicks<1>,
}

impl Orbit {
    /// The initial state of a replica, or that of its snapshot.
    fn begin(simulation: &Simulation<'_>, start: Start) -> Self {
        let Simulation { dynamics, schedule, observables, matrix, kick, .. } = simulation;
        let n_components = dynamics.start().len();
        let (n_nodes, replica) = (matrix.rows(), start.replica);
        let mut kicks = Kicks::new(*kick, schedule.sampling_interval(), [replica]);
        let mut sums = ErrorSums::<1>::new(observables, n_nodes, schedule.samples_per_block());
        let Some(Snapshot { sample, state, sums: kept }) = start.from else {
            let drawn = initial_states(dynamics.start(), n_nodes, replica.seed);
            let of = |row: usize| drawn[row % n_nodes * n_components + row / n_nodes];
            let y = DVector::from_fn(n_components * n_nodes, |row, _| of(row));
            return Self { y, sums, kicks };
        };
        if let Some(averaged) = sample.checked_sub(schedule.transient_samples() + 1) {
            sums.restore(0, &kept);
            sums.go_on_after(averaged + 1);
        }
        kicks.go_on_after(sample, dynamics.n_free() * n_nodes);
        Self { y: DVector::from_vec(state), sums, kicks }
    }
}

impl Adaptive {
    /// Takes y forward by a time, or as far as the solver gets.
    fn advance(
        self,
        system: &Flat<'_>,
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
struct Flat<'a> {
    simulation: &'a Simulation<'a>,
    epsilon: f64,
}

impl System<f64, DVector<f64>> for Flat<'_> {
    fn system(&self, _time: f64, y: &DVector<f64>, slope: &mut DVector<f64>) {
        let Simulation { dynamics, coupling, matrix, instruction_set, .. } = self.simulation;
        let n_nodes = matrix.rows();
        let n_components = y.len() / n_nodes;
        let at = slices(y.as_slice().chunks(n_nodes));
        let mut to = slices_mut(slope.as_mut_slice().chunks_mut(n_nodes));
        dynamics.flow(*instruction_set, &at[..n_components], &mut to[..n_components]);
        let mut sent = vec![0.0; coupling.n_channels() * n_nodes];
        let mut signals = slices_mut(sent.chunks_mut(n_nodes));
        let signals = &mut signals[..coupling.n_channels()];
        coupling.channels().send(*instruction_set, &at[..n_components], signals);
        for &Gain { equation, channel, weight } in coupling.gains() {
            let (source, strength) = (&signals[channel], self.epsilon * weight);
            for (node, row) in matrix.outer_iterator().enumerate() {
                let input: f64 = row.iter().map(|(j, &w)| w * source[j]).sum();
                to[equation][node] += strength * input;
            }
        }
    }
}
