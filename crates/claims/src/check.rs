//! Claims before anything is computed: each names an instance of its quantity that will exist, and
//! states a value of the shape that the quantity has.

use std::fmt::Display;

use eigensync::numbers::plain;
use eigensync::{ALL_PAIRS, Study, misnamed_modes};
use graph::Names;
use serde::de::DeserializeOwned;

use crate::at::At;
use crate::claim::{Claim, Stated};
use crate::name::Name;
use crate::quantity::{Obtained, Quantity, Use};
use crate::spec::{ClaimSpec, OneOrMany};

/// What is wrong with a claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Which of its keys, such as `.where.epsilon`; empty for the claim itself.
    pub key: String,
    /// What is wrong with it, in words that follow the key.
    pub message: String,
    /// The way out, where there is an obvious one.
    pub hint: Option<String>,
}

/// What most checks return.
type Result<T> = std::result::Result<T, Fault>;

/// Checks a claim of this name against the study that it is about. `source` is where the claims of an
/// experiment come from that say nothing else.
///
/// # Errors
/// What is wrong with it.
pub fn check(name: &str, spec: &ClaimSpec, study: &Study, source: &str) -> Result<Claim> {
    let checker = Checker { spec, quantity: spec.of.0, study };
    checker.keys()?;
    let at = checker.at()?;
    let stated = checker.stated(&at)?;
    checker.tolerances()?;
    Ok(Claim {
        name: name.to_owned(),
        of: checker.quantity,
        at,
        stated,
        source: if spec.source.is_empty() { source.to_owned() } else { spec.source.clone() },
        reason: spec.reason.clone(),
        known_difference: spec.known_difference.clone(),
    })
}

fn refuse<T>(key: &str, message: impl Display) -> Result<T> {
    Err(Fault { key: key.to_owned(), message: message.to_string(), hint: None })
}

struct Checker<'a> {
    spec: &'a ClaimSpec,
    quantity: &'static Quantity,
    study: &'a Study,
}

impl Checker<'_> {
    /// The keys of `where` are those that the quantity asks for, and simulations are there.
    fn keys(&self) -> Result<()> {
        let (at, uses) = (&self.spec.at, &self.quantity.uses);
        used("epsilon", uses.epsilon, at.epsilon.is_some())?;
        used("modes", uses.modes, at.modes.is_some())?;
        used("clusters", uses.clusters, at.clusters.is_some())?;
        used("group_prefix", uses.group_prefix, at.group_prefix.is_some())?;
        self.group_prefix()?;
        if self.quantity.of_regions && self.study.regions.is_none() {
            return refuse("", "is about regions, but there is no [regions]");
        }
        match &self.study.sweep {
            _ if !self.quantity.needs_sweep() => Ok(()),
            None => refuse("", "is about simulations, but there is no [sweep]"),
            Some(sweep) if !sweep.observables.pairs => {
                let message = format!(
                    "needs the errors of all pairs of nodes, which are kept for networks of up to \
                     {ALL_PAIRS} nodes"
                );
                refuse("", message)
            }
            Some(_) => Ok(()),
        }
    }

    /// A prefix that begins the name of no group would count no nodes.
    fn group_prefix(&self) -> Result<()> {
        let Some(prefix) = &self.spec.at.group_prefix else { return Ok(()) };
        let groups = self.study.network.groups();
        if groups.iter().any(|group| group.name.starts_with(prefix.as_str())) {
            return Ok(());
        }
        refuse(".where.group_prefix", format!("is \"{prefix}\", with which no group begins"))
    }

    /// Which instance the claim is about.
    fn at(&self) -> Result<At> {
        Ok(At {
            epsilon: self.epsilon()?,
            modes: self.modes()?,
            clusters: self.clusters()?,
            group_prefix: self.spec.at.group_prefix.clone(),
            in_order: self.spec.trend.is_some(),
        })
    }

    fn epsilon(&self) -> Result<Vec<f64>> {
        let Some(epsilon) = &self.spec.at.epsilon else { return Ok(Vec::new()) };
        let key = ".where.epsilon";
        match (epsilon.list().len(), &self.quantity.obtained) {
            (0, _) => return refuse(key, "is empty"),
            (1, _) | (_, Obtained::Numbers(_)) => {}
            _ => return refuse(key, "has several values, but must be one here"),
        }
        epsilon.list().iter().try_for_each(|&epsilon| self.one_epsilon(key, epsilon))?;
        Ok(epsilon.list().to_vec())
    }

    fn one_epsilon(&self, key: &str, epsilon: f64) -> Result<()> {
        if !(epsilon.is_finite() && epsilon > 0.0) {
            let value = plain(epsilon);
            return refuse(key, format!("is {value}, but must be finite and above zero"));
        }
        let Some(sweep) = self.study.sweep.as_ref().filter(|_| self.quantity.needs_sweep()) else {
            return Ok(());
        };
        if sweep.epsilon.contains(&epsilon) {
            return Ok(());
        }
        Err(Fault {
            key: key.to_owned(),
            message: format!("is {}, which is not a point of `sweep.epsilon`", plain(epsilon)),
            hint: sweep
                .nearest(epsilon)
                .map(|near| format!("the nearest point is {}", plain(near))),
        })
    }

    fn modes(&self) -> Result<Option<Vec<usize>>> {
        let Some(modes) = &self.spec.at.modes else { return Ok(None) };
        let most = self.study.modes.most_modes(self.study.network.n_nodes());
        let key = ".where.modes";
        if modes.is_empty() {
            return refuse(key, "is empty");
        }
        match misnamed_modes(modes, most) {
            None => Ok(Some(modes.clone())),
            Some(message) => refuse(key, message),
        }
    }

    fn clusters(&self) -> Result<Vec<Vec<usize>>> {
        match &self.spec.at.clusters {
            None => Ok(Vec::new()),
            Some(clusters) if clusters.is_empty() => refuse(".where.clusters", "is empty"),
            Some(clusters) => self.nodes(".where.clusters", clusters),
        }
    }

    fn nodes(&self, key: &str, clusters: &[Vec<Name>]) -> Result<Vec<Vec<usize>>> {
        Names::of(&self.study.network).clusters(clusters).map_err(|error| Fault {
            key: key.to_owned(),
            hint: error.hint(),
            message: error.to_string(),
        })
    }

    /// Exactly one of `equals`, `at_most`, `at_least` and `trend`, of the quantity's shape.
    fn stated(&self, at: &At) -> Result<Stated> {
        let spec = self.spec;
        let stated = [
            spec.equals.is_some(),
            spec.at_most.is_some(),
            spec.at_least.is_some(),
            spec.trend.is_some(),
        ];
        if stated.iter().filter(|given| **given).count() != 1 {
            let message = "must have exactly one of `equals`, `at_most`, `at_least`, `trend`";
            return refuse("", message);
        }
        if let Some(trend) = spec.trend {
            return match self.count(at) {
                Some(count) if count > 1 => Ok(Stated::Trend(trend)),
                // How many eigenvalues there are is known only of all of them together.
                None if self.is_of_numbers() && self.study.network.n_nodes() > 1 => {
                    Ok(Stated::Trend(trend))
                }
                _ => refuse(".trend", "needs two numbers or more to compare"),
            };
        }
        if let Some(bound) = spec.at_most.or(spec.at_least) {
            return match self.is_of_numbers() {
                true if bound.is_finite() && spec.at_most.is_some() => Ok(Stated::AtMost(bound)),
                true if bound.is_finite() => Ok(Stated::AtLeast(bound)),
                true => refuse("", "has a bound that is not finite"),
                false => refuse("", "is about no number, so that it needs `equals`"),
            };
        }
        match self.quantity.obtained {
            Obtained::Numbers(_) | Obtained::List(_) => self.numbers(at),
            Obtained::Vectors(_) => self.vectors(at),
            Obtained::Clusters(_) => {
                let clusters: Vec<Vec<Name>> =
                    self.equals("a list of clusters, such as [[1, 2], [3, 4]]")?;
                let nodes = self.nodes(".equals", &clusters)?;
                let names = |cluster: Vec<Name>| cluster.into_iter().map(|name| name.0).collect();
                Ok(Stated::Clusters { named: clusters.into_iter().map(names).collect(), nodes })
            }
            Obtained::Losses { .. } => self.order(at),
        }
    }

    fn is_of_numbers(&self) -> bool {
        matches!(self.quantity.obtained, Obtained::Numbers(_) | Obtained::List(_))
    }

    fn is_of_a_list(&self) -> bool {
        matches!(self.quantity.obtained, Obtained::List(_))
    }

    /// How many numbers the quantity has, where that is known.
    fn count(&self, at: &At) -> Option<usize> {
        match (&self.quantity.obtained, &at.modes, self.quantity.uses.modes) {
            (Obtained::Numbers(_), Some(modes), _) => Some(modes.len()),
            (Obtained::Numbers(_), None, Use::Meaningless) => Some(at.epsilon.len().max(1)),
            _ => None,
        }
    }

    fn equals<T: DeserializeOwned>(&self, expected: &str) -> Result<T> {
        let read = self.spec.equals.clone().and_then(|value| value.try_into().ok());
        read.map_or_else(|| refuse(".equals", format!("must be {expected}")), Ok)
    }

    fn numbers(&self, at: &At) -> Result<Stated> {
        let numbers: OneOrMany = self.equals("a number or a list of numbers")?;
        let values = numbers.list().to_vec();
        if let Some(number) = values.iter().find(|number| !number.is_finite()) {
            return refuse(".equals", format!("contains {number}, but must be finite"));
        }
        match self.count(at) {
            None if values.is_empty() && !self.is_of_a_list() => {
                return refuse(".equals", "is an empty list");
            }
            Some(count) if count != values.len() => {
                let message = format!("has {} values, expected {count}", values.len());
                return refuse(".equals", message);
            }
            _ => {}
        }
        let [abs_tol, rel_tol] =
            [self.spec.abs_tol, self.spec.rel_tol].map(Option::unwrap_or_default);
        Ok(Stated::Numbers { values, abs_tol, rel_tol })
    }

    fn vectors(&self, at: &At) -> Result<Stated> {
        let vectors: Vec<Vec<f64>> = self.equals("a list of vectors")?;
        let modes = at.modes.as_ref().map_or(0, Vec::len);
        let n_nodes = self.study.network.n_nodes();
        if vectors.len() != modes || vectors.iter().any(|vector| vector.len() != n_nodes) {
            let message = format!("must be {modes} vectors of {n_nodes} components each");
            return refuse(".equals", message);
        }
        if vectors.iter().flatten().any(|component| !component.is_finite()) {
            return refuse(".equals", "has a component that is not finite");
        }
        if vectors.iter().any(|vector| vector.iter().all(|&component| component == 0.0)) {
            return refuse(".equals", "has a vector of zeros, which has no direction");
        }
        Ok(Stated::Vectors { vectors, abs_tol: self.spec.abs_tol.unwrap_or_default() })
    }

    fn order(&self, at: &At) -> Result<Stated> {
        let order: Vec<usize> = self.equals("a list of positions, such as [2, 1, 3]")?;
        let count = at.clusters.len();
        if count < 2 {
            return refuse(".where.clusters", "has one cluster, but an order needs two or more");
        }
        let mut positions = order.clone();
        positions.sort_unstable();
        if positions.into_iter().eq(1..=count) {
            return Ok(Stated::Order(order));
        }
        refuse(".equals", format!("must have each of the positions 1 to {count} once"))
    }

    fn tolerances(&self) -> Result<()> {
        let tolerances = [("abs_tol", self.spec.abs_tol), ("rel_tol", self.spec.rel_tol)];
        for (name, tolerance) in tolerances {
            let Some(tolerance) = tolerance else { continue };
            let key = format!(".{name}");
            if !(tolerance.is_finite() && tolerance >= 0.0) {
                let value = plain(tolerance);
                return refuse(&key, format!("is {value}, but must be finite and not negative"));
            }
            let counts = match self.quantity.obtained {
                Obtained::Numbers(_) | Obtained::List(_) => self.spec.equals.is_some(),
                Obtained::Vectors(_) => name == "abs_tol",
                Obtained::Clusters(_) | Obtained::Losses { .. } => false,
            };
            if !counts {
                return refuse(&key, "has no effect on this claim");
            }
        }
        Ok(())
    }
}

fn used(key: &str, used: Use, given: bool) -> Result<()> {
    match (used, given) {
        (Use::Needed, false) => refuse("", format!("needs `where.{key}`")),
        (Use::Meaningless, true) => {
            refuse(&format!(".where.{key}"), "means nothing for this quantity")
        }
        _ => Ok(()),
    }
}
