//! `eigensync oscillators [NAME]`: the library, a line each, or one of them with its equations.

use std::fmt::Write;

use comfy_table::Table;
use comfy_table::presets::NOTHING;
use oscillators::{Entry, find, library};
use serde_json::{Value, json};

use crate::output::{document, say};
use user::text::one_line;
use user::{Problem, Result};

/// Lists the library, or tells of one oscillator.
pub fn oscillators(name: Option<&str>, json: bool) -> Result<()> {
    let Some(name) = name else {
        if json {
            let all: Vec<Value> = library().iter().map(value).collect();
            document(&format!("{:#}", json!({ "oscillators": all })));
        } else {
            say!("{}", list());
        }
        return Ok(());
    };
    let entry = find(name).map_err(|unknown| {
        let hint = match &unknown.nearest {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("known here: {}", unknown.known.join(", ")),
        };
        Problem::new(format!("there is no oscillator `{name}`")).hint(hint)
    })?;
    match json {
        true => document(&format!("{:#}", value(entry))),
        false => say!("{}", told(entry)),
    }
    Ok(())
}

fn list() -> String {
    let mut table = Table::new();
    table.load_style(NOTHING);
    table.set_header(["name", "components", "kind", "what it is"]);
    for entry in library() {
        table.add_row([
            entry.name.to_owned(),
            components(entry).join(", "),
            entry.kind().to_string(),
            one_line(&entry.title).into_owned(),
        ]);
    }
    let lines: Vec<String> =
        table.to_string().lines().map(|line| line.trim_end().to_owned()).collect();
    format!(
        "{}\n\neigensync oscillators NAME shows the equations; one of your own is [oscillator.custom] in an \
         experiment file",
        lines.join("\n")
    )
}

/// An oscillator as people read it: the table that an experiment file would have stands at the end.
fn told(entry: &Entry) -> String {
    let mut text = format!("{}: {}\n", entry.name, entry.title);
    let mut line = |line: String| writeln!(text, "{line}").expect("a string takes every line");
    line(format!("{}, {}; {}", entry.kind(), entry.behaviour, entry.source));
    entry.note.iter().for_each(|note| line(note.clone()));
    line(String::new());
    entry.equations.to_string().lines().for_each(|equation| line(format!("    {equation}")));
    for published in &entry.published {
        let exponents: Vec<String> = published.exponents.iter().map(ToString::to_string).collect();
        let parameters: Vec<String> =
            published.parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        let with = if parameters.is_empty() {
            "with these parameters".to_owned()
        } else {
            format!("with {}", parameters.join(", "))
        };
        line(format!(
            "\nLyapunov exponents {with}: {} ({})",
            exponents.join(", "),
            published.source
        ));
    }
    line("\nIn an experiment file, with the parameters that differ:\n".to_owned());
    line(format!("    [oscillator.{}]", entry.name));
    for (name, value) in &entry.equations.parameters {
        line(format!("    {name} = {value}"));
    }
    text.trim_end().to_owned()
}

fn value(entry: &Entry) -> Value {
    let equations = serde_json::to_value(&entry.equations).unwrap_or_default();
    json!({
        "name": entry.name,
        "title": entry.title,
        "source": entry.source,
        "note": entry.note,
        "kind": entry.kind().to_string(),
        "behaviour": entry.behaviour.to_string(),
        "components": components(entry),
        "equations": equations,
        "compiled": entry.compiled().is_some(),
    })
}

fn components(entry: &Entry) -> Vec<&str> {
    entry.equations.start.keys().map(String::as_str).collect()
}
