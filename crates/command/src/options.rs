//! Oscillators and couplings as options name them, and the experiment file that says the same.

use std::path::Path;

use toml::{Table, Value};

use experiment::{Node, load};
use user::text::shown;
use user::{Problem, Result, nearest};

/// An oscillator and its coupling on the command line.
#[derive(clap::Args)]
pub struct NodeArgs {
    /// Oscillator at every node, with parameters that are not the default ones: `lorenz`,
    /// `hindmarsh_rose:current=3.1`; `eigensync oscillators` lists them. Or a TOML file with an
    /// oscillator of your own, as `[oscillator.custom]` of an experiment: `mine.toml`
    #[arg(long, value_name = "NAME[:P=X,…]")]
    pub oscillator: String,
    /// Component of the driving node, and the component whose equation it enters: `x:y`. Or formulas of
    /// what enters which equation: `x=x,y=tanh(y)`
    #[arg(long, value_name = "FROM:TO")]
    pub coupling: String,
}

/// The same in the words of experiment files, checked.
pub struct NodeTables {
    /// `[oscillator.NAME]`.
    pub oscillator: Value,
    /// The coupling function in `[coupling]`.
    pub function: Table,
    /// What they make.
    pub node: Node,
}

impl NodeArgs {
    /// The tables of an experiment file, checked.
    pub fn tables(&self) -> Result<NodeTables> {
        let own = self.oscillator.ends_with(".toml").then(|| own(Path::new(&self.oscillator)));
        let (oscillator, file) = match own.transpose()? {
            Some((table, text)) => (table, Some(text)),
            None => (known(&self.oscillator)?, None),
        };
        let function = function(&self.coupling)?;
        let document = Table::from_iter([
            ("oscillator".to_owned(), oscillator.clone()),
            ("coupling".to_owned(), function.clone().into()),
        ]);
        let options = Path::new("the options");
        let origin = match &file {
            Some(text) => (Path::new(&self.oscillator), text.as_str()),
            None => (options, ""),
        };
        let node = experiment::node_of(&document, origin)?;
        Ok(NodeTables { oscillator, function, node })
    }
}

impl NodeTables {
    /// `[coupling]` with a coupling matrix.
    pub fn coupling(&self, matrix: &str) -> Value {
        let mut coupling = Table::from_iter([("matrix".to_owned(), matrix.into())]);
        coupling.extend(self.function.clone());
        coupling.into()
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

/// The table `[oscillator.…]` of a file, or the file as `[oscillator.custom]`, with its text.
fn own(file: &Path) -> Result<(Value, String)> {
    let text = load::text(file)?;
    let spec = load::oscillator(&text, file)?;
    let table = Value::try_from(&spec)
        .map_err(|error| Problem::from_error("cannot be written as TOML", error).in_file(file))?;
    Ok((table, text))
}

/// `NAME` or `NAME:PARAMETER=VALUE,…` as the table `[oscillator.NAME]`.
fn known(text: &str) -> Result<Value> {
    let (name, parameters) = text.split_once(':').unwrap_or((text, ""));
    let library = oscillators::library();
    let Some(entry) = library.iter().find(|entry| entry.name == name) else {
        let hint = hint(name, library.iter().map(|entry| entry.name));
        return Err(Problem::new(format!("there is no oscillator `{name}`")).hint(hint));
    };
    let mut values = Table::new();
    for given in parameters.split(',').filter(|given| !given.is_empty()) {
        let value = given.split_once('=').and_then(|(key, value)| {
            let value = value.trim().parse::<f64>().ok()?;
            Some((key.trim().to_owned(), value))
        });
        // With larger ones orbits leave the bounds within which they count as finite.
        let Some((key, value)) = value.filter(|(_, value)| value.abs() <= 1e6) else {
            let message = format!(
                "`--oscillator {text}`: `{given}` is no parameter, expected one such as r=35, of a \
                 size up to 1e6"
            );
            return Err(Problem::new(message));
        };
        if !entry.equations.parameters.contains_key(&key) {
            let known = entry.equations.parameters.keys().map(String::as_str);
            let each: Vec<String> = known.clone().map(|known| format!("`{known}`")).collect();
            let message = format!(
                "`--oscillator {text}`: `{name}` has no parameter `{key}`; it has {}",
                each.join(", ")
            );
            return Err(Problem::new(message).hint(hint(&key, known)));
        }
        if values.insert(key.clone(), value.into()).is_some() {
            return Err(Problem::new(format!("`--oscillator {text}`: `{key}` is given twice")));
        }
    }
    Ok(table([(name, values.into())]))
}

/// The known name that may have been meant, or all of them.
fn hint<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    match nearest(name, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("known here: {}", known.collect::<Vec<_>>().join(", ")),
    }
}

/// `FROM:TO`, or `COMPONENT=FORMULA,…`, as entries of `[coupling]`.
fn function(text: &str) -> Result<Table> {
    if let Some((from, to)) = text.split_once(':') {
        let entries = [("from", from), ("to", to)];
        return Ok(entries.map(|(key, name)| (key.to_owned(), name.into())).into_iter().collect());
    }
    let formula = |entry: &str| {
        let (component, formula) = entry.split_once('=')?;
        Some((component.trim().to_owned(), formula.trim().into()))
    };
    let formulas: Option<Vec<(String, Value)>> = apart(text).into_iter().map(formula).collect();
    let formulas = formulas.ok_or_else(|| {
        let message = format!(
            "`--coupling {}` must be two components, such as x:y, or formulas, such as y=tanh(x)",
            shown(text)
        );
        Problem::new(message)
    })?;
    let mut function = Table::new();
    for (component, formula) in formulas {
        if function.insert(component.clone(), formula).is_some() {
            let message = format!("`--coupling {}`: `{component}` is given twice", shown(text));
            return Err(Problem::new(message));
        }
    }
    Ok(Table::from_iter([("function".to_owned(), function.into())]))
}

/// Cut at the commas outside of parentheses.
fn apart(text: &str) -> Vec<&str> {
    let mut depth = 0;
    text.split(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        c == ',' && depth == 0
    })
    .collect()
}
