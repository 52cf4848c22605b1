//! Numbers that make no sense, or more work than any machine can do.

use crate::support::{Workplace, tiny};
use crate::{check_answer, check_refused};

#[test]
fn oscillator_parameters_must_be_finite() {
    for value in ["nan", "inf", "-inf"] {
        check_refused(
            &tiny().set("oscillator.lorenz.r", value),
            &["`oscillator.lorenz.r` must be finite"],
        );
    }
}

#[test]
fn steps_and_times_must_be_positive() {
    for key in ["msf.step", "msf.average", "msf.renormalise", "msf.relative_error", "sweep.step"] {
        for value in ["0", "-0.01", "nan", "inf"] {
            check_refused(&tiny().set(key, value), &[key, "must be finite and above zero"]);
        }
    }
    for key in ["sweep.average", "sweep.tolerance", "sweep.synchronised_below"] {
        let adaptive = tiny().set("sweep.method", "\"dopri5\"");
        check_refused(&adaptive.set(key, "0"), &[key, "is 0, but must be finite and above zero"]);
    }
    for key in ["msf.transient", "sweep.transient"] {
        check_refused(&tiny().set(key, "-1"), &[key, "is -1, but must be finite and not negative"]);
    }
}

#[test]
fn an_average_shorter_than_its_blocks_is_refused_with_the_least_that_will_do() {
    check_refused(
        &tiny().set("sweep.average", "0.5"),
        &["`sweep.average` is 0.5, but the 20 blocks", "need 2 or more", "`sweep.stride`"],
    );
    check_refused(
        &tiny().set("msf.average", "3"),
        &["`msf.average` is 3", "need 10 or more", "20 × `msf.renormalise`"],
    );
    // Whole steps of 0.3 make an interval of 0.6 out of 0.5.
    check_refused(&tiny().set("msf.step", "0.3").set("msf.average", "11"), &["need 12 or more"]);
    check_refused(&tiny().set("sweep.stride", "4294967295"), &["need 8.58993459e8 or more"]);
}

#[test]
fn a_shorter_average_that_only_quick_makes_too_short_says_so() {
    let place = Workplace::new();
    place.write("tiny.toml", &tiny().set("sweep.average", "10").0);
    place.answer(&["check", "tiny.toml"]).with_status(0);
    let answer = place.answer(&["run", "--quick", "tiny.toml"]);
    check_answer(&place, answer, "tiny.toml", &["need 20 or more", "ten times more with --quick"]);
}

#[test]
fn a_grid_must_have_points_that_ascend() {
    let epsilon = |grid: &str, expected: &[&str]| {
        check_refused(
            &tiny().set("sweep.epsilon", grid),
            &[&["`sweep.epsilon"], expected].concat(),
        );
    };
    epsilon("[]", &["has 0 points, but needs 1 or more"]);
    epsilon("{ from = 1, to = 2, points = 0 }", &["has 0 points"]);
    epsilon("{ from = 1, to = 2, points = 1 }", &["has 1 point, but runs from 1 to 2"]);
    epsilon(
        "{ from = 5, to = 1, points = 5 }",
        &["runs down from 5 to 1", "exchange `from` and `to`"],
    );
    epsilon("[2, 1, 2]", &["contains 2 more than once"]);
    epsilon("{ from = -1, to = 1, points = 3 }", &["is -1, but must be finite and not negative"]);
    check_refused(&tiny().set("msf.sigma", "[3.0]"), &["`msf.sigma` has 1 point, but needs 2"]);
}

#[test]
fn a_grid_must_be_finite() {
    let epsilon = |grid: &str, expected: &str| {
        check_refused(&tiny().set("sweep.epsilon", grid), &["`sweep.epsilon", expected]);
    };
    epsilon("{ from = nan, to = 2, points = 3 }", "from` is NaN, but must be finite");
    epsilon("{ from = 1, to = inf, points = 3 }", "to` is inf, but must be finite");
    epsilon("[1, nan]", "contains NaN; its values must be finite");
}

#[test]
fn a_threshold_must_be_positive() {
    for value in ["-0.1", "0", "nan"] {
        check_refused(
            &tiny().and(&format!("[prediction]\nthreshold = {value}")),
            &["`prediction.threshold`", "must be finite and above zero"],
        );
    }
    check_refused(
        &tiny().and("[prediction]\nthreshold = \"exactly\""),
        &["is the text \"exactly\", but must be \"exact\" or a number"],
    );
}

#[test]
fn zero_seeds_and_zero_stride_are_refused() {
    for key in ["sweep.seeds", "sweep.stride"] {
        check_refused(&tiny().set(key, "0"), &[key, "is 0, but must be finite and above zero"]);
    }
}

#[test]
fn grids_and_seeds_beyond_all_memory_are_refused() {
    let points = |points: &str| tiny().replace("points = 5", &format!("points = {points}"));
    check_refused(
        &points("4000000000"),
        &["`sweep.epsilon.points` is 4e9, but the most is 1000000"],
    );
    check_refused(&points("5000000000"), &["sweep.epsilon.points", "from 0 to 4294967295"]);
    check_refused(
        &points("100000000000000000000"),
        &["sweep.epsilon.points", "whole number from 0"],
    );
    check_refused(
        &tiny().set("sweep.seeds", "1000000000000000000"),
        &["`sweep.seeds` is 1e18, which makes 5e18 runs at 5 values of epsilon"],
    );
    let nodes: String = (1..=2000).map(|node| format!("{node}\n")).collect();
    let place = Workplace::new();
    place.write("networks/six-node.edges", nodes);
    place.write("tiny.toml", tiny().set("sweep.seeds", "1000").0);
    let answer = place.answer(&["run", "tiny.toml"]);
    check_answer(&place, answer, "`sweep` keeps", &["5000 runs of 2000 nodes", "160 GB", "fewer"]);
}

#[test]
fn times_that_no_machine_will_ever_compute_are_refused() {
    for (key, value) in [("average", "1e300"), ("transient", "1e300"), ("step", "1e-300")] {
        for table in ["msf", "sweep"] {
            let experiment = tiny().set(&format!("{table}.{key}"), value);
            let names_table = format!("`{table}` asks for ");
            check_refused(
                &experiment,
                &[&names_table, "which would take years", "the most is 1e16"],
            );
        }
    }
}

#[test]
fn a_step_too_long_for_its_coupling_is_refused() {
    // x into x damps a perturbation at the rate σ itself. Let through, σ = 300 would have Λ > 0 and
    // the stable set an upper end near 268, where (σ + α) h = 2.785: the integrator's, not Lorenz's.
    let x_into_x = || tiny().set("coupling.to", "\"x\"");
    check_refused(
        &x_into_x().set("msf.sigma", "[0, 300]"),
        &["`msf.step` is 0.01, too long for RK4 at sigma = 300", "hint: take a step of 0.00"],
    );
    // λ_6 = −6, although the strongest node has a strength of 3.5 only.
    check_refused(
        &x_into_x().set("sweep.epsilon", "[1, 50]"),
        &["`sweep.step` is 0.01, too long for RK4 at sigma = 300, epsilon = 50 times |λ_N| = 6"],
    );
}

#[test]
fn a_step_too_long_is_refused_whichever_component_enters_which() {
    // x into y makes pairs of rates ±i √(ασ): RK4 ends at √(ασ) h = 2√2, or σ = 8000.
    check_refused(
        &tiny().set("msf.sigma", "[0, 10000]"),
        &["`msf.step` is 0.01, too long for RK4 at sigma = 10000", "it holds up to sigma = 8"],
    );
    check_refused(
        &tiny().set("sweep.epsilon", "[1, 2000]"),
        &["`sweep.step` is 0.01, too long for RK4", "|λ_N| = 6", "dop853"],
    );
}

#[test]
fn an_adaptive_method_takes_its_own_steps() {
    let adaptive = tiny().set("sweep.epsilon", "[2000]").and("").set("sweep.method", "\"dop853\"");
    let place = Workplace::new();
    place.write("tiny.toml", &adaptive.0);
    place.answer(&["check", "tiny.toml"]).with_status(0);
}

#[test]
fn an_oscillator_that_escapes_by_itself_is_refused() {
    check_refused(
        &tiny().without_table("oscillator.lorenz").and("[oscillator.rossler]\na = 0.5\nc = -9.0"),
        &["the isolated orbit escapes at time", "parameters of [oscillator.rossler]", "`msf.step`"],
    );
}

#[test]
fn perturbations_that_outgrow_all_numbers_are_refused() {
    check_refused(
        &tiny().set("msf.sigma", "{ from = 0, to = 1e300, points = 3 }"),
        &["`msf.step` is 0.01, too long for RK4 at sigma = 1e300", "hint: end the grid earlier"],
    );
}

#[test]
fn a_relative_bound_is_a_fraction() {
    let set = |value: &str| tiny().set("sweep.synchronised_below", value);
    check_refused(
        &set("{ of_largest = 1.5 }"),
        &["`sweep.synchronised_below.of_largest` is 1.5, but must be between 0 and 1"],
    );
    check_refused(&set("{ of_larges = 0.1 }"), &["of_larges", "`of_largest`"]);
    check_refused(&set("\"small\""), &["must be a number or { of_largest = … }"]);
    let regions = "[regions]\ndistance_within = -1\ndistance_between = 1\n\
                   error_within = 1\nerror_between = 1";
    check_refused(&tiny().and(regions), &["`regions` needs groups"]);
    let groups = "[groups.ranges]\nA = [1, 3]\n";
    check_refused(
        &tiny().and(&format!("{groups}{regions}")),
        &["`regions.distance_within` is -1, but must be finite and above zero"],
    );
}

#[test]
fn series_of_what_is_not_there_are_refused() {
    let with = |keys: &str| tiny().and(&format!("\n[sweep.series]\n{keys}\n"));
    for (keys, said) in [
        ("nodes = []", "`sweep.series.nodes` is empty, but needs a node"),
        ("nodes = [7]", "`sweep.series.nodes` names node \"7\", which the network does not have"),
        ("nodes = [1, 1]", "`sweep.series.nodes` has node \"1\" twice"),
        ("nodes = [1]\ncomponents = [\"w\"]", "`sweep.series.components` is \"w\""),
        ("nodes = [1]\ncomponents = []", "`sweep.series.components` is empty"),
        ("nodes = [1]\ncomponents = [\"x\", \"x\"]", "components` has \"x\" more than once"),
        ("nodes = [1]\nevery = 0", "`sweep.series.every` is 0, but must be 1 or more"),
        ("nodes = [1]\nseeds = 3", "`sweep.series.seeds` is 3, but the sweep has 2 seeds"),
        ("nodes = [1]\nfrom = -1", "`sweep.series.from` is -1"),
        ("nodes = [1]\nfrom = 50\nto = 45", "`sweep.series` asks for no state"),
        ("nodes = [1]\nfrom = 1e9", "`sweep.series` asks for no state"),
        ("nodes = [1]\nto = 20", "`from`, which is 40 where it is left out"),
        ("nodes = [1]\nto = 1e9", "`sweep.series.to` is 1e9, but a run ends at 80"),
        ("nodes = [1]\nepsilon = [1.0, 1.0]", "`sweep.series.epsilon` contains 1 more than once"),
        ("nodes = [1]\nepsilon = [1.5]", "`sweep.series.epsilon` has 1.5, which is not a point"),
        ("nodes = [1]\nepsilon = []", "`sweep.series.epsilon` is empty"),
        ("nodes = [1]\nevry = 2", "unknown key `sweep.series.evry`"),
    ] {
        check_refused(&with(keys), &[said]);
    }
    let endless = with("nodes = [1]").set("sweep.average", "1e9");
    check_refused(&endless, &["`sweep.series` asks for", "the most is", "every"]);
}
