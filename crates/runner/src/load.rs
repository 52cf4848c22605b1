//! Reading an experiment file, with errors that name line, column, key and the nearest known key.

use std::ops::Range;
use std::path::Path;

use toml::de::{DeTable, DeValue};

use crate::problem::{Problem, Result, nearest};
use crate::spec::Experiment;

/// Reads and parses an experiment file.
pub fn experiment(path: &Path) -> Result<Experiment> {
    let text = std::fs::read_to_string(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => Problem::new("there is no such file")
            .in_file(path)
            .hint("`eigensync list` shows the experiments there are"),
        std::io::ErrorKind::InvalidData => Problem::new("the file is not UTF-8 text").in_file(path),
        _ => Problem::from_error("the file cannot be read", error).in_file(path),
    })?;
    toml::from_str(&text).map_err(|error| {
        let (message, hint) = explain(error.message());
        let Some(span) = error.span() else { return Problem::new(message).in_file(path) };
        let key = DeTable::parse(&text).ok().and_then(|table| key_at(table.get_ref(), &span));
        let message = match key {
            Some(key) => format!("`{key}`: {message}"),
            None => message,
        };
        let (line, column) = position(&text, span.start);
        let problem = Problem::new(message).at(format!("{}:{line}:{column}", path.display()));
        match hint {
            Some(hint) => problem.hint(hint),
            None => problem,
        }
    })
}

/// The parser's message in our words, with a hint where a name may be a slip of the pen.
fn explain(message: &str) -> (String, Option<String>) {
    let message = message.trim_end();
    let names: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let (kind, [found, known @ ..]) = (message.split('`').next().unwrap_or_default(), &names[..])
    else {
        return (message.to_owned(), None);
    };
    let what = match kind {
        "unknown field " => "key",
        "unknown variant " => "name",
        "missing field " => return (format!("the key `{found}` is missing"), None),
        _ => return (message.to_owned(), None),
    };
    let hint = match nearest(found, known.iter().copied()) {
        Some(name) => Some(format!("did you mean `{name}`?")),
        None => Some(format!("known here: {}", known.join(", "))),
    };
    (format!("unknown {what} `{found}`"), hint)
}

/// The dotted path of the innermost key whose name or value covers a span of the file.
fn key_at(table: &DeTable<'_>, span: &Range<usize>) -> Option<String> {
    let covers = |outer: Range<usize>| outer.start <= span.start && span.end <= outer.end;
    table.iter().find_map(|(key, value)| {
        let inner = match value.get_ref() {
            DeValue::Table(inner) => key_at(inner, span),
            _ => None,
        };
        let name = key.get_ref();
        match inner {
            Some(inner) => Some(format!("{name}.{inner}")),
            None if covers(key.span()) || covers(value.span()) => Some(name.to_string()),
            None => None,
        }
    })
}

/// Line and column, both from 1, of a byte of the text.
fn position(text: &str, byte: usize) -> (usize, usize) {
    let before = &text[..byte.min(text.len())];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
