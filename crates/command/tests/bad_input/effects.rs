//! Keys without effect, modes that are not computed, and numbers beyond their range.

use crate::check_refused;
use crate::support::tiny;

#[test]
fn eigenvectors_of_a_figure_are_modes_that_are_computed() {
    let figure =
        |modes: &str| tiny().and(&format!("[figure]\nkind = \"matrices\"\neigenvectors = {modes}"));
    let key = "`figure.eigenvectors`";
    check_refused(&figure("[0]"), &[key, "has mode 0, but the modes computed are 1 to 6"]);
    check_refused(&figure("[99]"), &[key, "has mode 99, but the modes computed are 1 to 6"]);
    check_refused(&figure("[]"), &[key, "is empty", "leave it out for modes 2, 3 and 4"]);
    check_refused(&figure("[2, 3, 2]"), &[key, "has mode 2 more than once"]);
    let some = figure("[3]").and("[spectrum]\nmodes = 2");
    check_refused(&some, &[key, "has mode 3, but the modes computed are 1 to 2"]);
    let marked = tiny().and("[figure]\nmark_modes = [3]\n[spectrum]\nmodes = 2");
    check_refused(&marked, &["`figure.mark_modes` has mode 3, but the modes computed are 1 to 2"]);
}

#[test]
fn keys_that_would_change_nothing_are_refused_with_the_reason() {
    let figure = |keys: &str| tiny().and(&format!("[figure]\n{keys}"));
    let refused = |key: &str| format!("`{key}` has no effect here: ");
    for (keys, key) in [
        ("eigenvectors = [2]", "figure.eigenvectors"),
        ("kind = \"matrices\"\nletter = \"b\"", "figure.letter"),
        ("kind = \"matrices\"\nmark_modes = [2]", "figure.mark_modes"),
        ("kind = \"matrices\"\nerror_scale = \"log\"", "figure.error_scale"),
        ("kind = \"none\"\nlayout = \"circle\"", "figure.layout"),
    ] {
        check_refused(&figure(keys), &[&refused(key), "leave it out"]);
    }
    let predicted = |keys: &str| figure(keys).without_table("sweep");
    for (keys, key) in [
        ("source_transitions = [1.0]", "figure.source_transitions"),
        ("spread = \"bars\"", "figure.spread"),
    ] {
        check_refused(&predicted(keys), &[&refused(key), "without a [sweep]"]);
    }
    check_refused(
        &tiny().set("sweep.tolerance", "1e-6"),
        &["`sweep.tolerance` has no effect here", "rk4", "dopri5"],
    );
    check_refused(
        &tiny().set("sweep.method", "\"auto\""),
        &["`sweep.step` has no effect here", "chooses it", "leave it out"],
    );
    let thresholds =
        "distance_within = 1\ndistance_between = 1\nerror_within = 1\nerror_between = 1";
    check_refused(
        &tiny().without_table("sweep").and(&format!("[regions]\n{thresholds}")),
        &["`regions` has no effect: regions are compared at the couplings of a [sweep]"],
    );
    for (key, value) in [("variable", "\"A\""), ("block", "[1, 2]"), ("rows", "\"driving\"")] {
        let key = format!("network.file.{key}");
        check_refused(&tiny().set(&key, value), &[&refused(&key)]);
    }
}

#[test]
fn numbers_beyond_their_range_are_refused_with_both_ends_and_the_reason() {
    let adaptive = || tiny().set("sweep.method", "\"dopri5\"");
    for (experiment, expected) in [
        (
            tiny().set("sweep.kick", "1e308"),
            "`sweep.kick` is 1e308, but must be between 1e-16 and 0.001",
        ),
        (tiny().set("sweep.kick", "1e-300"), "`sweep.kick` is 1e-300, but must be between"),
        (adaptive().set("sweep.tolerance", "1e300"), "must be between 1e-14 and 0.01"),
        (adaptive().set("sweep.tolerance", "1e-15"), "must be between 1e-14 and 0.01"),
        (tiny().set("sweep.synchronised_below", "1e308"), "must be between 1e-300 and 1000000"),
        (tiny().set("sweep.step", "11").set("sweep.average", "1e6"), "must be between 1e-9 and 10"),
        (tiny().set("msf.relative_error", "1e300"), "must be between 1e-6 and 1"),
        (tiny().set("msf.relative_error", "1e-9"), "must be between 1e-6 and 1"),
        (tiny().set("oscillator.lorenz.r", "9223372036854775807"), "must be between -1000000 and"),
        (tiny().and("[prediction]\nthreshold = 1e308"), "must be between 1e-300 and 12"),
    ] {
        check_refused(&experiment, &[expected, "hint: "]);
    }
}
