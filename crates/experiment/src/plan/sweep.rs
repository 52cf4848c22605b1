//! The sweep of a plan: couplings, seeds, times, integrator, and what is observed.

use dynamics::{
    Adaptive, AdaptiveOrder, Method, NodeDynamics, Observables, Schedule, StepChoice, choose_step,
};
use eigensync::numbers::plain;
use eigensync::{ALL_PAIRS, Sweep};
use graph::{CouplingMatrix, Names, Network};
use msf::Node;
use user::Result;

use super::checker::Checker;
use super::step::fastest_bound;
use crate::spec::{MethodKind, SweepSpec};

/// Step of RK4 where none is asked for.
const STEP: f64 = 0.01;
/// Time between samples where the step is chosen, in whole steps.
const SAMPLING: f64 = 0.1;

impl Checker<'_> {
    pub(super) fn sweep(
        &self,
        spec: &SweepSpec,
        (network, matrix): (&Network, &CouplingMatrix),
        node: &Node,
    ) -> Result<(Sweep, Option<StepChoice>)> {
        let dynamics = node.dynamics.as_ref();
        let epsilon = self.grid("sweep.epsilon", &spec.epsilon, 1)?;
        let fastest = epsilon[epsilon.len() - 1] * fastest_bound(matrix);
        let chosen = self.chosen(spec, node, fastest)?;
        let method = match &chosen {
            Some(chosen) => chosen.method,
            None => self.method(spec, dynamics)?,
        };
        let schedule = self.schedule(spec, (epsilon[0], chosen.as_ref()), dynamics)?;
        let pairs = network.n_nodes() <= ALL_PAIRS;
        self.affordable(spec.seeds, epsilon.len(), &schedule, (network.n_nodes(), pairs))?;
        let component = match &spec.component {
            Some(name) => self.component("sweep.component", name, dynamics)?,
            None => 0,
        };
        let names = Names::of(network);
        let reference = match &spec.error_to {
            Some(name) => {
                let named = names.node(name.as_ref());
                Some(named.map_err(|error| self.misnamed("sweep.error_to", &error))?)
            }
            None => None,
        };
        let mut clusters = names
            .clusters(&spec.clusters)
            .map_err(|error| self.misnamed("sweep.clusters", &error))?;
        if clusters.is_empty() && reference.is_none() && network.n_nodes() > 1 {
            clusters.push((0..network.n_nodes()).collect());
        }
        self.bound("sweep.synchronised_below", spec.synchronised_below, pairs)?;
        self.sweep_ranges(spec, schedule.step)?;
        let first = self.experiment.seed;
        let sweep = Sweep {
            epsilon,
            seeds: (0..spec.seeds).map(|k| first.wrapping_add(k)).collect(),
            method,
            schedule,
            observables: Observables { component, pairs, reference, clusters },
            series: spec
                .series
                .as_ref()
                .map(|series| self.series(series, network, dynamics))
                .transpose()?,
            synchronised_below: spec.synchronised_below,
            kick: spec.kick,
        };
        Ok((sweep, chosen))
    }

    /// What `method = "auto"` comes to; none for another method, for a map, and where the isolated orbit
    /// escapes, of which the run will tell.
    fn chosen(&self, spec: &SweepSpec, node: &Node, fastest: f64) -> Result<Option<StepChoice>> {
        let Node { dynamics, coupling } = node;
        if !spec.is_auto() || dynamics.is_map() {
            return Ok(None);
        }
        self.positive("sweep.tolerance", spec.tolerance())?;
        let (of, seed) = ((dynamics.as_ref(), coupling), self.experiment.seed);
        let choose = || choose_step(of, fastest, spec.tolerance(), seed).ok();
        Ok(self.stages.unmeasured("choice of the step", choose))
    }

    fn schedule(
        &self,
        spec: &SweepSpec,
        (least_epsilon, chosen): (f64, Option<&StepChoice>),
        dynamics: &dyn NodeDynamics,
    ) -> Result<Schedule> {
        self.not_negative("sweep.epsilon", least_epsilon)?;
        let asked = chosen.map_or(spec.step, |chosen| Some(chosen.step));
        let step = self.step("sweep.step", asked, dynamics)?;
        let usual = match (dynamics.is_map(), chosen) {
            (true, _) => 1,
            (false, None) => 10,
            (false, Some(chosen)) => (SAMPLING / chosen.step).round().max(1.0) as u32,
        };
        let stride = spec.stride.unwrap_or(usual);
        self.not_negative("sweep.kick", spec.kick)?;
        self.not_negative("sweep.transient", spec.transient)?;
        self.positive("sweep.average", spec.average)?;
        self.positive("sweep.tolerance", spec.tolerance())?;
        self.positive("sweep.stride", f64::from(stride))?;
        self.positive("sweep.seeds", spec.seeds as f64)?;
        let schedule = Schedule {
            step,
            transient: spec.transient / self.shortened,
            average: spec.average / self.shortened,
            stride,
        };
        let interval = (schedule.sampling_interval(), "`sweep.step` × `sweep.stride`");
        self.blocks("sweep.average", spec.average, interval)?;
        Ok(schedule)
    }

    /// The step that is asked for, or the usual one.
    pub(super) fn step(
        &self,
        key: &str,
        asked: Option<f64>,
        dynamics: &dyn NodeDynamics,
    ) -> Result<f64> {
        let is_map = dynamics.is_map();
        let step = asked.unwrap_or(if is_map { 1.0 } else { STEP });
        self.positive(key, step)?;
        if is_map && step != 1.0 {
            let message = format!("is {}, but a map goes in steps of 1", plain(step));
            return Err(self.problem(key, message).hint("leave it out"));
        }
        Ok(step)
    }

    fn method(&self, spec: &SweepSpec, dynamics: &dyn NodeDynamics) -> Result<Method> {
        let (is_map, key) = (dynamics.is_map(), "sweep.method");
        let adaptive = |order| {
            Method::Adaptive(Adaptive {
                order,
                relative_tolerance: spec.tolerance(),
                absolute_tolerance: spec.tolerance(),
            })
        };
        let method = match spec.method {
            None | Some(MethodKind::Auto) if is_map => Method::Iterate,
            // Auto comes here where orbits escape, whatever the step.
            None | Some(MethodKind::Auto | MethodKind::Rk4) => Method::Rk4,
            Some(MethodKind::Rk8) => Method::Dop853,
            Some(MethodKind::Iterate) => Method::Iterate,
            Some(MethodKind::Dopri5) => adaptive(AdaptiveOrder::Five),
            Some(MethodKind::Dop853) => adaptive(AdaptiveOrder::Eight),
        };
        match (is_map, method == Method::Iterate) {
            (true, false) => {
                let message = "integrates a flow, but the oscillator is a map, which is iterated";
                Err(self.problem(key, message).hint("leave it out"))
            }
            (false, true) => {
                let message = "is \"iterate\", which is for maps, but the oscillator is a flow";
                Err(self
                    .problem(key, message)
                    .hint("take \"rk4\", \"rk8\", \"dopri5\" or \"dop853\""))
            }
            _ => Ok(method),
        }
    }
}
