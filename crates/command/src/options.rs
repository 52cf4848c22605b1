//! Oscillators and couplings as options name them, and the experiment file that says the same.

use dynamics::lyapunov::Times;
use dynamics::{Model, NodeDynamics};
use toml::{Table, Value};

use experiment::Node;
use journal::Journal;
use runner::computed;
use user::{Problem, Result, Stages, nearest};

/// Points of the curve Λ(σ).
pub const SIGMA_POINTS: i64 = 65;
/// Times of the first look at Λ, which finds how far the curve must reach.
const FIRST_LOOK: Times = Times { step: 0.01, transient: 500.0, average: 4000.0, renormalise: 0.5 };

/// An oscillator and its coupling on the command line.
#[derive(clap::Args)]
pub struct NodeArgs {
    /// Oscillator at every node, with parameters that are not the default ones: `lorenz`,
    /// `hindmarsh_rose:current=3.1`
    #[arg(long, value_name = "NAME[:P=X,…]")]
    pub oscillator: String,
    /// Component of the driving node, and the component whose equation it enters: `x:y`
    #[arg(long, value_name = "FROM:TO")]
    pub coupling: String,
}

impl NodeArgs {
    /// The table `[oscillator.NAME]` and the components that are coupled, checked.
    pub fn tables(&self) -> Result<(Value, [&str; 2])> {
        let (oscillator, model) = oscillator(&self.oscillator)?;
        let (from, to) = self.components()?;
        coupling(model, (from, to))?;
        Ok((oscillator, [from, to]))
    }

    /// How far the curve of Λ must reach, by a first look.
    pub fn reach(&self, stages: &Stages, journal: &Journal) -> Result<f64> {
        let (_, model) = oscillator(&self.oscillator)?;
        let node = Node { model, coupling: coupling(model, self.components()?)? };
        computed::reach(&node, &FIRST_LOOK, stages, journal)
            .map_err(|error| Problem::from_error("the master stability function", error))
    }

    /// The components that `--coupling` names.
    fn components(&self) -> Result<(&str, &str)> {
        self.coupling.split_once(':').ok_or_else(|| {
            let message =
                format!("`--coupling {}` must be two components, such as x:y", self.coupling);
            let hint =
                oscillator(&self.oscillator).map_or_else(|_| String::new(), |(_, m)| components(m));
            Problem::new(message).hint(hint)
        })
    }
}

/// A table of these entries.
pub fn table<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Table(entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}

/// An experiment file.
pub fn text(document: &Table) -> Result<String> {
    toml::to_string_pretty(document)
        .map_err(|error| Problem::from_error("the options cannot be written as TOML", error))
}

/// `NAME` or `NAME:PARAMETER=VALUE,…` as the table `[oscillator.NAME]`.
fn oscillator(text: &str) -> Result<(Value, Model)> {
    let (name, parameters) = text.split_once(':').unwrap_or((text, ""));
    let known: Vec<&str> = Model::all().iter().map(Model::name).collect();
    if !known.contains(&name) {
        let hint = match nearest(name, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("known here: {}", known.join(", ")),
        };
        return Err(Problem::new(format!("there is no oscillator `{name}`")).hint(hint));
    }
    let mut values = Table::new();
    for entry in parameters.split(',').filter(|entry| !entry.is_empty()) {
        let value = entry.split_once('=').and_then(|(key, value)| {
            let value = value.trim().parse::<f64>().ok()?;
            Some((key.trim().to_owned(), value))
        });
        // With larger ones orbits leave the bounds within which they count as finite.
        let Some((key, value)) = value.filter(|(_, value)| value.abs() <= 1e6) else {
            let message = format!(
                "`--oscillator {text}`: `{entry}` is no parameter, expected one such as r=35, of a \
                 size up to 1e6"
            );
            return Err(Problem::new(message));
        };
        values.insert(key, value.into());
    }
    let value = table([(name, values.into())]);
    let model = value.clone().try_into().map_err(|error: toml::de::Error| {
        Problem::new(format!("`--oscillator {text}`: {}", error.message().trim_end()))
    })?;
    Ok((value, model))
}

fn components(model: Model) -> String {
    format!("`{}` has components {}", model.name(), model.components().join(", "))
}

fn coupling(model: Model, (from, to): (&str, &str)) -> Result<dynamics::Coupling> {
    let component = |name: &str| {
        model.components().iter().position(|known| *known == name).ok_or_else(|| {
            Problem::new(format!("`--coupling` names the component \"{name}\""))
                .hint(components(model))
        })
    };
    Ok(dynamics::Coupling::pair(component(from)?, component(to)?))
}
