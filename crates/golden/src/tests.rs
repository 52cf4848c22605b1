//! Summaries that differ, key by key.

use serde_json::{Value, json};

use crate::{Comparison, compare_summaries};

fn summary() -> Value {
    json!({
        "shortened": 1.0,
        "experiment": { "sweep": { "step": 0.01 } },
        "eigenvalues": [0.0, -2.0, -3.0],
        "msf": { "sigma_c": 8.17, "standard_error": 0.004, "zeros": [{ "sigma": 8.17, "standard_error": 0.004 }] },
        "cascade": [{ "epsilon": [2.7, 4.1], "clusters": [["1", "2"]] }],
        "simulations": [{ "epsilon": 1.0, "error_within_clusters": [{ "mean": 9.0, "standard_error": 0.1 }] }],
        "provenance": { "wall_time_s": 1.0 },
    })
}

fn after(change: impl FnOnce(&mut Value)) -> Comparison {
    let mut changed = summary();
    change(&mut changed);
    compare_summaries(&summary(), &changed)
}

#[test]
fn equal_summaries_need_no_line() {
    assert!(after(|_| ()).lines().is_empty());
    assert!(after(|s| s["provenance"]["wall_time_s"] = json!(2.0)).lines().is_empty());
}

#[test]
fn a_changed_parameter_is_named() {
    let comparison = after(|s| s["experiment"]["sweep"]["step"] = json!(0.02));
    assert!(!comparison.holds());
    let line = "experiment.sweep.step: expected 0.01, obtained 0.02, allowed none";
    assert_eq!(comparison.lines(), [line]);
}

#[test]
fn eigenvalues_are_judged_to_nine_digits() {
    assert!(after(|s| s["eigenvalues"][1] = json!(-2.000_000_001)).holds());
    assert!(!after(|s| s["eigenvalues"][1] = json!(-2.000_001)).holds());
}

#[test]
fn statistical_values_are_judged_by_five_joint_standard_errors() {
    let shift = |by: f64| after(|s| s["msf"]["sigma_c"] = json!(8.17 + by));
    let band = 5.0 * 0.004 * 2f64.sqrt();
    assert!(shift(0.9 * band).holds());
    assert!(!shift(1.1 * band).holds());
    let half = shift(0.5 * band);
    let lines = half.lines();
    let [line] = &lines[..] else { panic!("{lines:?}") };
    assert!(line.starts_with("msf.sigma_c: expected 8.17, obtained 8.18"), "{line}");
    assert!(line.ends_with(": within ± 2.83e-2, 0.50 of it"), "{line}");
}

#[test]
fn a_moved_cluster_or_a_missing_quantity_is_a_failure() {
    assert!(!after(|s| s["cascade"][0]["clusters"][0][1] = json!("3")).holds());
    assert!(!after(|s| _ = s.as_object_mut().unwrap().remove("eigenvalues")).holds());
    assert!(!after(|s| s["eigenvalues"] = json!([0.0, -2.0])).holds());
    assert!(!after(|s| s["msf"]["sigma_c"] = Value::Null).holds());
}

#[test]
fn an_onset_that_was_not_found_lies_beyond_the_sweep() {
    // Steps of 1 allow two of them, from an onset at 5.5 to the end of the sweep at 6, not to one at 8.
    let onset = |last: u32| {
        let mut expected = summary();
        expected["simulations"] =
            (3..=last).map(|epsilon| json!({ "epsilon": f64::from(epsilon) })).collect();
        let mut obtained = expected.clone();
        expected["cascade"][0]["simulated_onset"] = json!({ "mean": 5.5, "spread": 0.0 });
        obtained["cascade"][0]["simulated_onset"] = json!({ "mean": null, "spread": null });
        compare_summaries(&expected, &obtained).holds()
    };
    assert!(onset(6));
    assert!(!onset(8));
}

#[test]
fn a_shortened_run_has_wider_bands() {
    let error = |by: f64, shortened: f64| {
        after(|s| {
            s["shortened"] = json!(shortened);
            s["simulations"][0]["error_within_clusters"][0]["mean"] = json!(9.0 + by);
        })
        .holds()
    };
    assert!(!error(1.5, 1.0));
    assert!(error(1.5, 10.0));
}

#[test]
fn what_a_quick_run_simulates_is_left_to_a_full_one() {
    let comparison = after(|s| {
        s["shortened"] = json!(10.0);
        s["simulations"][0]["error_within_clusters"][0]["mean"] = json!(99.0);
    });
    assert!(comparison.holds());
    assert!(comparison.open()[0].ends_with(": a full run decides"), "{:?}", comparison.lines());
    let changed = after(|s| {
        s["shortened"] = json!(10.0);
        s["eigenvalues"][1] = json!(-2.1);
    });
    assert!(!changed.holds());
}

#[test]
fn a_number_whose_own_error_is_huge_is_not_equal_to_anything() {
    let zero = |sigma: f64, error: f64| {
        after(|s| {
            s["msf"]["sigma_c"] = json!(sigma);
            s["msf"]["standard_error"] = json!(error);
        })
    };
    assert!(zero(8.171, 0.006).holds());
    // 125 ± 125 is within one of its standard errors of everything.
    for (sigma, error) in [(125.0, 125.0), (8.18, 125.0), (8.18, 1.0)] {
        let comparison = zero(sigma, error);
        assert!(!comparison.holds(), "{sigma} ± {error}");
        let cannot = comparison.lines().iter().any(|line| line.contains("cannot be judged"));
        assert!(cannot, "{:?}", comparison.lines());
    }
}

#[test]
fn a_zero_that_could_not_be_refined_equals_no_other() {
    let comparison = after(|s| {
        s["msf"]["zeros"][0] = json!({ "sigma": 8.171, "standard_error": 0.004, "refined": false });
    });
    assert!(!comparison.holds());
    let said = comparison.lines().iter().any(|line| line.contains("could not be refined"));
    assert!(said, "{:?}", comparison.lines());
}

#[test]
fn a_golden_number_that_is_not_known_judges_nothing() {
    let mut golden = summary();
    golden["msf"]["sigma_c"] = json!(125.0);
    golden["msf"]["standard_error"] = json!(125.0);
    assert!(!compare_summaries(&golden, &summary()).holds());
}

#[test]
fn an_error_near_synchrony_is_judged_by_the_golden_band_alone() {
    let expected = |mean: f64, error: f64| {
        let mut summary = summary();
        let weaker = json!({ "epsilon": 2.0, "error_within_clusters": [{ "mean": mean, "standard_error": error }] });
        summary["simulations"].as_array_mut().unwrap().push(weaker);
        summary
    };
    let holds = |golden: (f64, f64), own: (f64, f64)| {
        compare_summaries(&expected(golden.0, golden.1), &expected(own.0, own.1)).holds()
    };
    assert!(holds((0.01, 0.01), (0.03, 0.02)), "bursts");
    assert!(!holds((0.01, 0.01), (5.0, 5.0)), "an error of its own that takes in everything");
    assert!(holds((1e-13, 1e-15), (3e-13, 1e-13)), "rounding");
}

#[test]
fn correlations_are_judged_within_the_band_of_their_seeds() {
    let with = |pearson: f64, rand_index: f64, error: Option<f64>| {
        let mut summary = summary();
        summary["simulations"][0]["agreement"] =
            json!({ "pearson": pearson, "adjusted_rand_index": rand_index });
        if let Some(error) = error {
            summary["simulations"][0]["agreement"]["pearson_standard_error"] = json!(error);
        }
        summary
    };
    let golden = with(0.8, 1.0, None);
    assert!(compare_summaries(&golden, &with(0.81, 0.98, None)).holds());
    assert!(!compare_summaries(&golden, &with(0.7, 1.0, None)).holds());
    assert!(!compare_summaries(&golden, &with(0.8, 0.0, None)).holds());
    // Without an error in the golden output the obtained one widens the band a little only.
    assert!(compare_summaries(&golden, &with(0.75, 1.0, Some(0.5))).holds());
    assert!(!compare_summaries(&golden, &with(0.2, 1.0, Some(0.5))).holds());
    let golden = with(0.8, 1.0, Some(0.04));
    assert!(compare_summaries(&golden, &with(0.65, 1.0, Some(0.04))).holds());
}

#[test]
fn a_new_key_is_mentioned_and_a_new_parameter_is_a_failure() {
    let comparison = after(|s| s["simulations"][0]["n_seeds"] = json!(4));
    assert!(comparison.holds());
    assert_eq!(comparison.lines(), ["simulations[0].n_seeds is new: not judged"]);
    assert!(!after(|s| s["experiment"]["sweep"]["kick"] = json!(0.0)).holds());
}

fn atlas(shortened: f64, class: &str, zero: f64) -> Value {
    let zeros = json!([{ "sigma": zero, "standard_error": 0.01 }]);
    let msf = json!({ "zeros": zeros, "stable": [[zero, null]], "doubtful": [] });
    json!({ "shortened": shortened, "atlas": [{ "class": class, "msf": msf }] })
}

#[test]
fn a_pair_of_an_atlas_is_judged_by_the_errors_of_its_own_zeros() {
    let golden = atlas(1.0, "Γ1", 2.0);
    assert!(compare_summaries(&golden, &atlas(1.0, "Γ1", 2.06)).holds());
    let moved = compare_summaries(&golden, &atlas(1.0, "Γ1", 2.08));
    assert_eq!(moved.failures().len(), 2, "the zero, and the window it bounds");
}

#[test]
fn a_class_that_a_quick_run_does_not_see_is_left_to_a_full_one() {
    let golden = atlas(1.0, "Γ1", 2.0);
    assert!(!compare_summaries(&golden, &atlas(1.0, "Γ0", 2.0)).holds());
    let quick = compare_summaries(&golden, &atlas(10.0, "Γ0", 2.0));
    assert!(quick.holds() && quick.open().len() == 1);
}
