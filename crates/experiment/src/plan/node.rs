//! The node of a plan: an oscillator with the function through which it is coupled, read, checked and
//! made into equations that can be evaluated.

use std::fmt;
use std::sync::Arc;

use dynamics::{Coupling, ESCAPE_RADIUS, NodeDynamics, Within};
use equations::{Description, Kind, Mistake, Place, System, Warning as Unused};
use indexmap::IndexMap;
use oscillators::{Equations, EquationsError};
use serde::Serialize;
use user::{Problem, Result, nearest};

use super::checker::Checker;
use crate::spec::{CouplingSpec, FunctionSpec, OscillatorSpec};

/// An oscillator with the function through which it is coupled. What a journal knows it by is what it
/// is made from.
#[derive(Clone, Debug, Serialize)]
pub struct Node {
    /// The oscillator with its parameters.
    pub oscillator: OscillatorSpec,
    /// H(x) = B h(x).
    pub function: Function,
    /// An orbit has escaped when a component exceeds this size.
    pub escape_radius: f64,
    /// What follows from these.
    #[serde(skip)]
    pub equations: msf::Node,
}

/// A coupling function in the words of the file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Function {
    /// One component into the equation of another.
    Pair([String; 2]),
    /// A matrix, row by row.
    Matrix(Vec<Vec<f64>>),
    /// Formulas of the components.
    Formulas {
        /// Of the components that are driven.
        function: IndexMap<String, String>,
        /// Names for parts of them.
        subexpressions: IndexMap<String, String>,
        /// Parameters that the oscillator has not.
        parameters: IndexMap<String, f64>,
    },
}

impl PartialEq for Node {
    fn eq(&self, other: &Self) -> bool {
        self.oscillator == other.oscillator
            && self.function == other.function
            && self.escape_radius == other.escape_radius
    }
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pair([from, to]) => write!(f, "{from} into {to}"),
            Self::Matrix(rows) => write!(f, "the matrix {rows:?}"),
            Self::Formulas { function, .. } => {
                let formulas: Vec<String> =
                    function.iter().map(|(to, formula)| format!("{formula} into {to}")).collect();
                f.write_str(&formulas.join(", "))
            }
        }
    }
}

impl Node {
    /// The oscillator's equations.
    pub fn dynamics(&self) -> &dyn NodeDynamics {
        self.equations.dynamics.as_ref()
    }
}

impl Checker<'_> {
    /// The node, and what in its equations nothing uses.
    pub(super) fn node(&self) -> Result<(Node, Vec<String>)> {
        let oscillator = self.experiment.oscillator.clone();
        let escape_radius = self.experiment.escape_radius;
        self.positive("escape_radius", escape_radius)?;
        let table = match &oscillator {
            OscillatorSpec::Known { name, .. } => format!("oscillator.{name}"),
            OscillatorSpec::Custom(_) => "oscillator.custom.parameters".to_owned(),
        };
        self.parameters(&table, oscillator.parameters())?;
        let (dynamics, mut unused) = self.dynamics(&oscillator)?;
        let dynamics: Arc<dyn NodeDynamics> = if escape_radius == ESCAPE_RADIUS {
            dynamics
        } else {
            Arc::new(Within::new(dynamics, escape_radius))
        };
        let (function, coupling) = self.function(dynamics.as_ref(), &mut unused)?;
        let equations = msf::Node { dynamics, coupling };
        Ok((Node { oscillator, function, escape_radius, equations }, unused))
    }

    fn parameters(&self, table: &str, parameters: &IndexMap<String, f64>) -> Result<()> {
        parameters.iter().try_for_each(|(name, &value)| {
            let key = format!("{table}.{name}");
            match value.is_finite() {
                true => self.parameter_range(&key, value),
                false => Err(self.problem(&key, "must be finite")),
            }
        })
    }

    fn dynamics(
        &self,
        oscillator: &OscillatorSpec,
    ) -> Result<(Arc<dyn NodeDynamics>, Vec<String>)> {
        match oscillator {
            OscillatorSpec::Known { name, parameters } => {
                let dynamics = oscillators::find(name)
                    .map_err(|error| error.to_string())
                    .and_then(|entry| entry.with(parameters).map_err(|error| error.to_string()));
                let key = format!("oscillator.{name}");
                let told = |error| Problem::new(format!("`{key}`: {error}")).in_file(self.file);
                Ok((dynamics.map_err(told)?, Vec::new()))
            }
            OscillatorSpec::Custom(equations) => {
                let failed = |error: EquationsError| self.unreadable(equations, &error);
                let system = equations.system().map_err(failed)?;
                let text = equations.dynamics().map_err(failed)?;
                let key = |Unused::Unused(place): &Unused| {
                    key_of("oscillator.custom", formulas_of(equations), place)
                };
                Ok((Arc::new(text), system.warnings().iter().map(key).collect()))
            }
        }
    }

    fn unreadable(&self, equations: &Equations, error: &EquationsError) -> Problem {
        let table = "oscillator.custom";
        let key = match error {
            EquationsError::Mistake(mistake) => {
                return self.mistake((table, formulas_of(equations)), mistake);
            }
            EquationsError::NoEquations | EquationsError::FlowAndMap => table.to_owned(),
            EquationsError::NoStart { .. } => format!("{table}.start"),
            EquationsError::StartOfNoComponent { name, .. } => format!("{table}.start.{name}"),
            EquationsError::BadStart { component, .. } => format!("{table}.start.{component}"),
        };
        let problem = self.problem_in_text(&key, None, error);
        match error.remedy() {
            Some(remedy) => problem.hint(remedy),
            None => problem,
        }
    }

    /// A mistake in equations, with its place in the file.
    fn mistake(&self, (table, formulas): (&str, &str), mistake: &Mistake) -> Problem {
        let key = key_of(table, formulas, &mistake.place);
        let problem = self.problem_in_text(&key, mistake.at.as_ref(), &mistake.fault);
        match mistake.remedy() {
            Some(remedy) => problem.hint(remedy),
            None => problem,
        }
    }

    fn function(
        &self,
        dynamics: &dyn NodeDynamics,
        unused: &mut Vec<String>,
    ) -> Result<(Function, Coupling)> {
        let spec = &self.experiment.coupling;
        self.one_function(spec)?;
        match (&spec.function, &spec.from, &spec.to) {
            (Some(FunctionSpec::Matrix(rows)), ..) => {
                self.matrix_of(rows, dynamics)?;
                Ok((Function::Matrix(rows.clone()), Coupling::matrix(rows)))
            }
            (Some(FunctionSpec::Formulas(function)), ..) => {
                let system = self.formulas(function, dynamics)?;
                let key = |Unused::Unused(place): &Unused| key_of("coupling", "function", place);
                let is_own = |Unused::Unused(place): &&Unused| match place {
                    Place::Parameter(name) => spec.parameters.contains_key(name),
                    _ => true,
                };
                unused.extend(system.warnings().iter().filter(is_own).map(key));
                let function = Function::Formulas {
                    function: function.clone(),
                    subexpressions: spec.subexpressions.clone(),
                    parameters: spec.parameters.clone(),
                };
                Ok((function, Coupling::formulas(&system)))
            }
            (None, Some(from), Some(to)) => {
                let pair = Coupling::pair(
                    self.component("coupling.from", from, dynamics)?,
                    self.component("coupling.to", to, dynamics)?,
                );
                Ok((Function::Pair([from.clone(), to.clone()]), pair))
            }
            (None, None, _) => Err(self.incomplete("from")),
            (None, _, None) => Err(self.incomplete("to")),
        }
    }

    /// Refuses a coupling function that is given twice, or parts of one that is not there.
    fn one_function(&self, spec: &CouplingSpec) -> Result<()> {
        let pair = [("from", spec.from.is_some()), ("to", spec.to.is_some())];
        if let (Some(_), Some((key, _))) = (&spec.function, pair.iter().find(|(_, given)| *given)) {
            let message = "says again what is coupled: `coupling.function` does";
            return Err(self
                .problem(&format!("coupling.{key}"), message)
                .hint("leave one of them out"));
        }
        let for_formulas = [
            ("where", !spec.subexpressions.is_empty()),
            ("parameters", !spec.parameters.is_empty()),
        ];
        let has_formulas = matches!(spec.function, Some(FunctionSpec::Formulas(_)));
        if let (false, Some((key, _))) =
            (has_formulas, for_formulas.iter().find(|(_, given)| *given))
        {
            let message = "has no effect here: it is for formulas in `coupling.function`";
            return Err(self.problem(&format!("coupling.{key}"), message).hint("leave it out"));
        }
        Ok(())
    }

    fn incomplete(&self, key: &str) -> Problem {
        Problem::new(format!("`coupling.{key}` is missing"))
            .in_file(self.file)
            .hint("name two components, from = \"x\" and to = \"y\", or a function = { y = \"x\" }")
    }

    /// Refuses a matrix of another shape than that of the components.
    fn matrix_of(&self, rows: &[Vec<f64>], dynamics: &dyn NodeDynamics) -> Result<()> {
        let key = "coupling.function";
        let n = dynamics.n_free();
        let names = dynamics.components()[..n].join(", ");
        if rows.len() != n || rows.iter().any(|row| row.len() != n) {
            let lengths: Vec<String> = rows.iter().map(|row| row.len().to_string()).collect();
            let message = format!(
                "is a matrix of {} rows of {} numbers, but must be {n} × {n}: row by row what enters the \
                 equations of {names}",
                rows.len(),
                lengths.join(", ")
            );
            return Err(self.problem(key, message));
        }
        if let Some(weight) = rows.iter().flatten().find(|weight| !weight.is_finite()) {
            return Err(
                self.problem(key, format!("has the entry {weight}, but all must be finite"))
            );
        }
        for &weight in rows.iter().flatten() {
            self.parameter_range(key, weight)?;
        }
        if rows.iter().flatten().all(|&weight| weight == 0.0) {
            return Err(self.problem(key, "is zero, which couples nothing"));
        }
        Ok(())
    }

    fn formulas(
        &self,
        function: &IndexMap<String, String>,
        dynamics: &dyn NodeDynamics,
    ) -> Result<System> {
        let spec = &self.experiment.coupling;
        if function.is_empty() {
            return Err(self.problem("coupling.function", "is empty, which couples nothing"));
        }
        self.parameters("coupling.parameters", &spec.parameters)?;
        let parameters = self.experiment.oscillator.parameters().iter().chain(&spec.parameters);
        let description = Description {
            kind: Kind::Coupling,
            components: dynamics.components()[..dynamics.n_free()].to_vec(),
            equations: pairs(function),
            subexpressions: pairs(&spec.subexpressions),
            parameters: parameters.map(|(name, value)| (name.as_str(), *value)).collect(),
        };
        System::read(&description)
            .map_err(|mistake| self.mistake(("coupling", "function"), &mistake))
    }

    pub(super) fn component(
        &self,
        key: &str,
        name: &str,
        dynamics: &dyn NodeDynamics,
    ) -> Result<usize> {
        let components = &dynamics.components()[..dynamics.n_free()];
        components.iter().position(|component| *component == name).ok_or_else(|| {
            let oscillator = self.experiment.oscillator.name();
            let message = format!(
                "is \"{name}\", but `{oscillator}` has components {}",
                components.join(", ")
            );
            let problem = self.problem(key, message);
            if let Some(near) = nearest(name, components.iter().copied()) {
                return problem.hint(format!("did you mean `{near}`?"));
            }
            let others: Vec<_> = oscillators::library()
                .iter()
                .filter(|other| other.equations.start.contains_key(name))
                .map(|other| format!("`{}` has a component `{name}`", other.name))
                .collect();
            if others.is_empty() { problem } else { problem.hint(others.join("; ")) }
        })
    }
}

fn pairs(texts: &IndexMap<String, String>) -> Vec<(&str, &str)> {
    texts.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect()
}

/// The key of the formulas.
pub(super) fn formulas_of(equations: &Equations) -> &'static str {
    if equations.map.is_some() { "map" } else { "flow" }
}

/// The key of a part of equations.
fn key_of(table: &str, formulas: &str, place: &Place) -> String {
    match place {
        Place::Formula | Place::System => table.to_owned(),
        Place::Component(name) | Place::Equation(name) => format!("{table}.{formulas}.{name}"),
        Place::Subexpression(name) => format!("{table}.where.{name}"),
        Place::Parameter(name) => format!("{table}.parameters.{name}"),
    }
}
