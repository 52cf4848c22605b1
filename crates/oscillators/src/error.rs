//! What can be wrong with an oscillator that is given as text, or with what is asked of the library.

use equations::Mistake;
use thiserror::Error;

/// Why equations as text are not those of an oscillator.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EquationsError {
    /// No equations.
    #[error("neither `flow` nor `map` is given, of which one has to be")]
    NoEquations,
    /// Equations of two kinds.
    #[error("both `flow` and `map` are given, of which one may be")]
    FlowAndMap,
    /// A mistake in names, formulas or parameters.
    #[error(transparent)]
    Mistake(#[from] Mistake),
    /// A component that begins nowhere.
    #[error("component `{component}` has no interval in `start`")]
    NoStart {
        /// The component.
        component: String,
    },
    /// An interval of what is no component.
    #[error("`start` names `{name}`, but the components are {}", known.join(", "))]
    StartOfNoComponent {
        /// The name.
        name: String,
        /// The nearest component.
        nearest: Option<String>,
        /// All components.
        known: Vec<String>,
    },
    /// An interval from which no number can be drawn.
    #[error("`start` of `{component}` is [{from}, {to}]; expected two finite numbers in order")]
    BadStart {
        /// The component.
        component: String,
        /// Where the interval begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
}

impl EquationsError {
    /// The way out, where there is one to name.
    pub fn remedy(&self) -> Option<String> {
        match self {
            Self::NoEquations => Some("write flow = { x = \"…\" }".into()),
            Self::FlowAndMap => Some("flow is for rates, map for the next state".into()),
            Self::Mistake(mistake) => mistake.remedy(),
            Self::NoStart { component } => {
                Some(format!("give it one, such as {component} = [-1, 1]"))
            }
            Self::StartOfNoComponent { name, .. } if name == "t" => {
                Some("time begins at 0; a phase can be a parameter".into())
            }
            Self::StartOfNoComponent { nearest, .. } => {
                nearest.as_ref().map(|name| format!("`{name}`?"))
            }
            Self::BadStart { from, to, .. } if from > to => Some("exchange them".into()),
            Self::BadStart { .. } => None,
        }
    }
}

/// A name that no oscillator of the library has.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("there is no oscillator `{name}`; there are {}", known.join(", "))]
pub struct NoSuchOscillator {
    /// The name.
    pub name: String,
    /// The nearest known one.
    pub nearest: Option<String>,
    /// All that there are.
    pub known: Vec<&'static str>,
}

/// Why an oscillator cannot have a parameter or its value.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ParameterError {
    /// A parameter that it has not.
    #[error(
        "`{oscillator}` has no parameter `{name}`; {}",
        if known.is_empty() { "it has none".into() } else { format!("it has {}", known.join(", ")) }
    )]
    Unknown {
        /// The oscillator.
        oscillator: &'static str,
        /// The name.
        name: String,
        /// Its nearest parameter.
        nearest: Option<String>,
        /// All its parameters.
        known: Vec<String>,
    },
    /// A value that is not finite.
    #[error("parameter `{name}` of `{oscillator}` is {value}; expected a finite number")]
    NotFinite {
        /// The oscillator.
        oscillator: &'static str,
        /// The parameter.
        name: String,
        /// Its value.
        value: f64,
    },
}
