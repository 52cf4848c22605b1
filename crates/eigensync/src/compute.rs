//! What a study computes at length, one piece of work a method, so that whoever keeps finished work can
//! stand in between.

use std::ops::ControlFlow;

use dynamics::{DynamicsError, Next, Progress, Record, Replica, Run, Simulation, Start};
use msf::{MasterStability, MsfError};
use spectra::{SpectraError, Spectrum};

use crate::{Error, Observer, Probe, Simulated, StepEffect, Study, Sweep, Warning};

/// Does the long pieces of a study, and is told of the short ones.
pub trait Compute {
    /// What keeps it from being done.
    type Error: From<Error>;

    /// Λ(σ).
    ///
    /// # Errors
    /// Where it cannot be computed, or the work was stopped.
    fn curve(&self, study: &Study) -> Result<MasterStability, Self::Error>;

    /// The modes.
    ///
    /// # Errors
    /// As [`Self::curve`].
    fn spectrum(&self, study: &Study, request: &spectra::Request) -> Result<Spectrum, Self::Error>;

    /// All replicas of a sweep, in their order; its observer is told of their states where
    /// [`Sweep::series`] asks for them.
    ///
    /// # Errors
    /// As [`Self::curve`].
    fn runs(&self, study: &Study, sweep: &Sweep) -> Result<Vec<Run>, Self::Error>;

    /// What the step does to some of them.
    ///
    /// # Errors
    /// As [`Self::curve`].
    fn step_effects(
        &self,
        study: &Study,
        sweep: &Sweep,
        simulated: &Simulated,
    ) -> Result<Vec<StepEffect>, Self::Error>;

    /// A shorter stage, of so many steps where that is known.
    fn stage<T>(&self, name: &str, n_steps: Option<u64>, work: impl FnOnce(Progress<'_>) -> T)
    -> T;

    /// Is told of a warning.
    fn warn(&self, warning: &Warning);
}

/// Computes everything, and keeps nothing beside the findings.
pub(crate) struct Plainly<'a>(pub(crate) &'a dyn Observer);

impl Plainly<'_> {
    fn go_on(&self) -> Result<(), Error> {
        if self.0.wants_to_stop() { Err(Error::Cancelled) } else { Ok(()) }
    }

    /// Runs replicas from their initial states.
    fn watched(
        &self,
        simulation: &Simulation<'_>,
        replicas: Vec<Replica>,
    ) -> Result<Vec<Run>, Error> {
        let starts = replicas.iter().map(|&replica| Start::from(replica)).collect();
        let watched = Watched { observer: self.0, replicas };
        simulation.run_observed(starts, &watched).map_err(not_swept)
    }
}

impl Compute for Plainly<'_> {
    type Error = Error;

    fn curve(&self, study: &Study) -> Result<MasterStability, Error> {
        self.go_on()?;
        self.0.begins("msf", Some(study.msf_steps()));
        let advanced = |steps| told(self.0, steps);
        msf::master_stability(&study.node, &study.msf, &advanced).map_err(not_curve)
    }

    fn spectrum(&self, study: &Study, request: &spectra::Request) -> Result<Spectrum, Error> {
        self.go_on()?;
        self.0.begins("spectrum", None);
        let advanced = |_| told(self.0, 0);
        spectra::leading_modes_with(&study.matrix, request, &advanced).map_err(
            |error| match error {
                SpectraError::Cancelled => Error::Cancelled,
                other => Error::Spectrum(other),
            },
        )
    }

    fn runs(&self, study: &Study, sweep: &Sweep) -> Result<Vec<Run>, Error> {
        self.go_on()?;
        self.0.begins("sweep", Some(sweep.steps()));
        self.watched(&study.simulation(sweep), sweep.replicas())
    }

    fn step_effects(
        &self,
        study: &Study,
        sweep: &Sweep,
        simulated: &Simulated,
    ) -> Result<Vec<StepEffect>, Error> {
        self.go_on()?;
        let Some(probe) = Probe::of(sweep, simulated) else { return Ok(Vec::new()) };
        let at = |schedule: dynamics::Schedule| {
            self.0.begins("half step", Some(probe.replicas.len() as u64 * schedule.steps()));
            self.watched(&study.probing(sweep, schedule), probe.replicas.clone())
        };
        let [at_step, at_half] = probe.schedules.map(at);
        Ok(probe.effects(simulated, [&at_step?, &at_half?]))
    }

    fn stage<T>(
        &self,
        name: &str,
        n_steps: Option<u64>,
        work: impl FnOnce(Progress<'_>) -> T,
    ) -> T {
        self.0.begins(name, n_steps);
        work(&|steps| told(self.0, steps))
    }

    fn warn(&self, warning: &Warning) {
        self.0.warned(warning);
    }
}

/// Tells of steps, and asks whether to go on.
pub(crate) fn told(observer: &dyn Observer, steps: u64) -> ControlFlow<()> {
    observer.advanced(steps);
    if observer.wants_to_stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// What kept a curve from being computed.
pub(crate) fn not_curve(error: MsfError) -> Error {
    match error {
        MsfError::Dynamics(DynamicsError::Cancelled) => Error::Cancelled,
        other => Error::Curve(other),
    }
}

/// What kept replicas from being simulated.
fn not_swept(error: DynamicsError) -> Error {
    match error {
        DynamicsError::Cancelled => Error::Cancelled,
        other => Error::Sweep(other),
    }
}

/// Replicas that are watched.
struct Watched<'a> {
    observer: &'a dyn Observer,
    replicas: Vec<Replica>,
}

impl dynamics::Observer for Watched<'_> {
    fn advanced(&self, _: &[usize], steps: u64) -> Next {
        if told(self.observer, steps).is_break() { Next::Stop } else { Next::GoOn }
    }

    fn recorded(&self, replica: usize, record: &Record<'_>) {
        self.observer.recorded(self.replicas[replica], record);
    }
}
