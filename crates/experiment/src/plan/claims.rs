//! Claims before anything is computed: each names an instance of its quantity that will exist, and
//! states a value of the shape that the quantity has.

use eigensync::numbers::plain;
use serde::de::DeserializeOwned;

use super::{ALL_PAIRS, Checker, Plan};
use crate::spec::{ClaimSpec, Name, OneOrMany, Quantity};
use user::Result;

/// Whether a quantity is singled out by a key of `where`.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    Needed,
    Allowed,
    Meaningless,
}

/// The value that a claim states.
enum Shape {
    /// One number, or a list of so many; of any length where that is not known.
    Numbers(Option<usize>),
    /// A vector over the nodes for each mode.
    Vectors,
    Clusters,
    /// Positions of the clusters in an order.
    Order,
}

impl Checker<'_> {
    /// What a claim needs beside its quantity must be there, and must name what exists.
    pub(super) fn claims(&self, plan: &Plan) -> Result<()> {
        let mut claims = self.experiment.claims.iter();
        claims.try_for_each(|(name, spec)| Claim { checker: self, name, spec, plan }.check())
    }
}

struct Claim<'a> {
    checker: &'a Checker<'a>,
    name: &'a str,
    spec: &'a ClaimSpec,
    plan: &'a Plan,
}

impl Claim<'_> {
    fn check(&self) -> Result<()> {
        self.instance()?;
        self.epsilon()?;
        self.modes()?;
        self.clusters()?;
        self.value()?;
        self.tolerance()
    }

    fn key(&self, key: &str) -> String {
        format!("claims.{}{key}", self.name)
    }

    fn refuse<T>(&self, key: &str, message: impl std::fmt::Display) -> Result<T> {
        Err(self.checker.problem(&self.key(key), message))
    }

    /// The keys of `where` are those that the quantity asks for, and simulations are there.
    fn instance(&self) -> Result<()> {
        use Quantity as Q;
        use Use::{Allowed, Meaningless, Needed};
        let [epsilon, modes, clusters] = match self.spec.of {
            Q::Eigenvalues => [Meaningless, Allowed, Meaningless],
            Q::Eigenvectors | Q::CriticalCouplings => [Meaningless, Needed, Meaningless],
            Q::LyapunovIsolated | Q::SigmaC | Q::Nodes | Q::Links | Q::Groups => [Meaningless; 3],
            Q::CascadeClusters
            | Q::SimulatedClusters
            | Q::Pearson
            | Q::Spearman
            | Q::RandIndex
            | Q::RegionVerdicts
            | Q::PredictedRegions
            | Q::SimulatedRegions
            | Q::PredictedGrey
            | Q::SimulatedGrey
            | Q::PredictedSize
            | Q::SimulatedSize => [Needed, Meaningless, Meaningless],
            Q::CascadeOrder | Q::SimulatedOrder | Q::SimulatedOnset => {
                [Meaningless, Meaningless, Needed]
            }
            Q::SimulatedError => [Needed, Meaningless, Needed],
        };
        let at = &self.spec.at;
        self.used("epsilon", epsilon, at.epsilon.is_some())?;
        self.used("modes", modes, at.modes.is_some())?;
        self.used("clusters", clusters, at.clusters.is_some())?;
        let prefix = if self.spec.of == Q::Nodes { Allowed } else { Meaningless };
        self.used("group_prefix", prefix, at.group_prefix.is_some())?;
        self.group_prefix()?;
        if self.spec.of.is_of_regions() && self.checker.experiment.regions.is_none() {
            return self.refuse("", "is about regions, but there is no [regions]");
        }
        match &self.plan.study.sweep {
            None if self.needs_sweep() => {
                self.refuse("", "is about simulations, but there is no [sweep]")
            }
            Some(sweep) if self.needs_sweep() && !sweep.observables.pairs => {
                let message = format!(
                    "needs the errors of all pairs of nodes, which are kept for networks of up to \
                     {ALL_PAIRS} nodes"
                );
                self.refuse("", message)
            }
            _ => Ok(()),
        }
    }

    /// A prefix that begins the name of no group would count no nodes.
    fn group_prefix(&self) -> Result<()> {
        let Some(prefix) = &self.spec.at.group_prefix else { return Ok(()) };
        let groups = self.plan.study.network.groups();
        if groups.iter().any(|group| group.name.starts_with(prefix.as_str())) {
            return Ok(());
        }
        self.refuse(".where.group_prefix", format!("is \"{prefix}\", with which no group begins"))
    }

    fn used(&self, key: &str, used: Use, given: bool) -> Result<()> {
        match (used, given) {
            (Use::Needed, false) => self.refuse("", format!("needs `where.{key}`")),
            (Use::Meaningless, true) => {
                self.refuse(&format!(".where.{key}"), "means nothing for this quantity")
            }
            _ => Ok(()),
        }
    }

    /// Whether it speaks of the two-threshold analysis, which is made at the ε of the sweep.
    /// Regions are held against the simulated ones, whichever of both a claim is about.
    fn needs_sweep(&self) -> bool {
        self.spec.of.is_simulated() || self.spec.of.is_of_regions()
    }

    fn epsilon(&self) -> Result<()> {
        let Some(epsilon) = &self.spec.at.epsilon else { return Ok(()) };
        match (epsilon.list().len(), self.shape()) {
            (0, _) => return self.refuse(".where.epsilon", "is empty"),
            (1, _) | (_, Shape::Numbers(_)) => {}
            _ => return self.refuse(".where.epsilon", "has several values, but must be one here"),
        }
        epsilon.list().iter().try_for_each(|&epsilon| self.one_epsilon(epsilon))
    }

    fn one_epsilon(&self, epsilon: f64) -> Result<()> {
        self.checker.positive(&self.key(".where.epsilon"), epsilon)?;
        let Some(sweep) = self.plan.study.sweep.as_ref().filter(|_| self.needs_sweep()) else {
            return Ok(());
        };
        if sweep.epsilon.contains(&epsilon) {
            return Ok(());
        }
        let distance = |value: &f64| (value - epsilon).abs();
        let nearest = sweep.epsilon.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let message = format!("is {}, which is not a point of `sweep.epsilon`", plain(epsilon));
        let problem = self.checker.problem(&self.key(".where.epsilon"), message);
        Err(match nearest {
            Some(&nearest) => problem.hint(format!("the nearest point is {}", plain(nearest))),
            None => problem,
        })
    }

    fn modes(&self) -> Result<()> {
        let Some(modes) = &self.spec.at.modes else { return Ok(()) };
        let computed = self.plan.study.modes.most_modes(self.plan.study.network.n_nodes());
        if modes.is_empty() {
            return self.refuse(".where.modes", "is empty");
        }
        self.checker.modes(&self.key(".where.modes"), modes, computed)
    }

    fn clusters(&self) -> Result<()> {
        let Some(clusters) = &self.spec.at.clusters else { return Ok(()) };
        if clusters.is_empty() {
            return self.refuse(".where.clusters", "is empty");
        }
        let key = self.key(".where.clusters");
        self.checker.clusters(&key, clusters, &self.plan.study.network).map(|_| ())
    }

    fn shape(&self) -> Shape {
        use Quantity as Q;
        let modes = self.spec.at.modes.as_ref().map(Vec::len);
        match self.spec.of {
            Q::Eigenvalues | Q::CriticalCouplings => Shape::Numbers(modes),
            Q::Eigenvectors => Shape::Vectors,
            Q::CascadeClusters
            | Q::SimulatedClusters
            | Q::PredictedRegions
            | Q::SimulatedRegions => Shape::Clusters,
            Q::CascadeOrder | Q::SimulatedOrder => Shape::Order,
            _ => Shape::Numbers(Some(self.spec.at.epsilon.as_ref().map_or(1, |e| e.list().len()))),
        }
    }

    /// Exactly one of `equals`, `at_most`, `at_least` and `trend`, of the quantity's shape.
    fn value(&self) -> Result<()> {
        let spec = self.spec;
        let stated = [
            spec.equals.is_some(),
            spec.at_most.is_some(),
            spec.at_least.is_some(),
            spec.trend.is_some(),
        ];
        if stated.iter().filter(|given| **given).count() != 1 {
            let message = "must have exactly one of `equals`, `at_most`, `at_least`, `trend`";
            return self.refuse("", message);
        }
        if spec.trend.is_some() {
            // How many eigenvalues there are beforehand is known only of all of them together.
            let one = self.plan.study.network.n_nodes() < 2;
            return match self.shape() {
                Shape::Numbers(None) if !one => Ok(()),
                Shape::Numbers(Some(2..)) => Ok(()),
                _ => self.refuse(".trend", "needs two numbers or more to compare"),
            };
        }
        if let Some(bound) = spec.at_most.or(spec.at_least) {
            return match self.shape() {
                Shape::Numbers(_) if bound.is_finite() => Ok(()),
                Shape::Numbers(_) => self.refuse("", "has a bound that is not finite"),
                _ => self.refuse("", "is about no number, so that it needs `equals`"),
            };
        }
        match self.shape() {
            Shape::Numbers(count) => self.numbers(count),
            Shape::Vectors => self.vectors(),
            Shape::Clusters => {
                let clusters: Vec<Vec<Name>> =
                    self.equals("a list of clusters, such as [[1, 2], [3, 4]]")?;
                let key = self.key(".equals");
                self.checker.clusters(&key, &clusters, &self.plan.study.network).map(|_| ())
            }
            Shape::Order => self.order(),
        }
    }

    fn equals<T: DeserializeOwned>(&self, expected: &str) -> Result<T> {
        let read = self.spec.equals.clone().and_then(|value| value.try_into().ok());
        read.map_or_else(|| self.refuse(".equals", format!("must be {expected}")), Ok)
    }

    fn numbers(&self, count: Option<usize>) -> Result<()> {
        let numbers: OneOrMany = self.equals("a number or a list of numbers")?;
        let numbers = numbers.list();
        if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
            return self.refuse(".equals", format!("contains {number}, but must be finite"));
        }
        match count.filter(|&count| count != numbers.len()) {
            None if numbers.is_empty() => self.refuse(".equals", "is an empty list"),
            None => Ok(()),
            Some(count) => {
                let message = format!("has {} values, expected {count}", numbers.len());
                self.refuse(".equals", message)
            }
        }
    }

    fn vectors(&self) -> Result<()> {
        let vectors: Vec<Vec<f64>> = self.equals("a list of vectors")?;
        let modes = self.spec.at.modes.as_ref().map_or(0, Vec::len);
        let n_nodes = self.plan.study.network.n_nodes();
        if vectors.len() != modes || vectors.iter().any(|vector| vector.len() != n_nodes) {
            let message = format!("must be {modes} vectors of {n_nodes} components each");
            return self.refuse(".equals", message);
        }
        if vectors.iter().flatten().any(|component| !component.is_finite()) {
            return self.refuse(".equals", "has a component that is not finite");
        }
        if vectors.iter().any(|vector| vector.iter().all(|&component| component == 0.0)) {
            return self.refuse(".equals", "has a vector of zeros, which has no direction");
        }
        Ok(())
    }

    fn order(&self) -> Result<()> {
        let mut positions: Vec<usize> = self.equals("a list of positions, such as [2, 1, 3]")?;
        positions.sort_unstable();
        let count = self.spec.at.clusters.as_ref().map_or(0, Vec::len);
        if count < 2 {
            return self
                .refuse(".where.clusters", "has one cluster, but an order needs two or more");
        }
        if positions.into_iter().eq(1..=count) {
            return Ok(());
        }
        self.refuse(".equals", format!("must have each of the positions 1 to {count} once"))
    }

    fn tolerance(&self) -> Result<()> {
        let tolerances = [("abs_tol", self.spec.abs_tol), ("rel_tol", self.spec.rel_tol)];
        for (name, tolerance) in tolerances {
            let Some(tolerance) = tolerance else { continue };
            let key = format!(".{name}");
            self.checker.not_negative(&self.key(&key), tolerance)?;
            let counts = match self.shape() {
                Shape::Numbers(_) => self.spec.equals.is_some(),
                Shape::Vectors => name == "abs_tol",
                Shape::Clusters | Shape::Order => false,
            };
            if !counts {
                return self.refuse(&key, "has no effect on this claim");
            }
        }
        Ok(())
    }
}
