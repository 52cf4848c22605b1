//! Claims that could not be judged, found before anything is computed.

use crate::check_refused;
use crate::support::{Toml, tiny};

/// An experiment with one more claim, of a quantity with some keys.
fn claim(of: &str, keys: &str) -> Toml {
    tiny().and(&format!("[claims.more]\nof = \"{of}\"\n{keys}"))
}

#[test]
fn a_claim_states_one_value() {
    let one_of = "`claims.more` must have exactly one of `equals`, `at_most`, `at_least`, `trend`";
    check_refused(&claim("msf.sigma_c", ""), &[one_of]);
    check_refused(&claim("msf.sigma_c", "equals = 8.3\nat_most = 9"), &[one_of]);
}

#[test]
fn a_claim_states_a_value_of_the_right_shape() {
    let check = |of: &str, keys: &str, expected: &str| {
        check_refused(&claim(of, keys), &["`claims.more.equals`", expected]);
    };
    check("msf.sigma_c", "equals = \"large\"", "must be a number or a list of numbers");
    check("msf.sigma_c", "equals = nan", "contains NaN, but must be finite");
    check("msf.sigma_c", "equals = [8.3, 9]", "has 2 values, expected 1");
    let modes = "where.modes = [2, 3]\n";
    check("critical_couplings", &format!("{modes}equals = [4]"), "has 1 values, expected 2");
    check("eigenvectors", &format!("{modes}equals = [[1]]"), "2 vectors of 6 components");
    let epsilon = "where.epsilon = 2.0\n";
    check("cascade.clusters", &format!("{epsilon}equals = [1, 2]"), "must be a list of clusters");
    check("cascade.clusters", &format!("{epsilon}equals = [[1]]"), "two nodes or more");
    let clusters = "where.clusters = [[1, 2], [3, 4]]\n";
    check("cascade.order_of_loss", &format!("{clusters}equals = [1]"), "positions 1 to 2 once");
    check("cascade.order_of_loss", &format!("{clusters}equals = [1, 3]"), "positions 1 to 2 once");
}

#[test]
fn a_claim_names_the_instance_that_it_is_about() {
    check_refused(
        &claim("simulated.clusters", "equals = []"),
        &["claims.more", "needs `where.epsilon`"],
    );
    check_refused(&claim("eigenvectors", "equals = [[1]]"), &["`claims.more` needs `where.modes`"]);
    check_refused(&claim("simulated.onset", "equals = 2"), &["needs `where.clusters`"]);
    check_refused(
        &claim("msf.sigma_c", "where.epsilon = 2.0\nequals = 8.3"),
        &["`claims.more.where.epsilon` means nothing for this quantity"],
    );
    check_refused(
        &claim("critical_couplings", "where.modes = [0]\nequals = [1]"),
        &["`claims.more.where.modes` has mode 0, but the modes computed are 1 to 6"],
    );
    check_refused(
        &claim("critical_couplings", "where.modes = [3]\nequals = [1]")
            .and("[spectrum]\nmodes = 2"),
        &["has mode 3, but the modes computed are 1 to 2"],
    );
    check_refused(
        &claim("simulated.onset", "where.clusters = []\nequals = 1"),
        &["`claims.more.where.clusters` is empty"],
    );
    check_refused(
        &claim("cascade.clusters", "where.eps = 1"),
        &["unknown key `claims.more.where.eps`"],
    );
}

#[test]
fn a_claim_about_a_simulation_names_a_coupling_of_the_sweep() {
    check_refused(
        &claim("simulated.clusters", "where.epsilon = 2.2\nequals = []"),
        &["`claims.more.where.epsilon` is 2.2, which is not a point of", "the nearest point is 2"],
    );
    check_refused(
        &claim("simulated.clusters", "where.epsilon = 2.0\nequals = []").without_table("sweep"),
        &["`claims.more` is about simulations, but there is no [sweep]"],
    );
}

#[test]
fn a_tolerance_is_not_negative_and_has_an_effect() {
    check_refused(&tiny().set("claims.integers.abs_tol", "-1"), &["is -1, but must be finite"]);
    check_refused(
        &tiny().set("claims.integers.abs_tol", "nan"),
        &["claims.integers.abs_tol", "NaN"],
    );
    check_refused(
        &claim("cascade.clusters", "where.epsilon = 2.0\nequals = []\nrel_tol = 0.1"),
        &["`claims.more.rel_tol` has no effect on this claim"],
    );
}

#[test]
fn a_trend_compares_two_numbers_or_more() {
    let alone = "where.epsilon = 2.0\ntrend = \"rises\"";
    let refused = "`claims.more.trend` needs two numbers or more";
    check_refused(&claim("agreement.pearson", alone), &[refused]);
    check_refused(&claim("cascade.clusters", alone), &[refused]);
    check_refused(
        &claim("cascade.clusters", "where.epsilon = [2.0, 3.0]\nequals = []"),
        &["`claims.more.where.epsilon` has several values, but must be one here"],
    );
    check_refused(
        &claim("agreement.pearson", "where.epsilon = []\nat_least = 0"),
        &["`claims.more.where.epsilon` is empty"],
    );
}

#[test]
fn a_claim_about_regions_needs_their_thresholds() {
    check_refused(
        &claim("regions.predicted", "where.epsilon = 2.0\nequals = []"),
        &["`claims.more` is about regions, but there is no [regions]"],
    );
    check_refused(
        &claim("msf.sigma_c", "where.group_prefix = \"r\"\nequals = 8.3"),
        &["`claims.more.where.group_prefix` means nothing for this quantity"],
    );
}
