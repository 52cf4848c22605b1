//! Bad input through the command: one clear message that names the file and the key or line, exit
//! status 2, nothing on standard output, no results.

mod abuse;
mod atlas;
mod claims;
mod effects;
mod equations;
mod keys;
mod mutated;
mod networks;
mod numbers;
#[path = "../support/mod.rs"]
mod support;
mod surroundings;

use support::{Answer, Toml, Workplace};

/// An experiment that must be refused with all these pieces in one message.
#[track_caller]
fn check_refused(experiment: &Toml, expected: &[&str]) {
    let place = Workplace::new();
    place.write("tiny.toml", &experiment.0);
    check_answer(&place, place.answer(&["run", "tiny.toml"]), "tiny.toml", expected);
}

/// A network file that must be refused.
#[track_caller]
fn check_network_refused(network: impl AsRef<[u8]>, expected: &[&str]) {
    let place = Workplace::new();
    place.write("networks/six-node.edges", network);
    check_answer(&place, place.answer(&["run", "tiny.toml"]), "tiny.toml: `network", expected);
}

#[track_caller]
fn check_answer(place: &Workplace, answer: Answer, file: &str, expected: &[&str]) {
    let Answer { stdout, stderr, .. } = answer.with_status(2);
    // Seen with `--nocapture`: the messages are there to be read by people.
    println!("{stderr}");
    assert_eq!(stdout, "");
    let (message, hint) = stderr.split_once("\n\nhint: ").unwrap_or((&stderr, ""));
    assert!(message.starts_with("error: "), "{stderr}");
    assert_eq!(message.trim_end().lines().count(), 1, "one message:\n{stderr}");
    assert!(hint.trim_end().lines().count() <= 1, "one hint:\n{stderr}");
    assert!(!stderr.trim_end().ends_with('.'), "no full stop:\n{stderr}");
    for piece in expected.iter().chain([&file]) {
        assert!(stderr.contains(piece), "expected `{piece}` in:\n{stderr}");
    }
    // Words of the language that the command is written in mean nothing to its users.
    for word in ["panicked", "backtrace", "f64", "u64", "u32", "i128", "struct", "variant", "Some("]
    {
        assert!(!stderr.contains(word), "`{word}` in:\n{stderr}");
    }
    assert!(place.names("results").iter().all(|name| name.starts_with('.')), "results were left");
}
