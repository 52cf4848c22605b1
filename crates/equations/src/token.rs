//! Cuts a formula into numbers, names and signs, each with its place.

use std::ops::Range;

use crate::mistake::Fault;
use crate::names::{continues_name, starts_name, superscript};

/// What a piece of text is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    Number(f64),
    Name,
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
    Open,
    Close,
    Comma,
    End,
}

/// A piece of text that is one thing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Token {
    pub kind: Kind,
    pub at: Range<usize>,
}

/// Signs of one or two characters; longer ones first.
const SIGNS: [(&str, Kind); 14] = [
    ("<=", Kind::LessOrEqual),
    (">=", Kind::GreaterOrEqual),
    ("==", Kind::Equal),
    ("!=", Kind::NotEqual),
    ("+", Kind::Plus),
    ("-", Kind::Minus),
    ("*", Kind::Times),
    ("/", Kind::Over),
    ("^", Kind::Power),
    ("<", Kind::Less),
    (">", Kind::Greater),
    ("(", Kind::Open),
    (")", Kind::Close),
    (",", Kind::Comma),
];

/// Signs of other languages and of typeset formulas, what they are, and what is written here.
const FOREIGN: [(&str, &str, &str); 34] = [
    ("**", "two asterisks", "^"),
    ("&&", "two ampersands", "and"),
    ("&", "an ampersand", "and"),
    ("||", "two bars", "or"),
    ("|", "a bar", "abs(…), or `or`"),
    ("!", "an exclamation mark", "not"),
    ("=", "a single equals sign", "=="),
    ("%", "a percent sign", "a - b*floor(a/b)"),
    ("[", "a bracket", "("),
    ("]", "a bracket", ")"),
    ("{", "a brace", "("),
    ("}", "a brace", ")"),
    (";", "a semicolon", ","),
    ("−", "a minus sign of typeset text (U+2212)", "-"),
    ("–", "a dash (U+2013)", "-"),
    ("—", "a long dash (U+2014)", "-"),
    ("‐", "a hyphen of typeset text (U+2010)", "-"),
    ("‑", "a hyphen that does not break (U+2011)", "-"),
    ("－", "a wide minus (U+FF0D)", "-"),
    ("＋", "a wide plus (U+FF0B)", "+"),
    ("×", "a multiplication sign (U+00D7)", "*"),
    ("·", "a middle dot (U+00B7)", "*"),
    ("⋅", "a dot (U+22C5)", "*"),
    ("∗", "an asterisk of typeset text (U+2217)", "*"),
    ("÷", "a division sign (U+00F7)", "/"),
    ("∕", "a slash of typeset text (U+2215)", "/"),
    ("≤", "a sign of typeset text (U+2264)", "<="),
    ("≥", "a sign of typeset text (U+2265)", ">="),
    ("≠", "a sign of typeset text (U+2260)", "!="),
    ("√", "a root sign (U+221A)", "sqrt(…)"),
    ("（", "a wide parenthesis (U+FF08)", "("),
    ("）", "a wide parenthesis (U+FF09)", ")"),
    ("\u{a0}", "a space that does not break (U+00A0)", " "),
    ("\u{feff}", "an invisible mark (U+FEFF)", "nothing"),
];

/// Cuts a text up to the end or to the first thing that is nothing.
pub(crate) fn tokens(text: &str) -> Result<Vec<Token>, (Range<usize>, Fault)> {
    let mut tokens = Vec::new();
    let mut start = 0;
    loop {
        let rest = &text[start..];
        let blank = rest.len() - rest.trim_start_matches([' ', '\t', '\r', '\n']).len();
        start += blank;
        let token = token(text, start)?;
        start = token.at.end;
        let ended = token.kind == Kind::End;
        tokens.push(token);
        if ended {
            return Ok(tokens);
        }
    }
}

fn token(text: &str, start: usize) -> Result<Token, (Range<usize>, Fault)> {
    let rest = &text[start..];
    let Some(first) = rest.chars().next() else {
        return Ok(Token { kind: Kind::End, at: start..start });
    };
    let second = rest.chars().nth(1);
    if first.is_ascii_digit() || (first == '.' && second.is_some_and(|c| c.is_ascii_digit())) {
        return number(text, start);
    }
    if starts_name(first) {
        let length = rest.find(|c| !continues_name(c)).unwrap_or(rest.len());
        return Ok(Token { kind: Kind::Name, at: start..start + length });
    }
    let known = SIGNS.iter().find(|(sign, _)| rest.starts_with(sign));
    match (known, foreign(text, start)) {
        // `**` is not a product, but `!=` is what it looks like.
        (Some((sign, _)), Some((at, fault))) if at.len() > sign.len() => Err((at, fault)),
        (Some((sign, kind)), _) => Ok(Token { kind: *kind, at: start..start + sign.len() }),
        (None, Some(fault)) => Err(fault),
        (None, None) => Err((start..start + first.len_utf8(), Fault::Character { found: first })),
    }
}

/// A sign that means something elsewhere.
fn foreign(text: &str, start: usize) -> Option<(Range<usize>, Fault)> {
    let rest = &text[start..];
    if rest.chars().next().and_then(superscript).is_some() {
        let length = rest.find(|c| superscript(c).is_none()).unwrap_or(rest.len());
        let digits: String =
            rest[..length].chars().filter_map(superscript).map(|d| d.to_string()).collect();
        let fault = Fault::Superscript { instead: format!("^{digits}") };
        return Some((start..start + length, fault));
    }
    let &(sign, what, instead) = FOREIGN.iter().find(|(sign, ..)| rest.starts_with(sign))?;
    Some((start..start + sign.len(), Fault::Foreign { sign, what, instead }))
}

/// A number: digits, perhaps a point, perhaps a power of ten.
fn number(text: &str, start: usize) -> Result<Token, (Range<usize>, Fault)> {
    let bytes = text.as_bytes();
    let digits =
        |from: usize| from + bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut end = digits(start);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    let mantissa = start..end;
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let from = end + 1 + sign;
        // `2e` and `2exp(x)` are products that lack their sign, not powers of ten.
        if bytes.get(from).is_some_and(u8::is_ascii_digit) {
            end = digits(from);
        }
    }
    let at = start..end;
    let value: f64 = text[at.clone()].parse().expect("digits, a point and a power are a number");
    if value.is_infinite() {
        return Err((at, Fault::TooLarge));
    }
    if value == 0.0 && text[mantissa].bytes().any(|b| b.is_ascii_digit() && b != b'0') {
        return Err((at, Fault::TooSmall));
    }
    if bytes.get(end) == Some(&b'.') {
        return Err((start..end + 1, Fault::TwoPoints));
    }
    Ok(Token { kind: Kind::Number(value), at })
}
