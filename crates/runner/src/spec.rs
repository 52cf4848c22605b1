//! What an experiment file says: the keys, their units and their defaults. Nothing is checked here
//! beyond types and names; [`crate::plan`] turns a specification into what will be done.
//!
//! All times are in model time units, all coupling strengths in units of the coupling matrix.

mod network;

use dynamics::Model;
use indexmap::IndexMap;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::marker::PhantomData;

pub use network::{
    CommunitiesSpec, FileSpec, Format, GroupsSpec, HierarchicalSpec, NetworkSpec, RegionsSpec,
    RowsSpec, StepSpec, SymmetriseSpec,
};

/// An experiment: one network, one oscillator, one question.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// One line that says what the experiment shows.
    pub title: String,
    /// Where its settings and expected values come from.
    #[serde(default)]
    pub source: String,
    /// Seed of everything random. Replicas of a sweep use this seed and those that follow.
    #[serde(default = "one")]
    pub seed: u64,
    pub network: NetworkSpec,
    /// Steps from what a file holds to a network: undirected, weights above zero, no self-loops.
    #[serde(default)]
    pub prepare: Vec<StepSpec>,
    pub groups: Option<GroupsSpec>,
    pub regions: Option<RegionsSpec>,
    /// `[oscillator.NAME]` with its parameters; those left out have the defaults of the literature.
    pub oscillator: Model,
    pub coupling: CouplingSpec,
    #[serde(default)]
    pub spectrum: SpectrumSpec,
    pub msf: MsfSpec,
    #[serde(default)]
    pub prediction: PredictionSpec,
    /// Without it the experiment only predicts.
    pub sweep: Option<SweepSpec>,
    #[serde(default)]
    pub figure: FigureSpec,
    #[serde(default)]
    pub claims: IndexMap<String, ClaimSpec>,
}

/// `[coupling]`: the coupling matrix W and the coupling function H.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CouplingSpec {
    pub matrix: MatrixKind,
    /// Component read from the driving node.
    pub from: String,
    /// Component whose equation it enters.
    pub to: String,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MatrixKind {
    /// w_ij = a_ij.
    Laplacian,
    /// w_ij = a_ij / k_i.
    Normalized,
}

/// `[spectrum]`: which modes, by which solver.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SpectrumSpec {
    pub modes: WordOr<All, u64>,
    pub solver: SolverKind,
}

impl Default for SpectrumSpec {
    fn default() -> Self {
        Self { modes: WordOr::Word(All), solver: SolverKind::Auto }
    }
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SolverKind {
    /// Dense for small networks, ARPACK for large ones.
    Auto,
    Dense,
    Arpack,
}

/// `[msf]`: the master stability function.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MsfSpec {
    /// Values of the generic coupling strength σ, from zero or above.
    pub sigma: Grid,
    #[serde(default = "step")]
    pub step: f64,
    #[serde(default = "thousand")]
    pub transient: f64,
    /// Time of the average behind each point of the curve.
    #[serde(default = "hundred_thousand")]
    pub average: f64,
    /// Interval between renormalisations of the tangent vectors.
    #[serde(default = "half")]
    pub renormalise: f64,
    /// Standard error at which a zero of Λ is known well enough, relative to it.
    #[serde(default = "per_mille")]
    pub relative_error: f64,
}

/// `[prediction]`: what makes a cluster.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PredictionSpec {
    /// `"exact"`: δe_ij = 0 up to the solver's accuracy; a number: single linkage below it.
    pub threshold: WordOr<Exact, f64>,
}

/// `[sweep]`: simulations over the coupling strength ε.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepSpec {
    pub epsilon: Grid,
    /// Replicas at every ε, from different initial states.
    #[serde(default = "four")]
    pub seeds: u64,
    #[serde(default)]
    pub method: MethodKind,
    #[serde(default = "step")]
    pub step: f64,
    pub transient: f64,
    pub average: f64,
    /// Steps from one sample of the errors to the next.
    #[serde(default = "ten")]
    pub stride: u32,
    /// Relative and absolute tolerance of the adaptive methods.
    #[serde(default = "billionth")]
    pub tolerance: f64,
    /// Relative size of the random kicks, one every unit of time, that keep nodes from becoming equal
    /// to the last bit and then staying so for ever; 0 for none.
    #[serde(default = "rounding_kick")]
    pub kick: f64,
    /// Component whose differences are the errors; the first one by default.
    pub component: Option<String>,
    /// Label of the node to which δx_i is measured.
    pub error_to: Option<Name>,
    /// Clusters within which δx^c_m is measured, in this order. Without these and `error_to` it is
    /// measured over the whole network.
    #[serde(default)]
    pub clusters: Vec<Vec<Name>>,
    /// Two nodes count as synchronised when δx_ij is below this, and a cluster when δx^c_m is, in the
    /// units of the component.
    pub synchronised_below: f64,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MethodKind {
    /// Classical fourth-order Runge–Kutta with a fixed step.
    #[default]
    Rk4,
    /// Adaptive Dormand–Prince 5(4).
    Dopri5,
    /// Adaptive Dormand–Prince 8(5,3).
    Dop853,
}

/// `[figure]`: how the figure looks.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FigureSpec {
    /// What is drawn: the errors of a sweep against ε, matrices of distances and errors at every ε,
    /// or the nodes in space, coloured by clusters of regions.
    pub kind: FigureKind,
    /// Modes whose eigenvectors are drawn beside matrices.
    pub eigenvectors: Vec<usize>,
    /// Letter of the paper's panels: "a" gives (a1), (a2), …
    pub letter: String,
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
            eigenvectors: vec![2, 3, 4],
            letter: "a".into(),
            layout: Layout::Force,
            mark_modes: None,
            source_transitions: Vec::new(),
            error_scale: ErrorScale::Linear,
            spread: SpreadKind::Band,
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum FigureKind {
    Sweep,
    Matrices,
    Regions,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ErrorScale {
    Linear,
    Log,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpreadKind {
    /// A shaded band.
    Band,
    /// A bar at every point.
    Bars,
}

/// `"circle"`, `"force"`, `"grouped"`, or a list of positions `[x, y]`, one for each node in order.
#[derive(Clone, Debug)]
pub enum Layout {
    /// On a circle in node order.
    Circle,
    /// So that distances on paper are those along the links.
    Force,
    /// Every cluster on a circle of its own.
    Grouped,
    /// Where the file says.
    At(Vec<[f64; 2]>),
}

/// One entry of `[claims]`: a value the source states, and how near ours must come.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClaimSpec {
    /// Which quantity.
    pub of: Quantity,
    /// Which instance of it.
    #[serde(default, rename = "where")]
    pub at: Where,
    /// The source's value; exactly one of `equals`, `at_most` and `at_least` is given.
    pub equals: Option<toml::Value>,
    pub at_most: Option<f64>,
    pub at_least: Option<f64>,
    pub abs_tol: Option<f64>,
    pub rel_tol: Option<f64>,
    /// Where the source says it; the experiment's own source by default.
    #[serde(default)]
    pub source: String,
    /// Why the tolerance is what it is.
    #[serde(default)]
    pub reason: String,
    /// Why a difference is expected: the verdict is then `differs as known`.
    pub known_difference: Option<String>,
}

/// Quantities that claims speak of.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
pub enum Quantity {
    /// All λ_k, descending.
    #[serde(rename = "eigenvalues")]
    Eigenvalues,
    /// Distance of given vectors from the eigenspace of `where.modes`.
    #[serde(rename = "eigenvectors")]
    Eigenvectors,
    /// Λ(0).
    #[serde(rename = "msf.lyapunov_isolated")]
    LyapunovIsolated,
    /// σ_c.
    #[serde(rename = "msf.sigma_c")]
    SigmaC,
    /// ε_k of `where.modes`.
    #[serde(rename = "critical_couplings")]
    CriticalCouplings,
    /// Predicted clusters at `where.epsilon`.
    #[serde(rename = "cascade.clusters")]
    CascadeClusters,
    /// Positions of `where.clusters` in the order in which they are predicted to be lost.
    #[serde(rename = "cascade.order_of_loss")]
    CascadeOrder,
    /// Simulated clusters at `where.epsilon`.
    #[serde(rename = "simulated.clusters")]
    SimulatedClusters,
    /// ε from which on all of `where.clusters` stay synchronised.
    #[serde(rename = "simulated.onset")]
    SimulatedOnset,
    /// Positions of `where.clusters` in the order in which they are lost as ε falls.
    #[serde(rename = "simulated.order_of_loss")]
    SimulatedOrder,
    /// Largest δx^c_m of `where.clusters` at `where.epsilon`.
    #[serde(rename = "simulated.error")]
    SimulatedError,
    /// Number of nodes of the network.
    #[serde(rename = "network.nodes")]
    Nodes,
    /// Number of links of the network.
    #[serde(rename = "network.links")]
    Links,
    /// Number of groups of the network.
    #[serde(rename = "network.groups")]
    Groups,
    /// Pearson's correlation of δx_ij with δe_ij over all pairs at `where.epsilon`.
    #[serde(rename = "agreement.pearson")]
    Pearson,
    /// Spearman's rank correlation of δx_ij with δe_ij over all pairs at `where.epsilon`.
    #[serde(rename = "agreement.spearman")]
    Spearman,
    /// Adjusted Rand index of predicted and simulated clusters at `where.epsilon`.
    #[serde(rename = "agreement.rand_index")]
    RandIndex,
    /// Fraction of regions of the same verdict in prediction and simulation at `where.epsilon`.
    #[serde(rename = "agreement.regions")]
    RegionVerdicts,
}

/// Which instance of a quantity a claim is about.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Where {
    pub epsilon: Option<f64>,
    /// Modes k, counted from 1 as in λ_k.
    pub modes: Option<Vec<usize>>,
    /// Clusters of node labels.
    pub clusters: Option<Vec<Vec<Name>>>,
}

/// A node label, written as a text or as a whole number.
#[derive(Clone, Debug, PartialEq)]
pub struct Name(pub String);

/// A grid of values: `{ from, to, points }`, evenly spaced with both ends, or a list.
#[derive(Clone, Debug)]
pub enum Grid {
    Even(EvenGrid),
    List(Vec<f64>),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EvenGrid {
    pub from: f64,
    pub to: f64,
    pub points: u32,
}

impl Grid {
    /// The values in their order.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::List(values) => values.clone(),
            Self::Even(EvenGrid { from, to, points: 1 }) if from == to => vec![*from],
            Self::Even(EvenGrid { from, to, points }) => {
                // Rounded to 12 digits, so that 0.1 … 1.3 reads 0.3 and not 0.30000000000000004.
                let last = f64::from(points.saturating_sub(1));
                let value = |k: u32| from + (to - from) * f64::from(k) / last;
                let rounded = |x: f64| (x * 1e12).round() / 1e12;
                let shorten = |x: f64| if rounded(x).is_finite() { rounded(x) } else { x };
                (0..*points).map(value).map(shorten).collect()
            }
        }
    }
}

/// A word that stands for itself, or a number.
#[derive(Clone, Copy, Debug)]
pub enum WordOr<W, N> {
    Word(W),
    Number(N),
}

/// A word that a key accepts in place of a number.
pub trait Word: Default {
    const WORD: &'static str;
}

/// `"all"`.
#[derive(Clone, Copy, Debug, Default)]
pub struct All;

impl Word for All {
    const WORD: &'static str = "all";
}

/// `"exact"`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exact;

impl Word for Exact {
    const WORD: &'static str = "exact";
}

impl<W: Word, N> Default for WordOr<W, N> {
    fn default() -> Self {
        Self::Word(W::default())
    }
}

impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Label;
        impl Visitor<'_> for Label {
            type Value = Name;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a node label: a text or a whole number")
            }
            fn visit_str<E: Error>(self, label: &str) -> Result<Name, E> {
                Ok(Name(label.to_owned()))
            }
            fn visit_i64<E: Error>(self, label: i64) -> Result<Name, E> {
                Ok(Name(label.to_string()))
            }
        }
        deserializer.deserialize_any(Label)
    }
}

impl<'de> Deserialize<'de> for Grid {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Values;
        impl<'de> Visitor<'de> for Values {
            type Value = Grid;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("{ from = …, to = …, points = … } or a list of numbers")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Grid, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Grid::List)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Grid, A::Error> {
                EvenGrid::deserialize(MapAccessDeserializer::new(map)).map(Grid::Even)
            }
        }
        deserializer.deserialize_any(Values)
    }
}

impl<'de> Deserialize<'de> for Layout {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrPositions;
        impl<'de> Visitor<'de> for NameOrPositions {
            type Value = Layout;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"circle\", \"force\", \"grouped\" or a list of positions [x, y]")
            }
            fn visit_str<E: Error>(self, name: &str) -> Result<Layout, E> {
                match name {
                    "circle" => Ok(Layout::Circle),
                    "force" => Ok(Layout::Force),
                    "grouped" => Ok(Layout::Grouped),
                    _ => Err(E::unknown_variant(name, &["circle", "force", "grouped"])),
                }
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Layout, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Layout::At)
            }
        }
        deserializer.deserialize_any(NameOrPositions)
    }
}

impl<'de, W: Word, N: Deserialize<'de> + FromNumber> Deserialize<'de> for WordOr<W, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either<W, N>(PhantomData<(W, N)>);
        impl<W: Word, N: FromNumber> Visitor<'_> for Either<W, N> {
            type Value = WordOr<W, N>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "\"{}\" or {}", W::WORD, N::KIND)
            }
            fn visit_str<E: Error>(self, word: &str) -> Result<Self::Value, E> {
                if word == W::WORD {
                    Ok(WordOr::Word(W::default()))
                } else {
                    Err(E::invalid_value(serde::de::Unexpected::Str(word), &self))
                }
            }
            fn visit_i64<E: Error>(self, number: i64) -> Result<Self::Value, E> {
                N::from_whole(number)
                    .map(WordOr::Number)
                    .ok_or_else(|| E::invalid_value(serde::de::Unexpected::Signed(number), &self))
            }
            fn visit_f64<E: Error>(self, number: f64) -> Result<Self::Value, E> {
                N::from_real(number)
                    .map(WordOr::Number)
                    .ok_or_else(|| E::invalid_type(serde::de::Unexpected::Float(number), &self))
            }
        }
        deserializer.deserialize_any(Either(PhantomData))
    }
}

/// Numbers that may stand in place of a [`Word`].
pub trait FromNumber: Sized {
    const KIND: &'static str;
    fn from_whole(number: i64) -> Option<Self>;
    fn from_real(number: f64) -> Option<Self>;
}

impl FromNumber for f64 {
    const KIND: &'static str = "a number";
    fn from_whole(number: i64) -> Option<Self> {
        Some(number as f64)
    }
    fn from_real(number: f64) -> Option<Self> {
        Some(number)
    }
}

impl FromNumber for u64 {
    const KIND: &'static str = "a whole number";
    fn from_whole(number: i64) -> Option<Self> {
        Self::try_from(number).ok()
    }
    fn from_real(_: f64) -> Option<Self> {
        None
    }
}

fn one() -> u64 {
    1
}

fn four() -> u64 {
    4
}

fn ten() -> u32 {
    10
}

fn step() -> f64 {
    0.01
}

fn half() -> f64 {
    0.5
}

fn per_mille() -> f64 {
    1e-3
}

fn billionth() -> f64 {
    1e-9
}

fn rounding_kick() -> f64 {
    dynamics::ROUNDING_KICK
}

fn thousand() -> f64 {
    1e3
}

fn hundred_thousand() -> f64 {
    1e5
}
