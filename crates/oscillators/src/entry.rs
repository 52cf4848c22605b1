//! An oscillator of the library: its equations, where they come from, and what is known of them.

use std::fmt;
use std::sync::Arc;

use dynamics::{Model, NodeDynamics};
use equations::nearest;
use indexmap::IndexMap;
use serde::Deserialize;

use crate::{Equations, ParameterError};

/// An oscillator of the library.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its name in experiment files, which is that of its file.
    pub name: &'static str,
    /// What it is.
    pub title: String,
    /// Who wrote it down, and where.
    pub source: String,
    /// What parameters mean, and what else one should know.
    pub note: Option<String>,
    /// What it does with the parameters given here.
    pub behaviour: Behaviour,
    /// A step that RK4 follows it well with; 1 for a map.
    pub step: f64,
    /// Its equations, with parameters that are in use.
    pub equations: Equations,
    /// Numbers that others have found.
    pub published: Vec<Published>,
}

/// What an oscillator does, once it has settled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Behaviour {
    /// Its largest Lyapunov exponent is above zero.
    Chaotic,
    /// It goes round a limit cycle.
    Periodic,
}

/// What the equations of an oscillator are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Rates of change that depend on the state alone.
    Flow,
    /// Rates of change that depend on time as well.
    Forced,
    /// The next state.
    Map,
}

/// Lyapunov exponents that somebody published or that are known in closed form.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Published {
    /// Where they stand.
    pub source: String,
    /// Parameters that differ from the defaults.
    #[serde(default)]
    pub parameters: IndexMap<String, f64>,
    /// All exponents, descending, per unit of time; those of a forced flow with the 0 of time.
    pub exponents: Vec<f64>,
    /// Decimal places to which they are known.
    pub digits: i32,
    /// Time over which one has to average to see them.
    pub average: f64,
}

impl Entry {
    /// What its equations are.
    pub fn kind(&self) -> Kind {
        let has_time = || self.equations.system().is_ok_and(|system| system.has_time());
        match &self.equations.map {
            Some(_) => Kind::Map,
            None if has_time() => Kind::Forced,
            None => Kind::Flow,
        }
    }

    /// The same oscillator in Rust, with its own defaults, where there is one.
    pub fn compiled(&self) -> Option<Model> {
        Model::all().into_iter().find(|model| model.name() == self.name)
    }

    /// Its node dynamics with some parameters other than the defaults: compiled equations where there
    /// are, and text with the same bits elsewhere.
    ///
    /// # Errors
    /// As [`Self::equations_with`].
    pub fn with(
        &self,
        overrides: &IndexMap<String, f64>,
    ) -> Result<Arc<dyn NodeDynamics>, ParameterError> {
        let equations = self.equations_with(overrides)?;
        if self.compiled().is_some() {
            return Ok(Arc::new(model(self.name, &equations.parameters)));
        }
        Ok(Arc::new(equations.dynamics().expect("the library was read, and values are finite")))
    }

    /// Its equations with some parameters other than the defaults.
    ///
    /// # Errors
    /// [`ParameterError`] when it has no such parameter, or when a value is not finite.
    pub fn equations_with(
        &self,
        overrides: &IndexMap<String, f64>,
    ) -> Result<Equations, ParameterError> {
        let mut equations = self.equations.clone();
        for (name, &value) in overrides {
            let (oscillator, name) = (self.name, name.clone());
            if !value.is_finite() {
                return Err(ParameterError::NotFinite { oscillator, name, value });
            }
            let Some(parameter) = equations.parameters.get_mut(&name) else {
                let known: Vec<String> = self.equations.parameters.keys().cloned().collect();
                let nearest = nearest(&name, known.iter().map(String::as_str));
                return Err(ParameterError::Unknown { oscillator, name, nearest, known });
            };
            *parameter = value;
        }
        Ok(equations)
    }
}

/// A compiled oscillator with given values of all its parameters.
fn model(name: &str, parameters: &IndexMap<String, f64>) -> Model {
    let parameters: toml::Table =
        parameters.iter().map(|(name, &value)| (name.clone(), value.into())).collect();
    let model = toml::Table::from_iter([(name.to_owned(), parameters.into())]);
    model.try_into().expect("a compiled oscillator has the parameters of its text")
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Flow => "flow",
            Self::Forced => "forced flow",
            Self::Map => "map",
        })
    }
}

impl fmt::Display for Behaviour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Chaotic => "chaotic",
            Self::Periodic => "periodic",
        })
    }
}
