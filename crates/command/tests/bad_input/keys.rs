//! Keys, names and types that an experiment file cannot have.

use crate::support::{Toml, Workplace, tiny};
use crate::{check_answer, check_refused};

#[test]
fn an_unknown_key_is_answered_with_the_nearest_known_one() {
    check_refused(
        &tiny().set("sweep.sedes", "2"),
        &["unknown key `sweep.sedes`", "hint", "`seeds`"],
    );
    check_refused(&tiny().set("sed", "1"), &["tiny.toml:1:1", "unknown key `sed`", "`seed`"]);
    check_refused(&tiny().set("oscillator.lorenz.aplha", "1"), &["aplha", "did you mean `alpha`?"]);
    check_refused(
        &tiny().replace("points = 5", "point = 5"),
        &["unknown key `sweep.epsilon.point`", "did you mean `points`?"],
    );
    check_refused(
        &tiny().set("sweep.colour", "2"),
        &["unknown key `sweep.colour`", "known here: epsilon, seeds"],
    );
}

#[test]
fn an_unknown_table_is_answered_with_the_nearest_known_one() {
    check_refused(&tiny().and("[predictoin]"), &["unknown key `predictoin`", "`prediction`"]);
    check_refused(&tiny().replace("[network.file]", "[network.fil]"), &["network.fil", "`file`"]);
}

#[test]
fn a_value_of_the_wrong_type_is_answered_with_what_it_must_be() {
    let must_be = |key: &str, value: &str, expected: &[&str]| {
        check_refused(&tiny().set(key, value), &[&[key], expected].concat());
    };
    must_be("msf.step", "\"small\"", &["is the text \"small\", but must be a number"]);
    must_be("sweep.seeds", "2.5", &["is 2.5, but must be a whole number, zero or above"]);
    must_be("sweep.seeds", "-2", &["is -2, but must be a whole number"]);
    must_be("sweep.stride", "4294967296", &["from 0 to 4294967295"]);
    must_be("seed", "-1", &["is -1, but must be a whole number"]);
    must_be("seed", "1979-05-27", &["is a table or a date, but must be a whole number"]);
    must_be("title", "true", &["is true, but must be a text in quotes"]);
    must_be("sweep.epsilon", "\"1:5\"", &["{ from = …, to = …, points = … } or a list"]);
    must_be("sweep.epsilon", "[1, \"a\"]", &["is the text \"a\", but must be a number"]);
    must_be("sweep.clusters", "[1, 2]", &["is 1, but must be a list"]);
    must_be("sweep.clusters", "[[1.5, 2]]", &["a node label: a text or a whole number"]);
    // Shapes that are not known are answered with those that are, by example.
    let grid = "epsilon = { from = 0.5, to = 5.0, points = 10 } or [0.5, 1.0, 2.5]";
    must_be("sweep.epsilon", "\"a\"", &["is the text \"a\"", grid]);
    must_be("sweep.epsilon", "[[1, 2]]", &["is a list, but must be a number", grid]);
    must_be("sweep.epsilon", "2.0", &["is 2.0", grid]);
    let grid = "sigma = { from = 0.0, to = 12.0, points = 49 } or [0.0, 0.5, 1.0]";
    must_be("msf.sigma", "[[0, 12, 7]]", &["is a list, but must be a number", grid]);
    must_be("sweep.clusters", "[1, 2]", &["clusters = [[1, 2, 6], [3, 4, 5]]"]);
    must_be("sweep.clusters", "\"all\"", &["clusters = [[1, 2, 6], [3, 4, 5]]"]);
    must_be("sweep.synchronised_below", "[]", &["synchronised_below = 1e-3 or { of_largest"]);
    check_refused(
        &tiny().and("[figure]\nmark_modes = 2"),
        &["`figure.mark_modes` is 2, but must be a list", "mark_modes = [2, 3]"],
    );
    check_refused(
        &tiny().set("claims.integers.where", "{ epsilon = \"a\" }"),
        &["is \"a\"", "epsilon = 0.5 or [0.5, 1.0]"],
    );
    must_be("coupling.matrix", "3", &["must be a name in quotes"]);
    check_refused(
        &tiny().without_table("coupling").set("coupling", "5"),
        &["`coupling` is 5, but must be a table"],
    );
    check_refused(
        &tiny().without_table("oscillator.lorenz").set("oscillator", "\"lorenz\""),
        &["`oscillator` is only a name; expected a table [oscillator.lorenz]"],
    );
    check_refused(
        &tiny().and("[oscillator.rossler]"),
        &["`oscillator` must have exactly one table [oscillator.…]"],
    );
    check_refused(
        &tiny().and("[figure]\nlayout = [[0, 0], [1]]"),
        &["`figure.layout` has a list of 1 where 2 values are expected"],
    );
}

#[test]
fn a_missing_key_is_named() {
    check_refused(&tiny().without("sweep.average"), &["`sweep.average` is missing"]);
    check_refused(&tiny().without("network.file.path"), &["`network.file.path` is missing"]);
    check_refused(&tiny().without("title"), &["`title` is missing"]);
    check_refused(
        &tiny().without_table("coupling"),
        &["`coupling` is missing", "[coupling] and [msf]"],
    );
    check_refused(&tiny().replace("from = 1.0, ", ""), &["`sweep.epsilon.from` is missing"]);
    check_refused(&Toml(String::new()), &["`title` is missing"]);
}

#[test]
fn an_unknown_component_is_answered_with_those_there_are() {
    let there_are = "is \"v\", but `lorenz` has components x, y, z";
    check_refused(&tiny().set("coupling.from", "\"v\""), &["`coupling.from`", there_are]);
    check_refused(&tiny().set("coupling.to", "\"v\""), &["`coupling.to`", there_are]);
    check_refused(&tiny().set("sweep.component", "\"v\""), &["`sweep.component`", there_are]);
}

#[test]
fn an_unknown_oscillator_is_answered_with_those_there_are() {
    let other = |name: &str| tiny().replace("oscillator.lorenz", &format!("oscillator.{name}"));
    check_refused(
        &other("lorentz"),
        &["unknown name `oscillator.lorentz`", "did you mean `lorenz`?"],
    );
    check_refused(&other("metronome"), &["known here: chen, chua", "lorenz", "custom"]);
}

#[test]
fn names_that_are_not_known_are_answered_with_those_that_are() {
    let unknown = |key: &str, value: &str, expected: &str| {
        check_refused(&tiny().set(key, &format!("\"{value}\"")), &[key, value, expected]);
    };
    unknown("coupling.matrix", "laplace", "did you mean `laplacian`?");
    unknown("sweep.method", "euler", "known here: auto, rk4, rk8, iterate, dopri5, dop853");
    unknown("network.file.format", "excel", "known here: edge_list");
    unknown("claims.integers.of", "eigenvalue", "did you mean `eigenvalues`?");
    check_refused(
        &tiny().and("[spectrum]\nsolver = \"lapack\""),
        &["`spectrum.solver` is \"lapack\"", "did you mean `arpack`?"],
    );
    check_refused(&tiny().and("[figure]\nlayout = \"circl\""), &["figure.layout", "`circle`"]);
}

#[test]
fn an_experiment_that_is_not_utf_8_is_answered_with_line_and_byte() {
    let place = Workplace::new();
    place.write("tiny.toml", [tiny().0.as_bytes(), b"# Erd\xf6s\n"].concat());
    let answer = place.answer(&["run", "tiny.toml"]);
    check_answer(&place, answer, "tiny.toml:39:6", &["expected text in UTF-8", "0xf6"]);
}

#[test]
fn a_slip_in_the_syntax_is_answered_with_its_line() {
    check_refused(
        &tiny().replace("[coupling]", "[coupling"),
        &["tiny.toml:13:10", "`[coupling` is not valid TOML"],
    );
    check_refused(&tiny().set("seed", "1,"), &["tiny.toml:3:9", "`seed = 1,` is not valid TOML"]);
    check_refused(&tiny().replace("seed   = 1", "seed 1"), &["tiny.toml:3:6", "not valid TOML"]);
    check_refused(
        &tiny().set("sweep.step", "0,01"),
        &["`step = 0,01`", "nothing more after the value"],
    );
    check_refused(&tiny().set("title", "Six"), &["`title = Six`", "a number, or a text in quotes"]);
    check_refused(
        &tiny().and("[msf]"),
        &["tiny.toml:40:2", "`[msf]` is not valid TOML: this was given before"],
    );
}

#[test]
fn positions_of_a_figure_are_one_for_each_node_and_finite() {
    let layout = |positions: &str, expected: &str| {
        let figure = format!("[figure]\nlayout = {positions}");
        check_refused(&tiny().and(&figure), &["`figure.layout`", expected]);
    };
    layout("[[0, 0]]", "has 1 positions for 6 nodes");
    layout("[[0, 0], [1, 0], [2, 0], [3, 0], [4, 0], [nan, 1]]", "position of node \"6\"");
    check_refused(
        &tiny().and("[figure]\nsource_transitions = [nan]"),
        &["`figure.source_transitions` contains NaN"],
    );
}
