//! Reading an experiment file, with errors that name line, column, key and the nearest known key.

use std::io::Read;
use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::de::{DeTable, DeValue};

use crate::shapes::shape;
use crate::spec::{Atlas, Experiment, OscillatorSpec};
use user::files;
use user::text::shown;
use user::{Problem, Result, nearest};

/// Longest quotation of a line in a message, in characters.
const MAX_QUOTED_CHARS: usize = 60;

/// An experiment file as it was read.
pub struct Document<T = Experiment> {
    /// What it says.
    pub experiment: T,
    /// The same as it is written, defaults left out, for the record.
    pub written: serde_json::Value,
    /// Its text.
    pub text: String,
}

/// A document of one of the kinds that there are.
pub enum AnyDocument {
    /// An experiment.
    Experiment(Box<Document>),
    /// An atlas, which has a table `[atlas]`.
    Atlas(Box<Document<Atlas>>),
}

/// Reads and parses a file of any kind.
pub fn document(path: &Path) -> Result<AnyDocument> {
    let text = text(path)?;
    let is_atlas = DeTable::parse(&text).is_ok_and(|table| table.get_ref().contains_key("atlas"));
    Ok(match is_atlas {
        true => AnyDocument::Atlas(Box::new(parse(&text, path)?)),
        false => AnyDocument::Experiment(Box::new(parse(&text, path)?)),
    })
}

/// The text of a file as of [`document`], of a kind that is known.
pub fn parse<T: DeserializeOwned>(text: &str, path: &Path) -> Result<Document<T>> {
    if let Ok(document) = DeTable::parse(text) {
        refuse_lists(document.get_ref(), "", text, path)?;
    }
    let parsed = toml::from_str(text).and_then(|spec| Ok((spec, toml::from_str(text)?)));
    let document = |(experiment, written)| Document { experiment, written, text: text.to_owned() };
    parsed.map(document).map_err(|error| told(&error, text, path))
}

/// An oscillator that a text holds: the table `[oscillator.…]` of an experiment, or the keys of
/// `[oscillator.custom]` by themselves.
///
/// # Errors
/// What is wrong with it.
pub fn oscillator(text: &str, path: &Path) -> Result<OscillatorSpec> {
    #[derive(Deserialize)]
    struct Holds {
        oscillator: OscillatorSpec,
    }
    let told = |error| told(&error, text, path);
    let by_themselves = DeTable::parse(text).is_ok_and(|table| {
        let has = |key| table.get_ref().contains_key(key);
        !has("oscillator") && (has("flow") || has("map"))
    });
    if by_themselves {
        return toml::from_str(text).map(Box::new).map(OscillatorSpec::Custom).map_err(told);
    }
    toml::from_str(text).map(|holds: Holds| holds.oscillator).map_err(told)
}

/// What the parser says, in our words and with its place.
fn told(error: &toml::de::Error, text: &str, path: &Path) -> Problem {
    let span = error.span().unwrap_or(0..0);
    let problem = match DeTable::parse(text) {
        Ok(table) => explain(error.message().trim_end(), table.get_ref(), &span, text),
        Err(_) => {
            let (line, message) = (line_at(text, span.start), invalid(error.message()));
            Problem::new(format!("`{line}` is not valid TOML: {message}"))
        }
    };
    problem.at(place(path, text, span.start))
}

/// The place of a part of a text in quotes, the value of a key: of some bytes of it, or of its beginning.
/// None where there is no such key.
pub fn place_in_text(
    (path, text): (&Path, &str),
    key: &str,
    bytes: Option<&Range<usize>>,
) -> Option<String> {
    let document = DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    let mut names = key.split('.').peekable();
    let value = loop {
        let value = table.get(names.next()?)?;
        match (names.peek(), value.get_ref()) {
            (None, _) => break value,
            (Some(_), DeValue::Table(inner)) => table = inner,
            (Some(_), _) => return None,
        }
    };
    let span = value.span();
    let within = bytes.and_then(|bytes| {
        let value = value.get_ref().as_str()?;
        // Escapes make the value another text than what is written: then its beginning must do.
        Some(text[span.clone()].find(value)? + bytes.start)
    });
    Some(place(path, text, span.start + within.unwrap_or(0)))
}

/// Whether the value of a key is a table with keys of its own. `*` stands for any name.
const TABLES: [&str; 27] = [
    "network",
    "network.file",
    "network.file.attributes",
    "network.communities",
    "network.hierarchical",
    "groups",
    "groups.ranges",
    "groups.file",
    "regions",
    "oscillator",
    "oscillator.*",
    "oscillator.custom.flow",
    "oscillator.custom.map",
    "oscillator.custom.where",
    "oscillator.custom.parameters",
    "oscillator.custom.start",
    "coupling",
    "spectrum",
    "msf",
    "prediction",
    "sweep",
    "sweep.series",
    "figure",
    "claims",
    "claims.*",
    "atlas",
    "atlas.*",
];

/// Refuses a list in place of a table: the parser would take its values for those of the keys, in
/// their order, which nobody who reads the file knows.
fn refuse_lists(table: &DeTable<'_>, above: &str, text: &str, path: &Path) -> Result<()> {
    for (key, value) in table.iter() {
        let name = if above.is_empty() {
            key.get_ref().to_string()
        } else {
            format!("{above}.{}", key.get_ref())
        };
        match value.get_ref() {
            DeValue::Array(_) if is_table(&name) => {
                let problem =
                    Problem::new(format!("`{name}` is a list, but must be a table: [{name}]"));
                return Err(problem.at(place(path, text, value.span().start)));
            }
            DeValue::Table(inner) => refuse_lists(inner, &name, text, path)?,
            _ => {}
        }
    }
    Ok(())
}

fn is_table(name: &str) -> bool {
    let parent = name.split_once('.').map(|(parent, _)| parent);
    let is_where = parent == Some("claims") && name.ends_with(".where");
    let named = |table: &&str| match table.strip_suffix(".*") {
        Some(above) => parent == Some(above) && name[above.len() + 1..].find('.').is_none(),
        None => *table == name,
    };
    is_where || TABLES.iter().any(named)
}

/// Longest experiment file, in bytes: some hundred times the longest that anybody wrote.
const MOST_BYTES: u64 = 16 << 20;

/// The text of a file, which must be a regular one.
///
/// # Errors
/// Why it cannot be read.
pub fn text(path: &Path) -> Result<String> {
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => Problem::new("there is no such file")
            .in_file(path)
            .hint("`eigensync list` shows the experiments there are"),
        _ => Problem::from_error("the file cannot be read", error).in_file(path),
    };
    let kind = files::kind(path).map_err(failed)?;
    if kind == "a folder" {
        return Err(Problem::new("is a folder, expected an experiment file")
            .in_file(path)
            .hint(format!("`eigensync list {}` shows the experiments in it", shown(path))));
    }
    if kind != files::REGULAR {
        return Err(Problem::new(format!("is {kind}, expected {}", files::REGULAR)).in_file(path));
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(failed)?;
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MOST_BYTES {
        let message = format!("has more than {MOST_BYTES} bytes, expected an experiment file");
        return Err(Problem::new(message).in_file(path));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let byte = error.as_bytes()[valid];
        let before = String::from_utf8_lossy(&error.as_bytes()[..valid]);
        Problem::new(format!("expected text in UTF-8, found the byte 0x{byte:02x}"))
            .at(place(path, &before, valid))
    })
}

/// What the parser says of the commonest slips in the syntax, in words that say what to do.
fn invalid(message: &str) -> &str {
    match message.trim_end() {
        "duplicate key" => "this was given before",
        "string values must be quoted, expected literal string" => {
            "expected a number, or a text in quotes"
        }
        "unexpected key or value, expected newline, `#`" => {
            "expected nothing more after the value, unless a comment that begins with #"
        }
        other => other,
    }
}

/// The parser's message in our words, with a hint where a name may be a slip of the pen.
fn explain(message: &str, table: &DeTable<'_>, span: &Range<usize>, text: &str) -> Problem {
    let names: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let key = key_at(table, span).unwrap_or_default();
    match (message.split('`').next().unwrap_or_default(), &names[..]) {
        ("missing field ", [name, ..]) => missing(name, table, span),
        ("unknown field ", [found, known @ ..]) => {
            unknown(format!("unknown key `{key}`"), found, known)
        }
        ("unknown variant ", [found, known @ ..]) if key.ends_with(found) => {
            unknown(format!("unknown name `{key}`"), found, known)
        }
        ("unknown variant ", [found, known @ ..]) => {
            unknown(format!("`{key}` is \"{found}\", a name that is not known here"), found, known)
        }
        _ if message.starts_with("wanted exactly 1 element") => {
            // Where there are several, the parser points at the first of them.
            let parent = key.rsplit_once('.').map_or(&key[..], |(parent, _)| parent);
            Problem::new(format!("`{parent}` must have exactly one table [{parent}.…]"))
        }
        _ => {
            let problem =
                Problem::new(format!("`{key}` {}", mistyped(message, &key, &text[span.clone()])));
            match shape(&key) {
                Some(shape) => problem.hint(format!("it is written so: {shape}")),
                None => problem,
            }
        }
    }
}

fn missing(name: &str, table: &DeTable<'_>, span: &Range<usize>) -> Problem {
    match table_at(table, span) {
        Some(table) => Problem::new(format!("`{table}.{name}` is missing")),
        None if table.contains_key("atlas") => Problem::new(format!("`{name}` is missing"))
            .hint("every atlas has `title` and for each of its systems a table [atlas.NAME]"),
        None => Problem::new(format!("`{name}` is missing")).hint(
            "every experiment has `title`, [network.…], [oscillator.…], [coupling] and [msf]",
        ),
    }
}

fn unknown(message: String, found: &str, known: &[&str]) -> Problem {
    Problem::new(message).hint(match nearest(found, known.iter().copied()) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("known here: {}", known.join(", ")),
    })
}

/// What the parser says of a value of the wrong kind, in the words of a user of TOML.
fn mistyped(message: &str, key: &str, value: &str) -> String {
    let found_expected = |prefix: &str| message.strip_prefix(prefix)?.split_once(", expected ");
    if message == "invalid type: unit variant, expected newtype variant" {
        return format!("is only a name; expected a table [{key}.{}]", value.trim_matches('"'));
    }
    if let Some((length, expected)) = found_expected("invalid length ") {
        let expected = expected.trim_start_matches("an array of length ");
        return format!("has a list of {length} where {expected} values are expected");
    }
    let found_expected =
        found_expected("invalid type: ").or_else(|| found_expected("invalid value: "));
    match (found_expected, message) {
        (Some((found, expected)), _) => {
            format!("is {}, but must be {}", kind_found(found), kind_expected(expected))
        }
        (None, "wanted string or table") => "must be a name in quotes or a table".into(),
        (None, message) if message.starts_with("data did not match any variant") => {
            format!("is {value}, which is of none of the shapes that it may have")
        }
        (None, message) => format!("cannot be read: {message}"),
    }
}

fn kind_found(found: &str) -> String {
    match found.split_once(' ') {
        Some(("string", text)) => format!("the text {text}"),
        Some(("integer" | "boolean", _)) | Some(("floating", _)) => {
            found.split('`').nth(1).unwrap_or(found).to_owned()
        }
        _ if found == "sequence" => "a list".into(),
        _ if found == "map" => "a table or a date".into(),
        _ => found.to_owned(),
    }
}

fn kind_expected(expected: &str) -> &str {
    match expected {
        "f64" => "a number",
        "u64" | "usize" => "a whole number, zero or above",
        "u32" => "a whole number from 0 to 4294967295",
        "a sequence" => "a list",
        "an array of length 2" => "a list of 2",
        "a string" => "a text in quotes",
        "path string" => "a path in quotes",
        "a map" => "a table",
        _ if expected.starts_with("struct ") => "a table",
        _ => expected,
    }
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

/// The dotted path of the table with exactly this span; none for the whole file.
fn table_at(table: &DeTable<'_>, span: &Range<usize>) -> Option<String> {
    table.iter().find_map(|(key, value)| {
        let DeValue::Table(inner) = value.get_ref() else { return None };
        let name = key.get_ref();
        if value.span() == *span {
            return Some(name.to_string());
        }
        Some(format!("{name}.{}", table_at(inner, span)?))
    })
}

/// File, line and column, both from 1, of a byte of the text.
fn place(path: &Path, text: &str, byte: usize) -> String {
    let before = &text[..byte.min(text.len())];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let (line, column) = (before.matches('\n').count() + 1, before[line_start..].chars().count());
    format!("{}:{line}:{}", shown(path), column + 1)
}

/// The line that holds a byte of the text, or as much of it as bears quoting.
fn line_at(text: &str, byte: usize) -> String {
    let start = text[..byte.min(text.len())].rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[start..].lines().next().unwrap_or_default().trim();
    match line.char_indices().nth(MAX_QUOTED_CHARS) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line.to_owned(),
    }
}
