//! What an experiment file says: the keys, their units and their defaults. Nothing is checked here
//! beyond types and names; [`crate::plan`](fn@crate::plan) turns a specification into what will be done.
//!
//! All times are in model time units, all coupling strengths in units of the coupling matrix.

mod atlas;
mod coupling;
pub(crate) mod defaults;
mod format;
mod named;
mod network;
mod oscillator;
mod solver;
mod values;

pub use atlas::{Atlas, AtlasMsfSpec, PublishedSpec, SystemSpec};
use claims::{ClaimSpec, Name};
pub use coupling::{CouplingSpec, FunctionSpec, MatrixKind};
use eigensync::{Bound, Wanted};
pub use format::Format;
use indexmap::IndexMap;
pub use network::{
    AttributesSpec, CommunitiesSpec, FileSpec, GroupsSpec, HierarchicalSpec, NetworkSpec,
    RegionsSpec, RowsSpec, StepSpec, SymmetriseSpec,
};
pub use oscillator::{CUSTOM, OscillatorSpec};
use serde::{Deserialize, Serialize};
pub use solver::SolverSpec;
pub use values::{EvenGrid, Grid, Layout, ThresholdSpec};

/// An experiment: one network, one oscillator, one question.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// One line that says what the experiment shows.
    #[serde(skip_serializing)]
    pub title: String,
    /// Where its settings and expected values come from.
    #[serde(default, skip_serializing)]
    pub source: String,
    /// Seed of everything random. Replicas of a sweep use this seed and those that follow.
    #[serde(default = "defaults::one")]
    pub seed: u64,
    /// Where the network comes from.
    pub network: NetworkSpec,
    /// Steps from what a file holds to a network: undirected, weights above zero, no self-loops.
    #[serde(default)]
    pub prepare: Vec<StepSpec>,
    /// Which nodes belong together.
    pub groups: Option<GroupsSpec>,
    /// Thresholds of the analysis of regions.
    pub regions: Option<RegionsSpec>,
    /// `[oscillator.NAME]` with its parameters; those left out have the defaults of the literature. Or
    /// `[oscillator.custom]` with equations of one's own.
    pub oscillator: OscillatorSpec,
    /// An orbit has escaped when a component exceeds this size.
    #[serde(default = "defaults::escape_radius")]
    pub escape_radius: f64,
    /// The coupling matrix and the coupling function.
    pub coupling: CouplingSpec,
    /// Which modes, by which solver.
    #[serde(default)]
    pub spectrum: SpectrumSpec,
    /// The master stability function.
    pub msf: MsfSpec,
    /// What makes a cluster.
    #[serde(default)]
    pub prediction: PredictionSpec,
    /// Without it the experiment only predicts.
    pub sweep: Option<SweepSpec>,
    /// How the figure looks.
    #[serde(default)]
    pub figure: FigureSpec,
    /// What the source says, by name.
    #[serde(default, skip_serializing)]
    pub claims: IndexMap<String, ClaimSpec>,
}

/// `[spectrum]`: which modes, by which solver.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct SpectrumSpec {
    /// By default all of a network that is small enough, else `"auto"`.
    pub modes: Option<Wanted>,
    /// Which solver.
    pub solver: SolverSpec,
    /// Largest relative residual; by default 1e-12, for networks that are large 1e-10.
    pub tolerance: Option<f64>,
}

/// `[msf]`: the master stability function.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct MsfSpec {
    /// Values of the generic coupling strength σ, from zero or above; left out, Λ is looked at as far as the
    /// step goes.
    pub sigma: Option<Grid>,
    /// The integrator of exponents; a map is iterated whatever is said here.
    #[serde(default)]
    pub method: MsfMethod,
    /// Step of RK4, 0.01 where it is left out; of a map 1.
    pub step: Option<f64>,
    /// Local error of a step of Taylor series.
    #[serde(default = "defaults::millionth")]
    pub tolerance: f64,
    /// Time before the averages begin.
    #[serde(default = "defaults::thousand")]
    pub transient: f64,
    /// Time of the average behind each point of the curve.
    #[serde(default = "defaults::hundred_thousand")]
    pub average: f64,
    /// Interval between renormalisations of the tangent vectors, 0.5 where it is left out; of a map 1.
    pub renormalise: Option<f64>,
    /// Standard error at which a zero of Λ is known well enough, relative to it.
    #[serde(default = "defaults::per_mille")]
    pub relative_error: f64,
}

/// Integrators of the master equation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MsfMethod {
    /// Taylor series where these are faster than RK4.
    #[default]
    Auto,
    /// Classical fourth-order Runge–Kutta with a fixed step.
    Rk4,
    /// Taylor series, with steps as long as they may be.
    Taylor,
}

/// `[prediction]`: what makes a cluster.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct PredictionSpec {
    /// `"exact"`: δe_ij = 0 up to the solver's accuracy; a number: single linkage below it.
    pub threshold: ThresholdSpec,
}

/// `[sweep]`: simulations over the coupling strength ε.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SweepSpec {
    /// Coupling strengths.
    pub epsilon: Grid,
    /// Replicas at every ε, from different initial states.
    #[serde(default = "defaults::four")]
    pub seeds: u64,
    /// The integrator: `auto` where it and the step are left out, and `rk4` where it alone is; a map is
    /// iterated.
    pub method: Option<MethodKind>,
    /// Step of the integrator, 0.01 where it is left out; of a map 1.
    pub step: Option<f64>,
    /// Time before the averages begin.
    pub transient: f64,
    /// Time of the averages behind every error.
    pub average: f64,
    /// Steps from one sample of the errors to the next, 10 where it is left out; of a map 1.
    pub stride: Option<u32>,
    /// Relative and absolute tolerance of the adaptive methods, 1e-9 where it is left out; of `auto` the
    /// error of a step per unit of time, relative to the size of the attractor, 1e-8.
    pub tolerance: Option<f64>,
    /// Relative size of the random kicks, one every unit of time, that keep nodes from becoming equal
    /// to the last bit and then staying so for ever; 0 for none.
    #[serde(default = "defaults::rounding_kick")]
    pub kick: f64,
    /// Component whose differences are the errors; the first one by default.
    pub component: Option<String>,
    /// Label of the node to which δx_i is measured.
    pub error_to: Option<Name>,
    /// Clusters within which δx^c_m is measured, in this order. Without these and `error_to` it is
    /// measured over the whole network.
    #[serde(default)]
    pub clusters: Vec<Vec<Name>>,
    /// Two nodes count as synchronised when δx_ij is below this, and a cluster when δx^c_m is.
    pub synchronised_below: Bound,
    /// States of nodes on the way, written to files of their own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub series: Option<SeriesSpec>,
}

impl SweepSpec {
    /// Whether method and step are to be chosen: where neither is asked for. A step by itself is of RK4.
    pub fn is_auto(&self) -> bool {
        let is_open = self.method.is_none() && self.step.is_none();
        is_open || self.method == Some(MethodKind::Auto)
    }

    /// The tolerance that is asked for, or that of the method.
    pub fn tolerance(&self) -> f64 {
        self.tolerance.unwrap_or(if self.is_auto() { 1e-8 } else { 1e-9 })
    }
}

/// `[sweep.series]`: states of chosen nodes, to be plotted as they are.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SeriesSpec {
    /// Labels of nodes, or names of groups for all of their nodes.
    pub nodes: Vec<Name>,
    /// Components; all of them by default.
    pub components: Option<Vec<String>>,
    /// Samples from one state to the next.
    #[serde(default = "defaults::one")]
    pub every: u64,
    /// Time of the first state, 0 for the initial one; by default the end of the transient.
    pub from: Option<f64>,
    /// Time of the last state; by default the end.
    pub to: Option<f64>,
    /// Points of the sweep; all of them by default.
    pub epsilon: Option<Vec<f64>>,
    /// Of how many seeds at each.
    #[serde(default = "defaults::one")]
    pub seeds: u64,
}

/// Integrators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MethodKind {
    /// `rk8` or `rk4` and its step, whichever costs least within a tolerance.
    Auto,
    /// Classical fourth-order Runge–Kutta with a fixed step.
    Rk4,
    /// Dormand–Prince of order 8 with a fixed step.
    Rk8,
    /// State by state: maps, and nothing else.
    Iterate,
    /// Adaptive Dormand–Prince 5(4).
    Dopri5,
    /// Adaptive Dormand–Prince 8(5,3).
    Dop853,
}

/// `[figure]`: how the figure looks.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct FigureSpec {
    /// What is drawn: the errors of a sweep against ε, matrices of distances and errors at every ε,
    /// or the nodes in space, coloured by clusters of regions.
    pub kind: FigureKind,
    /// Modes whose eigenvectors are drawn beside matrices; 2, 3 and 4 by default, or those of them
    /// that are computed.
    pub eigenvectors: Option<Vec<usize>>,
    /// Letter of the panels where a paper has several such figures: "a" gives (a1), (a2), …; without it
    /// they are (a), (b), …
    #[serde(skip_serializing_if = "Option::is_none")]
    pub letter: Option<String>,
    /// Letters of the panels that are drawn, such as "a" or "b1"; all of them by default.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub panels: Vec<String>,
    /// How the network is laid out.
    pub layout: Layout,
    /// Modes whose critical couplings are marked on the sweep; all of them by default.
    pub mark_modes: Option<Vec<usize>>,
    /// Couplings at which the source saw transitions, marked in another style.
    pub source_transitions: Vec<f64>,
    /// Scale of the axis of errors.
    pub error_scale: ErrorScale,
    /// How the spread over seeds is drawn.
    pub spread: SpreadKind,
}

impl Default for FigureSpec {
    fn default() -> Self {
        Self {
            kind: FigureKind::Sweep,
            eigenvectors: None,
            letter: None,
            panels: Vec::new(),
            layout: Layout::Force,
            mark_modes: None,
            source_transitions: Vec::new(),
            error_scale: ErrorScale::Linear,
            spread: SpreadKind::Band,
        }
    }
}

/// What the figure shows.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FigureKind {
    /// Errors against ε.
    Sweep,
    /// Distances and errors of all pairs.
    Matrices,
    /// The nodes in space.
    Regions,
    /// No figure: numbers only.
    None,
}

/// Scales of the axis of errors.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ErrorScale {
    /// Even.
    Linear,
    /// Logarithmic.
    Log,
}

/// How the spread over seeds is drawn.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SpreadKind {
    /// A shaded band.
    Band,
    /// A bar at every point.
    Bars,
}
