//! What can be wrong with equations: where, what was found, what was expected, and the way out.

use std::fmt;
use std::ops::Range;

/// A mistake in equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistake {
    /// Whose text or name it is about.
    pub place: Place,
    /// Bytes of the formula's text at fault; none when the fault is not one of a text.
    pub at: Option<Range<usize>>,
    /// What is wrong.
    pub fault: Fault,
}

/// A part of a system.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A formula by itself.
    Formula,
    /// The system as a whole.
    System,
    /// A component.
    Component(String),
    /// The equation of a component.
    Equation(String),
    /// A named subexpression.
    Subexpression(String),
    /// A parameter.
    Parameter(String),
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// Nothing is written.
    Empty,
    /// The text is too long, or all texts of a system together are.
    TooLong {
        /// Its length.
        bytes: usize,
        /// What may be.
        limit: usize,
    },
    /// Parentheses, signs or powers are nested too deeply.
    TooDeep {
        /// What may be.
        limit: usize,
    },
    /// A character that means nothing in a formula.
    Character {
        /// What stands there, or how much.
        found: char,
    },
    /// A sign of another language or of typeset text.
    Foreign {
        /// The sign.
        sign: &'static str,
        /// What it is called.
        what: &'static str,
        /// What is written here.
        instead: &'static str,
    },
    /// A power above the line.
    Superscript {
        /// What is written here.
        instead: String,
    },
    /// A number beyond the range of doubles.
    TooLarge,
    /// A number that doubles cannot tell from zero.
    TooSmall,
    /// A number with two decimal points.
    TwoPoints,
    /// Something stands where something else has to.
    Expected {
        /// What stands there, or how much.
        found: String,
        /// What has to stand there, or how much.
        expected: &'static str,
    },
    /// Two values with no sign between them.
    NoOperator {
        /// What stands there, or how much.
        found: String,
    },
    /// A parenthesis is not closed.
    Unclosed {
        /// The byte at which it was opened.
        opened: usize,
    },
    /// A parenthesis that none opens.
    Unopened,
    /// A comma outside of a function.
    Comma {
        /// Whether it stands between digits.
        decimal: bool,
    },
    /// A comparison of a comparison, as in a < b < c.
    Chained,
    /// A condition where a number has to be.
    Condition,
    /// A number where a condition has to be.
    Number,
    /// A function with too few or too many arguments.
    Arguments {
        /// The name of the function.
        function: String,
        /// What stands there, or how much.
        found: usize,
        /// What has to stand there, or how much.
        expected: usize,
    },
    /// A function that is not called.
    NotCalled {
        /// The name of the function.
        function: String,
    },
    /// A function that does not exist.
    UnknownFunction {
        /// The name.
        name: String,
        /// The nearest known one.
        nearest: Option<String>,
    },
    /// A name that means nothing.
    UnknownName {
        /// The name.
        name: String,
        /// The nearest known one.
        nearest: Option<String>,
        /// All that there are.
        known: Box<[String]>,
    },
    /// Time where there is none.
    Time,
    /// Subexpressions that are made of each other; the first name comes again at the end.
    Cycle {
        /// Their names, in the order of use.
        names: Vec<String>,
    },
    /// No components.
    NoComponents,
    /// More components than there may be.
    TooManyComponents {
        /// What stands there, or how much.
        found: usize,
        /// What may be.
        limit: usize,
    },
    /// More subexpressions or parameters than there may be.
    TooManyNames {
        /// What stands there, or how much.
        found: usize,
        /// What may be.
        limit: usize,
    },
    /// A component that has no equation.
    NoEquation,
    /// An equation of what is no component.
    NoComponent {
        /// The nearest known one.
        nearest: Option<String>,
        /// All that there are.
        known: Box<[String]>,
    },
    /// A name that is used before, and for what.
    Twice {
        /// What has it already.
        before: Place,
    },
    /// A name that has a meaning of its own.
    Reserved,
    /// What cannot be a name.
    NoName,
    /// A parameter that is no number.
    NotFinite {
        /// The value.
        value: f64,
    },
}

impl Mistake {
    /// The way out, where there is one to name.
    pub fn remedy(&self) -> Option<String> {
        self.fault.remedy()
    }
}

impl std::error::Error for Mistake {}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.place {
            Place::Formula | Place::System => {}
            place => write!(f, "{place}: ")?,
        }
        write!(f, "{}", self.fault)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Formula => write!(f, "the formula"),
            Self::System => write!(f, "the system"),
            Self::Component(name) => write!(f, "component `{}`", shown(name)),
            Self::Equation(name) => write!(f, "equation of `{}`", shown(name)),
            Self::Subexpression(name) => write!(f, "subexpression `{}`", shown(name)),
            Self::Parameter(name) => write!(f, "parameter `{}`", shown(name)),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "nothing is written where a formula has to be"),
            Self::TooLong { bytes, limit } => {
                write!(f, "{bytes} bytes are written, but at most {limit} are read")
            }
            Self::TooDeep { limit } => {
                write!(f, "parentheses, signs and powers are nested more than {limit} deep")
            }
            Self::Character { found } => {
                write!(f, "{} (U+{:04X}) means nothing in a formula", quoted(*found), *found as u32)
            }
            Self::Foreign { what, .. } => write!(f, "{what} means nothing in a formula"),
            Self::Superscript { .. } => write!(f, "a power is not written above the line"),
            Self::TooLarge => write!(f, "the number is beyond the largest double, 1.8e308"),
            Self::TooSmall => write!(f, "the number is below the smallest double, 4.9e-324"),
            Self::TwoPoints => write!(f, "the number has two decimal points"),
            Self::Expected { found, expected } => {
                write!(f, "found {}, but expected {expected}", shown(found))
            }
            Self::NoOperator { found } => {
                write!(f, "no sign before {}, which begins a second value", shown(found))
            }
            Self::Unclosed { opened } => {
                write!(f, "the parenthesis opened at byte {opened} is not closed here")
            }
            Self::Unopened => write!(f, "this parenthesis closes none"),
            Self::Comma { .. } => write!(f, "a comma outside of the arguments of a function"),
            Self::Chained => write!(f, "a comparison is compared once more"),
            Self::Condition => write!(f, "a condition, where a number has to be"),
            Self::Number => write!(f, "a number, where a condition has to be"),
            Self::Arguments { function, found, expected } => {
                write!(f, "`{function}` has {}, but takes {expected}", arguments(*found))
            }
            Self::NotCalled { function } => {
                write!(f, "`{function}` is a function, which needs arguments in parentheses")
            }
            Self::UnknownFunction { name, .. } => {
                write!(f, "there is no function `{}`", shown(name))
            }
            Self::UnknownName { name, known, .. } => {
                write!(f, "`{}` is unknown; known are {}", shown(name), listed(known))
            }
            Self::Time => write!(f, "`t` has no meaning in a coupling"),
            Self::Cycle { names } => {
                let names: Vec<String> = names.iter().map(|name| shown(name)).collect();
                write!(f, "it is made of itself: {}", names.join(" ← "))
            }
            Self::NoComponents => write!(f, "there are no components"),
            Self::TooManyComponents { found, limit } => {
                write!(f, "there are {found} components, but at most {limit} may be")
            }
            Self::TooManyNames { found, limit } => {
                write!(
                    f,
                    "there are {found} subexpressions or parameters, but at most {limit} may be"
                )
            }
            Self::NoEquation => write!(f, "it has no equation"),
            Self::NoComponent { known, .. } => {
                write!(f, "there is no such component; there are {}", listed(known))
            }
            Self::Twice { before } => write!(f, "the name is used before, by the {before}"),
            Self::Reserved => write!(f, "the name has a meaning of its own in every formula"),
            Self::NoName => write!(f, "a name has letters, digits and `_`, and no digit first"),
            Self::NotFinite { value } => write!(f, "its value is {value}"),
        }
    }
}

impl Fault {
    fn remedy(&self) -> Option<String> {
        let nearest = |name: &Option<String>| name.as_ref().map(|name| format!("`{name}`?"));
        Some(match self {
            Self::Empty => "write 0 if nothing changes".into(),
            Self::TooLong { .. } | Self::TooDeep { .. } => {
                "give parts of it names, as subexpressions".into()
            }
            Self::Foreign { sign: "**", .. } => "use ^ for powers".into(),
            Self::Foreign { instead, .. } => format!("write {instead}"),
            Self::Superscript { instead } => format!("write {instead}"),
            Self::NoOperator { .. } => "products are written with *".into(),
            Self::Unclosed { .. } => "write the missing )".into(),
            Self::Unopened => "remove it, or write the ( that is missing".into(),
            Self::Comma { decimal: true } => "decimals are written with a point".into(),
            Self::Chained => "write a < b and b < c".into(),
            Self::Condition => "write if(condition, 1, 0)".into(),
            Self::Number => "write a comparison, such as x > 0".into(),
            Self::NotCalled { function } => format!("write {function}(…)"),
            Self::UnknownFunction { nearest: None, name } => {
                let (ln, name) = (name == "ln", shown(name));
                if ln {
                    "`log`?".into()
                } else {
                    format!("if a product is meant, write {name}*(…)")
                }
            }
            Self::UnknownFunction { nearest: name, .. }
            | Self::UnknownName { nearest: name, .. }
            | Self::NoComponent { nearest: name, .. } => return nearest(name),
            Self::Time => "let a component of the oscillator be driven instead".into(),
            Self::Cycle { .. } => "let one of them be a component".into(),
            Self::TooManyComponents { .. } => {
                "components that no other depends on can be left out".into()
            }
            Self::NoEquation => "write its equation".into(),
            Self::Twice { .. } | Self::Reserved | Self::NoName => "choose another name".into(),
            Self::NotFinite { .. } => "give it a finite value".into(),
            Self::TooSmall => "write 0".into(),
            Self::Character { .. }
            | Self::TooLarge
            | Self::TooManyNames { .. }
            | Self::NoComponents
            | Self::TwoPoints
            | Self::Expected { .. }
            | Self::Comma { decimal: false }
            | Self::Arguments { .. } => return None,
        })
    }
}

/// A text of somebody's, cut where it is long.
pub(crate) fn shown(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut cut: String = text.chars().take(LONGEST).collect();
    if cut.len() < text.len() {
        cut.push('…');
    }
    cut
}

/// A character between backticks, or its name alone where it cannot be seen.
fn quoted(c: char) -> String {
    if c.is_control() || c.is_whitespace() { "a character".into() } else { format!("`{c}`") }
}

fn arguments(count: usize) -> String {
    if count == 1 { "1 argument".into() } else { format!("{count} arguments") }
}

/// Names, but not hundreds of them.
fn listed(names: &[String]) -> String {
    const MOST: usize = 24;
    if names.is_empty() {
        return "none".into();
    }
    let rest = names.len().saturating_sub(MOST);
    let shown: Vec<String> = names.iter().take(MOST).map(|name| shown(name)).collect();
    let shown = shown.join(", ");
    if rest == 0 { shown } else { format!("{shown} and {rest} more") }
}
