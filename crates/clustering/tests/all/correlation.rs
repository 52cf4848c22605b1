//! Correlations: closed forms, scipy's values, invariances, and what is not defined.

use clustering::{EigenvectorDistance, correlation_of_pairs, pearson, spearman};
use proptest::prelude::*;

use crate::fixtures::nepal;

#[track_caller]
fn check_close(obtained: Option<f64>, expected: f64, tolerance: f64) {
    let obtained = obtained.expect("a correlation");
    assert!((obtained - expected).abs() <= tolerance, "{obtained} instead of {expected}");
}

#[test]
fn a_rising_line_has_correlation_one_and_a_falling_one_minus_one() {
    let x = [0.3, -2.0, 7.5, 1.0 / 3.0];
    for (slope, expected) in [(0.07, 1.0), (-31.0, -1.0)] {
        let y = x.map(|x| 5.0 + slope * x);
        check_close(pearson(&x, &y), expected, 1e-15);
        check_close(spearman(&x, &y), expected, 1e-15);
    }
}

#[test]
fn one_two_three_and_one_three_two_have_correlation_one_half() {
    // Deviations −1, 0, 1 and −1, 1, 0: r = 1 / √(2 · 2). They are their own ranks.
    check_close(pearson(&[1.0, 2.0, 3.0], &[1.0, 3.0, 2.0]), 0.5, 1e-15);
    check_close(spearman(&[1.0, 2.0, 3.0], &[1.0, 3.0, 2.0]), 0.5, 1e-15);
}

#[test]
fn a_cube_has_rank_correlation_one_and_a_linear_one_below() {
    // x = −2 … 2, y = x³: r = Σ x⁴ / √(Σ x² Σ x⁶) = 34 / √(10 · 130).
    let x = [-2.0, -1.0, 0.0, 1.0, 2.0];
    let y = x.map(|x: f64| x.powi(3));
    check_close(pearson(&x, &y), 34.0 / 1300f64.sqrt(), 1e-15);
    check_close(spearman(&x, &y), 1.0, 1e-15);
}

#[test]
fn tied_values_share_their_mean_rank() {
    // Ranks 1.5, 1.5, 3 and 1, 2, 3: deviations −½, −½, 1 and −1, 0, 1, ρ = 1.5 / √(1.5 · 2).
    check_close(spearman(&[7.0, 7.0, 9.0], &[0.1, 0.2, 0.3]), 0.75f64.sqrt(), 1e-15);
    // Zeros of either sign are equal.
    check_close(spearman(&[0.0, -0.0, 9.0], &[0.2, 0.1, 0.3]), 0.75f64.sqrt(), 1e-15);
}

#[test]
fn correlations_agree_with_scipy() {
    // scipy 1.17.1:
    // x = [1, 2, 2, 3, 3, 3]; y = [2, 1, 4, 4, 0.5, 9]
    // print(repr(pearsonr(x, y)[0]), repr(spearmanr(x, y)[0]))
    let (x, y) = ([1.0, 2.0, 2.0, 3.0, 3.0, 3.0], [2.0, 1.0, 4.0, 4.0, 0.5, 9.0]);
    check_close(pearson(&x, &y), 0.36813435599279504, 1e-14);
    check_close(spearman(&x, &y), 0.20352289460267362, 1e-14);
    // x = [k*k*37 % 101 for k in range(60)]; y = [(x[k] + k*53 % 29)//7 for k in range(60)]
    let x: Vec<u32> = (0..60).map(|k| k * k * 37 % 101).collect();
    let y: Vec<f64> = (0..60).zip(&x).map(|(k, x)| f64::from((x + k * 53 % 29) / 7)).collect();
    let x: Vec<f64> = x.into_iter().map(f64::from).collect();
    check_close(pearson(&x, &y), 0.9635450943163113, 1e-14);
    check_close(spearman(&x, &y), 0.953307905907278, 1e-14);
}

#[test]
fn a_correlation_with_a_constant_is_not_defined() {
    // The mean of 0.1 three times is not 0.1 in double precision.
    for (x, y) in [([0.1; 3], [1.0, 2.0, 4.0]), ([1.0, 2.0, 4.0], [0.1; 3]), ([0.0; 3], [0.0; 3])] {
        assert_eq!((pearson(&x, &y), spearman(&x, &y)), (None, None));
    }
}

#[test]
fn a_correlation_of_fewer_than_two_values_or_of_infinite_ones_is_not_defined() {
    assert_eq!((pearson(&[], &[]), spearman(&[1.0], &[2.0])), (None, None));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (x, y) = ([1.0, 2.0, 3.0], [1.0, bad, 2.0]);
        assert_eq!((pearson(&x, &y), pearson(&y, &x)), (None, None));
        assert_eq!((spearman(&x, &y), spearman(&y, &x)), (None, None));
    }
}

#[test]
fn values_at_the_ends_of_double_precision_are_correlated_all_the_same() {
    for scale in [1e-320, 1e-200, 1e300] {
        let (x, y) = ([scale, 2.0 * scale, 3.0 * scale], [1.0, 3.0, 2.0]);
        check_close(pearson(&x, &y), 0.5, 1e-3);
        check_close(spearman(&x, &y), 0.5, 1e-15);
    }
}

#[test]
#[should_panic(expected = "samples of 2 and 3 values")]
fn samples_of_different_lengths_cannot_be_correlated() {
    pearson(&[1.0, 2.0], &[1.0, 2.0, 3.0]);
}

#[test]
fn an_error_proportional_to_the_distance_has_correlation_one_over_pairs() {
    let distance = EigenvectorDistance::new(&nepal(), &[1, 2]).unwrap();
    let error = |i, j| 3.7 * distance.between(i, j);
    let found = correlation_of_pairs(15, |i, j| distance.between(i, j), error).unwrap();
    check_close(Some(found.pearson), 1.0, 1e-14);
    // Distances that are equal but for rounding need not round alike.
    check_close(Some(found.spearman), 1.0, 0.01);
}

#[test]
fn every_pair_counts_once_and_none_with_itself() {
    // Pairs (0,1), (0,2), (1,2): 1, 2, 3 and 1, 3, 2; the rest would not be finite.
    let one = [[f64::NAN, 1.0, 2.0], [f64::NAN, f64::NAN, 3.0], [f64::NAN; 3]];
    let other = [[f64::NAN, 1.0, 3.0], [f64::NAN, f64::NAN, 2.0], [f64::NAN; 3]];
    let found = correlation_of_pairs(3, |i, j| one[i][j], |i, j| other[i][j]).unwrap();
    check_close(Some(found.pearson), 0.5, 1e-15);
    check_close(Some(found.spearman), 0.5, 1e-15);
    assert_eq!(correlation_of_pairs(2, |i, j| one[i][j], |i, j| other[i][j]), None);
}

proptest! {
    #[test]
    fn correlations_are_symmetric_bounded_and_deaf_to_scale(
        samples in prop::collection::vec((-9i8..9, -9i8..9), 2..40),
        slope in 0.01..100.0, shift in -50.0..50.0,
    ) {
        let (x, y): (Vec<f64>, Vec<f64>) =
            samples.iter().map(|&(x, y)| (f64::from(x), f64::from(y))).unzip();
        let is_constant = |v: &[f64]| v.iter().all(|w| *w == v[0]);
        let moved: Vec<f64> = x.iter().map(|x| shift - slope * x).collect();
        for correlation in [pearson, spearman] {
            let found = correlation(&x, &y);
            prop_assert_eq!(found.is_none(), is_constant(&x) || is_constant(&y));
            prop_assert_eq!(found, correlation(&y, &x));
            if let Some(r) = found {
                prop_assert!((-1.0..=1.0).contains(&r));
                let reversed = correlation(&moved, &y).unwrap();
                prop_assert!((r + reversed).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn without_ties_the_rank_correlation_is_spearmans_formula(
        order in (2usize..30).prop_flat_map(|n| Just((0..n).collect::<Vec<_>>()).prop_shuffle()),
    ) {
        // ρ = 1 − 6 Σ d² / n(n² − 1), d the differences of the ranks; any increasing values.
        let x: Vec<f64> = (0..order.len()).map(|k| (k as f64).exp()).collect();
        let y: Vec<f64> = order.iter().map(|&k| (k as f64).powi(3)).collect();
        let n = order.len() as f64;
        let squares: f64 =
            order.iter().enumerate().map(|(k, &o)| (k as f64 - o as f64).powi(2)).sum();
        let expected = 1.0 - 6.0 * squares / (n * (n * n - 1.0));
        prop_assert!((spearman(&x, &y).unwrap() - expected).abs() < 1e-14);
    }
}
