//! Equations of an oscillator as they are written in an experiment file, under `oscillator.custom`, and
//! in the files of the library.

use std::fmt;

use dynamics::Text;
use equations::{Description, Kind, System, nearest};
use indexmap::IndexMap;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

use crate::EquationsError;

/// Names with their formulas, in the order in which they are written.
type Formulas = IndexMap<String, String>;

/// The equations of an oscillator as text; their order is that of the components.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Equations {
    /// Rates of change of the components; these, or `map`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow: Option<Formulas>,
    /// What the components are next.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<Formulas>,
    /// Names for parts of formulas.
    #[serde(rename = "where", default, skip_serializing_if = "IndexMap::is_empty")]
    pub subexpressions: Formulas,
    /// Parameters with their values.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub parameters: IndexMap<String, f64>,
    /// A box `[from, to]` for each component, from which initial states are drawn uniformly.
    #[serde(deserialize_with = "intervals")]
    pub start: IndexMap<String, [f64; 2]>,
}

/// Intervals of two numbers, no more: what is beyond the second would else be passed over.
fn intervals<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<IndexMap<String, [f64; 2]>, D::Error> {
    struct Interval([f64; 2]);
    impl<'de> Deserialize<'de> for Interval {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            match Vec::deserialize(deserializer)?[..] {
                [from, to] => Ok(Self([from, to])),
                ref ends => Err(D::Error::invalid_length(ends.len(), &"an array of length 2")),
            }
        }
    }
    let given = IndexMap::<String, Interval>::deserialize(deserializer)?;
    Ok(given.into_iter().map(|(name, Interval(ends))| (name, ends)).collect())
}

impl Equations {
    /// The equations, read and resolved.
    ///
    /// # Errors
    /// [`EquationsError::NoEquations`], [`EquationsError::FlowAndMap`], or a mistake in what is written.
    pub fn system(&self) -> Result<System, EquationsError> {
        let (kind, formulas) = self.formulas()?;
        let description = Description {
            kind,
            components: formulas.keys().map(String::as_str).collect(),
            equations: pairs(formulas),
            subexpressions: pairs(&self.subexpressions),
            parameters: self.parameters.iter().map(|(name, &v)| (name.as_str(), v)).collect(),
        };
        Ok(System::read(&description)?)
    }

    /// The equations as node dynamics.
    ///
    /// # Errors
    /// As [`Self::system`], and when an initial state cannot be drawn for every component.
    pub fn dynamics(&self) -> Result<Text, EquationsError> {
        let system = self.system()?;
        let start = self.start_of(&system)?;
        Ok(Text::new(&system, start))
    }

    fn formulas(&self) -> Result<(Kind, &Formulas), EquationsError> {
        match (&self.flow, &self.map) {
            (Some(flow), None) => Ok((Kind::Flow, flow)),
            (None, Some(map)) => Ok((Kind::Map, map)),
            (None, None) => Err(EquationsError::NoEquations),
            (Some(_), Some(_)) => Err(EquationsError::FlowAndMap),
        }
    }

    /// Intervals in the order of the components.
    fn start_of(&self, system: &System) -> Result<Vec<[f64; 2]>, EquationsError> {
        let known: Vec<&str> = system.components().collect();
        if let Some(name) = self.start.keys().find(|name| !known.contains(&name.as_str())) {
            let nearest = nearest(name, known.iter().copied());
            let known = known.into_iter().map(ToOwned::to_owned).collect();
            return Err(EquationsError::StartOfNoComponent { name: name.clone(), nearest, known });
        }
        let interval = |component: &str| {
            let component = component.to_owned();
            let Some(&[from, to]) = self.start.get(&component) else {
                return Err(EquationsError::NoStart { component });
            };
            // States are drawn by the width, which is not finite where an end is not.
            if from > to || !(to - from).is_finite() {
                return Err(EquationsError::BadStart { component, from, to });
            }
            Ok([from, to])
        };
        known.into_iter().map(interval).collect()
    }
}

fn pairs(formulas: &Formulas) -> Vec<(&str, &str)> {
    formulas.iter().map(|(name, formula)| (name.as_str(), formula.as_str())).collect()
}

/// The same text: order counts, as it is that of the components.
impl PartialEq for Equations {
    fn eq(&self, other: &Self) -> bool {
        let formulas = |Self { flow, map, .. }: &Self| {
            [flow, map].map(|formulas| formulas.clone().map(Vec::from_iter))
        };
        formulas(self) == formulas(other)
            && self.subexpressions.as_slice() == other.subexpressions.as_slice()
            && self.parameters.as_slice() == other.parameters.as_slice()
            && self.start.as_slice() == other.start.as_slice()
    }
}

/// A line for each equation, subexpression, parameter and interval.
impl fmt::Display for Equations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (component, formula) in self.flow.iter().flatten() {
            writeln!(f, "d{component}/dt = {formula}")?;
        }
        for (component, formula) in self.map.iter().flatten() {
            writeln!(f, "{component}' = {formula}")?;
        }
        for (name, formula) in &self.subexpressions {
            writeln!(f, "where {name} = {formula}")?;
        }
        for (name, value) in &self.parameters {
            writeln!(f, "with {name} = {value}")?;
        }
        for (component, [from, to]) in &self.start {
            writeln!(f, "from {component} in [{from}, {to}]")?;
        }
        Ok(())
    }
}
