//! Equations of one's own that cannot be read or evaluated: the place in the experiment file, down to the
//! character of the formula, what is wrong, and the way out.

use crate::check_refused;
use crate::support::{Toml, tiny};

/// The tiny experiment with Chua's circuit as text.
fn chua() -> Toml {
    tiny().without_table("oscillator.lorenz").and(
        r#"[oscillator.custom]
flow = { x = "alpha*(y - x - f)", y = "x - y + z", z = "-beta*y" }
where = { f = "m1*x + 0.5*(m0 - m1)*(abs(x + 1) - abs(x - 1))" }
parameters = { alpha = 10.0, beta = 14.87, m0 = -1.27, m1 = -0.68 }
start = { x = [-0.1, 0.1], y = [-0.1, 0.1], z = [-0.1, 0.1] }"#,
    )
}

/// Chua's circuit with one line of its table in other words, refused with all these pieces.
#[track_caller]
fn refused(from: &str, to: &str, expected: &[&str]) {
    check_refused(&chua().replace(from, to), expected);
}

/// The formula of y's equation, refused where `at` begins in it, or at its end where that is empty.
#[track_caller]
fn formula(text: &str, at: &str, expected: &[&str]) {
    let experiment = chua().replace("x - y + z", text);
    let line = experiment.0.lines().position(|line| line.starts_with("flow")).unwrap();
    let written = experiment.0.lines().nth(line).unwrap();
    let begins = written.find(text).unwrap()
        + if at.is_empty() { text.len() } else { text.find(at).unwrap() };
    let column = written[..begins].chars().count() + 1;
    let place = format!("tiny.toml:{}:{column}: `oscillator.custom.flow.y`", line + 1);
    check_refused(&experiment, &[&[place.as_str()], expected].concat());
}

#[test]
fn mistakes_in_a_formula_have_their_line_and_column() {
    formula("x - why + z", "why", &["`why` is unknown", "known are alpha"]);
    formula("x - alhpa + z", "alhpa", &["`alhpa` is unknown", "`alpha`?"]);
    formula("x - Y + z", "Y", &["`Y` is unknown", "`y`?"]);
    formula("(x - y + z", "", &["is not closed", "write the missing )"]);
    formula("x - y) + z", ")", &["closes none"]);
    formula("x − y + z", "−", &["minus sign of typeset text", "write -"]);
    formula("x - 1e400", "1e400", &["beyond the largest"]);
    formula("x - y²", "²", &["above the line", "write ^2"]);
    formula("x - y**2", "**", &["two asterisks", "use ^"]);
    formula("2x - y", "x", &["no sign before `x`", "with *"]);
    formula("x y", "y", &["no sign before `y`", "with *"]);
    formula("x(y + 1)", "x(", &["no function `x`", "write x*(…)"]);
    formula("sinh", "sinh", &["`sinh` is a function", "sinh(…)"]);
    formula("tahn(x)", "tahn", &["no function `tahn`", "`tanh`?"]);
    formula("ln(x)", "ln", &["no function `ln`", "`log`?"]);
    formula("atan2(x)", "atan2", &["has 1 argument, but takes 2"]);
    formula("if(x, 1, 2)", "x", &["a number, where a condition", "comparison"]);
    formula("x < y", "x < y", &["a condition, where a number"]);
    formula("if(0 < x < 1, 1, 2)", "< 1", &["compared once more", "a < b and b < c"]);
    formula("1,5*x", ",", &["comma", "with a point"]);
    formula("x & y", "&", &["ampersand", "and"]);
    formula("y*x -", "", &["found the end, but expected a number"]);
    formula("x + * y", "*", &["found `*`, but expected a number"]);
    formula("1.2.3*x", "1.2", &["two decimal points"]);
    formula("x · y", "·", &["middle dot", "write *"]);
    formula("if(x = 1, 2, 3)", "=", &["single equals", "=="]);
    formula("√x", "√", &["root", "sqrt"]);
}

#[test]
fn a_formula_over_several_lines_has_the_place_of_its_line() {
    let text = "\"\"\"\nx - y\n + zed\"\"\"";
    let lines = chua()
        .replace("flow = { x = \"alpha*(y - x - f)\", y = \"x - y + z\", z = \"-beta*y\" }", "")
        .and(&format!(
            "[oscillator.custom.flow]\nx = \"alpha*(y - x - f)\"\ny = {text}\nz = \"-beta*y\""
        ));
    let line = lines.0.lines().position(|line| line == " + zed\"\"\"").unwrap() + 1;
    check_refused(&lines, &[&format!("tiny.toml:{line}:4: "), "`zed` is unknown"]);
}

#[test]
fn mistakes_in_names_are_answered() {
    refused(
        "f = \"m1*x",
        "f = \"f + m1*x",
        &["`oscillator.custom.where.f`", "made of itself: f ← f"],
    );
    let cycle = "where = { g = \"f*2\", f = \"g + m1*x";
    refused("where = { f = \"m1*x", cycle, &["made of itself"]);
    refused(
        "alpha = 10.0,",
        "alpha = 10.0, x = 1.0,",
        &["parameters.x`", "used before, by the component"],
    );
    refused("alpha = 10.0,", "alpha = 10.0, f = 1.0,", &["parameters.f`", "used before"]);
    refused("alpha = 10.0,", "alpha = 10.0, pi = 3.0,", &["parameters.pi`", "meaning of its own"]);
    refused(
        "alpha = 10.0,",
        "alpha = 10.0, sin = 3.0,",
        &["parameters.sin`", "meaning of its own"],
    );
    refused("alpha = 10.0,", "alpha = 10.0, \"2b\" = 3.0,", &["no digit first"]);
    refused("alpha = 10.0,", "alpha = \"ten\",", &["parameters.alpha`", "must be a number"]);
    refused("alpha = 10.0,", "alpha = inf,", &["parameters.alpha`", "finite"]);
    refused("alpha = 10.0,", "alpha = 1e9,", &["parameters.alpha`", "between -1000000 and"]);
    refused("m1 = -0.68", "m1 = -0.68, m1 = 2.0", &["given before"]);
    refused("parameters =", "paramters =", &["unknown key", "did you mean `parameters`?"]);
    refused("flow =", "flwo =", &["flwo", "did you mean `flow`?"]);
}

#[test]
fn systems_that_lack_a_part_or_have_one_too_many_are_answered() {
    refused(", z = \"-beta*y\" }", " }", &["`z`"]);
    refused("start = { x = [-0.1, 0.1],", "start = {", &["`oscillator.custom.start", "x"]);
    refused("z = [-0.1, 0.1] }", "z = [-0.1, 0.1], w = [0, 1] }", &["start", "`w`"]);
    refused("x = [-0.1, 0.1],", "x = [0.1, -0.1],", &["start.x`", "0.1"]);
    refused("x = [-0.1, 0.1],", "x = [-0.1],", &["start.x`"]);
    refused("x = [-0.1, 0.1],", "x = [-0.1, 0.1, 7],", &["start.x`", "a list of 3"]);
    refused("x = [-0.1, 0.1],", "x = [-inf, 0.1],", &["start.x`", "finite"]);
    refused("x = [-0.1, 0.1],", "x = 0.1,", &["start.x`", "must be a list"]);
    refused("start = {", "start = [] #", &["start`", "table"]);
    refused(
        "flow = {",
        "map = { x = \"x\", y = \"y\", z = \"z\" }\nflow = {",
        &["flow", "map", "one"],
    );
    refused(
        "flow = { x = \"alpha*(y - x - f)\", y = \"x - y + z\", z = \"-beta*y\" }",
        "",
        &["flow", "map"],
    );
    let many: Vec<String> = (0..17).map(|c| format!("c{c} = \"1 - c{c}\"")).collect();
    let start: Vec<String> = (0..17).map(|c| format!("c{c} = [0, 1]")).collect();
    let system = tiny().without_table("oscillator.lorenz").and(&format!(
        "[oscillator.custom]\nflow = {{ {} }}\nstart = {{ {} }}",
        many.join(", "),
        start.join(", ")
    ));
    check_refused(&system, &["17 components, but at most 16"]);
}

#[test]
fn equations_without_a_value_where_orbits_begin_are_refused() {
    let one = |formula: &str, start: &str, expected: &[&str]| {
        let system =
            tiny().without_table("oscillator.lorenz").set("coupling.to", "\"x\"").and(&format!(
                "[oscillator.custom]\nflow = {{ x = \"{formula}\" }}\nstart = {{ x = {start} }}"
            ));
        let expected = [
            &[
                "tiny.toml:",
                "`oscillator.custom.flow.x`",
                "write it so that it has a value everywhere",
            ],
            expected,
        ]
        .concat();
        check_refused(&system, &expected);
    };
    one("1/x", "[0, 0]", &["is inf at x = 0, and not finite at 512 of 512"]);
    one("sqrt(x)", "[-1, 1]", &["is NaN at x = -"]);
    one("log(x)", "[-2, -1]", &["is NaN at x = -1", "512 of 512"]);
    one("asin(x)", "[1.5, 2]", &["is NaN"]);
    one("sqrt(x)", "[0, 0]", &["the derivative of it is inf at x = 0"]);
    let sent = chua()
        .without("coupling.from")
        .without("coupling.to")
        .set("coupling.function", "{ x = \"log(x)\" }");
    check_refused(&sent, &["`coupling.function.x`", "is NaN at x = -"]);
}

#[test]
fn equations_that_lose_their_value_on_the_way_are_refused_with_the_state_and_the_time() {
    let one = |flow: &str, expected: &[&str]| {
        let system = tiny()
            .without_table("oscillator.lorenz")
            .set("coupling.to", "\"x\"")
            .and(&format!("[oscillator.custom]\nflow = {{ {flow} }}\nstart = {{ x = [0.9, 1] }}"));
        check_refused(&system, expected);
    };
    one("x = \"-1 + 0*sqrt(x)\"", &["`oscillator.custom.flow.x`", "at x = -0.00", "comes at time"]);
    one("x = \"-1 + 0*log(x)\"", &["has no value at x = -0.00", "comes at time"]);
    // Not where orbits begin, but where they go.
    let sent = chua()
        .without("coupling.from")
        .without("coupling.to")
        .set("coupling.function", "{ x = \"sqrt(x + 0.5)\" }");
    check_refused(&sent, &["`coupling.function.x`", "is NaN at x = -", "along an isolated orbit"]);
}

#[test]
fn coupling_functions_that_make_no_sense_are_answered() {
    let with = |function: &str, expected: &[&str]| {
        let experiment = tiny()
            .without("coupling.from")
            .without("coupling.to")
            .set("coupling.function", function);
        check_refused(&experiment, expected);
    };
    with("{ y = \"v\" }", &["tiny.toml:", "`coupling.function.y`", "`v` is unknown"]);
    with("{ w = \"x\" }", &["`coupling.function.w`", "no such component; there are x, y, z"]);
    with("{ y = \"x + t\" }", &["`t` has no meaning in a coupling"]);
    with("{}", &["`coupling.function` is empty"]);
    with("{ y = \"3\" }", &["couples nothing: its derivative is zero"]);
    with("{ y = \"0*x\" }", &["couples nothing: its derivative is zero"]);
    with("[[0, 0], [1, 0]]", &["2 rows", "must be 3 × 3", "x, y, z"]);
    with("[[0, 0, 0], [1, 0], [0, 0, 0]]", &["3, 2, 3", "must be 3 × 3"]);
    with("[[0, 0, 0], [0, 0, 0], [0, 0, 0]]", &["is zero, which couples nothing"]);
    with("[[0, 0, 0], [nan, 0, 0], [0, 0, 0]]", &["must be finite"]);
    with("[[0, 0, 0], [\"a\", 0, 0], [0, 0, 0]]", &["`coupling.function`", "a number"]);
    with("\"tanh(x)\"", &["`coupling.function`", "function = { y = \"x\" }"]);
    check_refused(
        &tiny().set("coupling.function", "{ y = \"x\" }"),
        &["`coupling.from` says again what is coupled"],
    );
    check_refused(
        &tiny().set("coupling.parameters", "{ k = 2 }"),
        &["`coupling.parameters` has no effect here"],
    );
    check_refused(&tiny().without("coupling.from"), &["`coupling.from` is missing", "function ="]);
    check_refused(&tiny().set("escape_radius", "0"), &["`escape_radius` is 0", "above zero"]);
}

#[test]
fn a_map_is_not_integrated_and_a_flow_is_not_iterated() {
    let map = || {
        tiny()
            .without_table("oscillator.lorenz")
            .set("coupling.to", "\"x\"")
            .and("[oscillator.custom]\nmap = { x = \"4*x*(1 - x)\" }\nstart = { x = [0.1, 0.9] }")
    };
    check_refused(&map(), &["`msf.step` is 0.01, but a map goes in steps of 1", "leave it out"]);
    let stepless = || map().without("msf.step").set("msf.average", "1000");
    check_refused(&stepless(), &["`sweep.step` is 0.01, but a map goes in steps of 1"]);
    let half = stepless().without("sweep.step").set("msf.renormalise", "0.5");
    check_refused(&half, &["`msf.renormalise` is 0.5, but a map goes in steps of 1"]);
    let integrated = stepless().without("sweep.step").set("sweep.method", "\"rk4\"");
    check_refused(&integrated, &["`sweep.method` integrates a flow, but the oscillator is a map"]);
    check_refused(
        &tiny().set("sweep.method", "\"iterate\""),
        &["`sweep.method` is \"iterate\", which is for maps", "rk4"],
    );
}
