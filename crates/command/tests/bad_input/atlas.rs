//! Atlases that are refused.

use super::{Workplace, check_answer};

const ATLAS: &str = r#"title = "One system"
[msf]
points = 17
average = 300.0
[atlas.rossler]
oscillator.rossler = { c = 9.0 }
step = 0.01
[atlas.rossler.published."x:x"]
windows = [[0.186, 4.614]]
within = 0.001
"#;

/// The atlas with one text in place of another must be refused with these pieces in one message.
#[track_caller]
fn check(from: &str, to: &str, expected: &[&str]) {
    assert!(ATLAS.contains(from), "the atlas contains {from}");
    let place = Workplace::new();
    place.write("atlas.toml", ATLAS.replace(from, to));
    check_answer(&place, place.answer(&["run", "atlas.toml"]), "atlas.toml", expected);
}

#[test]
fn names_that_are_none_are_answered_with_the_nearest() {
    check(
        "oscillator.rossler",
        "oscillator.roessler",
        &["atlas.rossler.oscillator", "did you mean `rossler`?"],
    );
    check("c = 9.0", "k = 9.0", &["k", "did you mean `a`?"]);
    check("step = 0.01", "stepp = 0.01", &["atlas.rossler.stepp", "did you mean `step`?"]);
    check("points", "pionts", &["msf.pionts", "did you mean `points`?"]);
}

#[test]
fn what_is_published_is_about_a_pair_and_is_windows() {
    check("\"x:x\"", "\"x:w\"", &["atlas.rossler.published.\"x:w\"", "about no pair"]);
    check("\"x:x\"", "everywhere", &["about no pair", "x:x, x:y"]);
    check("[[0.186, 4.614]]", "[[4.614, 0.186]]", &["\"x:x\".windows", "ascending"]);
    check("[[0.186, 4.614]]", "[[0.186, inf], [7.0, 8.0]]", &["only the last may end at inf"]);
    check("[[0.186, 4.614]]", "0.186", &["windows", "[[0.2, 4.6], [8.0, inf]]"]);
    check("within = 0.001", "within = 0.0", &["\"x:x\".within", "above zero"]);
}

#[test]
fn numbers_and_equations_are_named_as_they_stand_in_the_file() {
    check("step = 0.01", "step = -0.01", &["`atlas.rossler.step`", "above zero"]);
    check("average = 300.0", "average = 3.0", &["`msf.average`", "blocks"]);
    check("points = 17", "points = 3", &["`msf.points`", "9 or more"]);
    check(
        "oscillator.rossler = { c = 9.0 }",
        "oscillator.custom = { flow = { x = \"-x + q\" }, start = { x = [0, 1] } }",
        &["atlas.toml:6:", "atlas.rossler.oscillator.custom.flow.x", "q"],
    );
    check("title = \"One system\"", "", &["`title` is missing", "[atlas.NAME]"]);
}

#[test]
fn an_atlas_of_nothing_is_refused() {
    let place = Workplace::new();
    place.write("atlas.toml", "title = \"none\"\n[atlas]\n");
    let answer = place.answer(&["run", "atlas.toml"]);
    check_answer(&place, answer, "atlas.toml", &["has no systems"]);
}
