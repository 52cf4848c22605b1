//! What is asked: a network, an oscillator, how to compute, and what to simulate.

use clustering::ClusterRule;
use dynamics::lyapunov::{Integrator, Times};
use dynamics::{
    InstructionSet, Method, Observables, ROUNDING_KICK, Replica, Schedule, Series, Simulation,
};
use graph::{CouplingMatrix, Network, Normalization};
use msf::{Node, Refinement};

use crate::{Bound, WantedModes};

/// Up to this many nodes the errors of all pairs are kept.
pub const ALL_PAIRS: usize = 2000;

/// A question about one network of one oscillator.
#[derive(Clone, Debug)]
pub struct Study {
    /// Nodes, links, groups.
    pub network: Network,
    /// Its connected components.
    pub n_components: usize,
    /// W.
    pub matrix: CouplingMatrix,
    /// F and H.
    pub node: Node,
    /// How Λ(σ) is computed. Without any σ it is looked at as far as the step goes.
    pub msf: msf::Request,
    /// Which modes, by which solver.
    pub modes: WantedModes,
    /// When nodes are one cluster.
    pub rule: ClusterRule,
    /// Thresholds of regions, where the network has groups that are regions.
    pub regions: Option<RegionBounds>,
    /// What to simulate.
    pub sweep: Option<Sweep>,
    /// Of the isolated orbit by which times are judged.
    pub seed: u64,
}

/// Bounds within and between regions, of δe_ij and of δx_ij.
#[derive(Clone, Copy, Debug)]
pub struct RegionBounds {
    /// δe_ij within a region.
    pub distance_within: Bound,
    /// δe_ij between regions.
    pub distance_between: Bound,
    /// δx_ij within a region.
    pub error_within: Bound,
    /// δx_ij between regions.
    pub error_between: Bound,
}

/// Simulations over ε.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Coupling strengths, ascending.
    pub epsilon: Vec<f64>,
    /// Seeds of initial states at every ε.
    pub seeds: Vec<u64>,
    /// Integrator.
    pub method: Method,
    /// Times.
    pub schedule: Schedule,
    /// What to average.
    pub observables: Observables,
    /// States of which the observer is told on the way, if any: trajectories to plot.
    pub series: Option<Series>,
    /// Below which errors count as synchrony.
    pub synchronised_below: Bound,
    /// Relative size of random kicks.
    pub kick: f64,
}

impl Study {
    /// A study with the defaults: Λ(σ) looked at as far as the step goes, all modes
    /// up to 5000 nodes, exact clusters, no simulation.
    pub fn new(network: Network, normalization: Normalization, node: Node) -> Self {
        let n_components = network.components().len();
        let times = if node.dynamics.is_map() {
            Times {
                integrator: Integrator::Rk4,
                step: 1.0,
                transient: 1000.0,
                average: 1e5,
                renormalise: 1.0,
            }
        } else {
            Times {
                integrator: Integrator::Auto { tolerance: 1e-6 },
                step: 0.01,
                transient: 500.0,
                average: 2e4,
                renormalise: 0.5,
            }
        };
        Self {
            matrix: CouplingMatrix::new(&network, normalization),
            n_components,
            node,
            msf: msf::Request {
                sigma: Vec::new(),
                times,
                refinement: Refinement::default(),
                seed: 1,
                instruction_set: InstructionSet::best(),
            },
            modes: WantedModes::new((network.n_nodes(), n_components), None, None, None),
            network,
            rule: ClusterRule::Exact,
            regions: None,
            sweep: None,
            seed: 1,
        }
    }

    /// The simulation of a sweep.
    pub fn simulation(&self, sweep: &Sweep) -> Simulation<'_> {
        Simulation {
            dynamics: self.node.dynamics.clone(),
            coupling: self.node.coupling.clone(),
            matrix: self.matrix.matrix(),
            method: sweep.method,
            schedule: sweep.schedule,
            observables: sweep.observables.clone(),
            series: sweep.series.clone(),
            kick: sweep.kick,
            instruction_set: self.msf.instruction_set,
        }
    }

    /// The same at another schedule, whose states nobody asks for.
    pub fn probing(&self, sweep: &Sweep, schedule: Schedule) -> Simulation<'_> {
        Simulation { schedule, series: None, ..self.simulation(sweep) }
    }

    /// Steps of all tangent vectors of the MSF, refinement of one zero included, with what is run at
    /// half the step.
    pub fn msf_steps(&self) -> u64 {
        self.msf.steps()
    }
}

impl Sweep {
    /// A sweep of all pairs with the defaults: RK4 at a step of 0.01, a transient of 500 and an average
    /// of 1000 time units sampled every tenth step, four seeds, synchrony below 0.05.
    pub fn over(epsilon: Vec<f64>) -> Self {
        Self {
            epsilon,
            seeds: vec![1, 2, 3, 4],
            method: Method::Rk4,
            schedule: Schedule { step: 0.01, transient: 500.0, average: 1000.0, stride: 10 },
            observables: Observables { pairs: true, ..Observables::default() },
            series: None,
            synchronised_below: Bound::Fixed(0.05),
            kick: ROUNDING_KICK,
        }
    }

    /// A sweep of maps with the defaults: a transient of 1000 and an average of 10,000 iterations, every one
    /// of which is a sample.
    pub fn of_maps(epsilon: Vec<f64>) -> Self {
        Self {
            method: Method::Iterate,
            schedule: Schedule { step: 1.0, transient: 1000.0, average: 10_000.0, stride: 1 },
            ..Self::over(epsilon)
        }
    }

    /// The point of the sweep nearest to a coupling strength.
    pub fn nearest(&self, epsilon: f64) -> Option<f64> {
        let distance = |value: &f64| (value - epsilon).abs();
        self.epsilon.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// All replicas, seed by seed within each ε.
    pub fn replicas(&self) -> Vec<Replica> {
        let of = |&epsilon| self.seeds.iter().map(move |&seed| Replica { epsilon, seed });
        self.epsilon.iter().flat_map(of).collect()
    }

    /// Steps of all replicas together.
    pub fn steps(&self) -> u64 {
        self.replicas().len() as u64 * self.schedule.steps()
    }
}
