//! What is said of the library: its table in the documentation, and how an oscillator is shown.

use std::fmt::Write;

use oscillators::{Entry, Kind, Published, find, library};

#[test]
fn the_library_has_its_oscillators_in_order_with_sources_and_no_loose_ends() {
    let names: Vec<&str> = library().iter().map(|entry| entry.name).collect();
    assert!(names.is_sorted() && names.len() >= 16, "{names:?}");
    // In an experiment file that is an oscillator of one's own.
    assert!(!names.contains(&"custom"));
    for entry in library() {
        let has_year = entry.source.split('(').skip(1).any(|part| part.starts_with(['1', '2']));
        assert!(has_year, "{}: {}", entry.name, entry.source);
        assert_eq!(entry.equations.system().unwrap().warnings(), [], "{}", entry.name);
        assert_eq!(entry.kind() == Kind::Map, entry.step == 1.0, "{}", entry.name);
    }
    let count = |wanted: &[&str]| {
        let uses = |text: &String| wanted.iter().any(|function| text.contains(function));
        library().iter().filter(|entry| uses(&entry.equations.to_string())).count()
    };
    let [trigonometric, exponential, piecewise] =
        [&["sin(", "cos("][..], &["exp(", "tanh("], &["abs(", "min(", "if("]].map(count);
    assert!(
        trigonometric >= 4 && exponential >= 3 && piecewise >= 3,
        "{trigonometric}, {exponential}, {piecewise}"
    );
}

#[test]
fn an_oscillator_is_shown_line_by_line() {
    let shown = |name: &str| find(name).unwrap().equations.to_string();
    assert_eq!(
        shown("ikeda"),
        "x' = 1 + u*(x*cos(tau) - y*sin(tau))\n\
         y' = u*(x*sin(tau) + y*cos(tau))\n\
         where tau = 0.4 - 6/(1 + x^2 + y^2)\n\
         with u = 0.9\n\
         from x in [-0.1, 0.1]\n\
         from y in [-0.1, 0.1]\n"
    );
    assert!(shown("rossler").starts_with("dx/dt = -(y + z)\n"));
    let kinds = ["lorenz", "duffing", "tent"].map(|name| find(name).unwrap().kind().to_string());
    assert_eq!(kinds, ["flow", "forced flow", "map"]);
}

/// A number with at most so many decimals.
fn rounded(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}").replace('-', "−");
    if text.contains('.') {
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    text
}

/// Published exponents, with the parameters that they are for.
fn held(published: &Published) -> String {
    let exponents: Vec<String> =
        published.exponents.iter().map(|&exponent| rounded(exponent, 6)).collect();
    let parameters: Vec<String> = published
        .parameters
        .iter()
        .map(|(name, &value)| format!("{name} = {}", rounded(value, 4)))
        .collect();
    let of = if parameters.is_empty() { "" } else { &format!(" ({})", parameters.join(", ")) };
    exponents.join(", ") + of
}

/// The table of the documentation.
fn table() -> String {
    let mut table = String::from(
        "| name | | kind | with its parameters | published exponents |\n|---|---|---|---|---|\n",
    );
    for entry in library() {
        let Entry { name, title, behaviour, .. } = entry;
        let compiled = if entry.compiled().is_some() { ", compiled" } else { "" };
        let published: Vec<String> = entry.published.iter().map(held).collect();
        let (kind, published) = (entry.kind(), published.join("; "));
        writeln!(table, "| `{name}` | {title} | {kind}{compiled} | {behaviour} | {published} |")
            .unwrap();
    }
    table
}

#[test]
fn the_table_of_the_documentation_is_that_of_the_library() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/oscillators.md");
    let documentation = std::fs::read_to_string(path).unwrap();
    assert!(documentation.contains(&table()), "docs/oscillators.md has to have\n\n{}", table());
}
