//! Names that mean something in every formula: functions, constants, words. Nothing else may be called so.

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    /// |x|.
    Abs,
    /// −1, 0 or 1.
    Sign,
    /// The largest integer that is not above x.
    Floor,
    /// Square root.
    Sqrt,
    /// Exponential function.
    Exp,
    /// Natural logarithm.
    Log,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent.
    Tan,
    /// Inverse sine.
    Asin,
    /// Inverse cosine.
    Acos,
    /// Inverse tangent.
    Atan,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
}

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// a + b.
    Add,
    /// a − b.
    Subtract,
    /// a b.
    Multiply,
    /// a / b.
    Divide,
    /// a^b.
    Power,
    /// The smaller one.
    Min,
    /// The larger one.
    Max,
    /// The angle of the point (b, a).
    Atan2,
}

/// A comparison of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    /// a < b.
    Less,
    /// a <= b.
    LessOrEqual,
    /// a > b.
    Greater,
    /// a >= b.
    GreaterOrEqual,
    /// a == b.
    Equal,
    /// a != b.
    NotEqual,
}

/// What can be called, as in `sin(x)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Unary(Unary),
    Binary(Binary),
    If,
}

/// Every function with its name.
const FUNCTIONS: [(&str, Function); 19] = [
    ("if", Function::If),
    ("abs", Function::Unary(Unary::Abs)),
    ("sign", Function::Unary(Unary::Sign)),
    ("min", Function::Binary(Binary::Min)),
    ("max", Function::Binary(Binary::Max)),
    ("floor", Function::Unary(Unary::Floor)),
    ("sqrt", Function::Unary(Unary::Sqrt)),
    ("exp", Function::Unary(Unary::Exp)),
    ("log", Function::Unary(Unary::Log)),
    ("sin", Function::Unary(Unary::Sin)),
    ("cos", Function::Unary(Unary::Cos)),
    ("tan", Function::Unary(Unary::Tan)),
    ("asin", Function::Unary(Unary::Asin)),
    ("acos", Function::Unary(Unary::Acos)),
    ("atan", Function::Unary(Unary::Atan)),
    ("atan2", Function::Binary(Binary::Atan2)),
    ("sinh", Function::Unary(Unary::Sinh)),
    ("cosh", Function::Unary(Unary::Cosh)),
    ("tanh", Function::Unary(Unary::Tanh)),
];

/// The ratio of a circle's circumference to its diameter.
pub(crate) const PI: &str = "pi";

/// Time.
pub(crate) const TIME: &str = "t";

/// Words between conditions.
pub(crate) const WORDS: [&str; 3] = ["and", "or", "not"];

/// The function of that name.
pub(crate) fn function(name: &str) -> Option<Function> {
    FUNCTIONS.iter().find(|(known, _)| *known == name).map(|(_, function)| *function)
}

/// Names of all functions.
pub(crate) fn functions() -> impl Iterator<Item = &'static str> {
    FUNCTIONS.iter().map(|(name, _)| *name)
}

/// Whether a name has a meaning of its own in every formula.
pub(crate) fn is_reserved(name: &str) -> bool {
    name == PI || name == TIME || WORDS.contains(&name) || function(name).is_some()
}

/// Whether a text can be the name of a component, parameter or subexpression: letters of any script,
/// digits and `_`, no digit first.
pub(crate) fn is_name(text: &str) -> bool {
    let mut chars = text.chars();
    chars.next().is_some_and(starts_name) && chars.all(continues_name)
}

pub(crate) fn starts_name(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

/// Digits above the line are powers that somebody means, not parts of a name.
pub(crate) fn continues_name(c: char) -> bool {
    (c.is_alphanumeric() || c == '_') && superscript(c).is_none()
}

/// The digit that stands above the line.
pub(crate) fn superscript(c: char) -> Option<usize> {
    "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|digit| digit == c)
}

/// The known name nearest to one that was found, if it is near enough to be a slip.
pub fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    /// Nobody mistypes a name so long; the distance takes time and room that grow with its square.
    const LONGEST: usize = 100;
    if found.len() > LONGEST {
        return None;
    }
    known
        .into_iter()
        .filter(|name| name.len() <= LONGEST)
        .map(|name| (distance(found, name), name))
        .filter(|(distance, name)| *distance <= 1 + name.chars().count() / 3)
        .filter(|(distance, _)| *distance < found.chars().count())
        .min_by_key(|(distance, name)| (*distance, name.len().abs_diff(found.len()), *name))
        .map(|(_, name)| name.to_owned())
}

/// Slips between two names; a wrong case is none.
fn distance(a: &str, b: &str) -> usize {
    strsim::damerau_levenshtein(&a.to_lowercase(), &b.to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_finds_its_name_and_a_stranger_does_not() {
        assert_eq!(nearest("sqr", functions()).as_deref(), Some("sqrt"));
        assert_eq!(nearest("Sin", functions()).as_deref(), Some("sin"));
        assert_eq!(nearest("gamma", functions()), None);
        assert_eq!(nearest("q", ["x", "y"]), None);
        assert_eq!(nearest("X", ["x", "y"]).as_deref(), Some("x"));
    }

    #[test]
    fn names_are_letters_of_any_script_digits_and_underscores() {
        for name in ["x", "α", "x₁", "_u", "Ωmega_2"] {
            assert!(is_name(name), "{name}");
        }
        for name in ["", "2x", "x²", "x y", "x-y", "∂x"] {
            assert!(!is_name(name), "{name}");
        }
    }
}
