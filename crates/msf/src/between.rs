//! Windows between grid points: where Λ comes near zero and might touch it unseen.
//!
//! Between neighbours σ_1 < σ_2 with Λ of one sign, a ≤ b their sizes and h their distance, a Λ that bends
//! towards zero by no more than C stays away from it by
//!
//! ```text
//! g(t) = a + (b − a) t − C h² t (1 − t)/2        t = (σ − σ_1)/h or its mirror image
//! ```
//!
//! and has no zero there where the least of g is above 0. C is four times the smaller of the second differences
//! at the two points. Where g falls below 0 their middle is looked at, on the orbit of the grid, and so
//! on: h² falls by four each time. What is then known is no certainty: a Λ that bends more sharply between
//! two points than at them can still hide a window.

use dynamics::Estimate;

use crate::MsfError;
use crate::zeros::{Signed, sign};

/// Between points Λ may bend so many times more sharply than about them.
const SHARPER: f64 = 4.0;

/// How often gaps are halved.
const ROUNDS: usize = 6;

/// A point of the curve.
type Point = (f64, Estimate);

/// What the look between grid points gave.
pub(crate) struct Between {
    /// Points whose sign is certain.
    pub signs: Vec<Signed>,
    /// How many were looked at.
    pub n_points: usize,
    /// Gaps in which Λ may still touch zero.
    pub doubtful: Vec<[f64; 2]>,
}

/// Looks where the points of a curve, ascending, leave room for a window between them. At most as many
/// points are added as there are. `settled` are those whose sign is known, if not from the curve.
pub(crate) fn look(
    (curve, settled): (&[Point], &[Signed]),
    floor: f64,
    mut measure: impl FnMut(&[f64]) -> Result<Vec<Estimate>, MsfError>,
) -> Result<Between, MsfError> {
    let mut points = curve.to_vec();
    let mut added = Vec::new();
    for _ in 0..ROUNDS {
        let middles: Vec<f64> =
            gaps(&points, floor).iter().map(|[from, to]| 0.5 * (from + to)).collect();
        if middles.is_empty() || added.len() + middles.len() > curve.len() {
            break;
        }
        let new: Vec<Point> = middles.iter().copied().zip(measure(&middles)?).collect();
        points.extend(&new);
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        added.extend(new);
    }
    let signed = |&(sigma, lambda): &Point| Some(Signed { sigma, negative: sign(lambda, floor)? });
    Ok(Between {
        signs: added.iter().filter_map(signed).collect(),
        n_points: added.len(),
        doubtful: doubtful(&points, settled, floor),
    })
}

/// Gaps that are still open, and those about a point whose sign is in doubt while its neighbours agree.
fn doubtful(points: &[Point], settled: &[Signed], floor: f64) -> Vec<[f64; 2]> {
    let mut open = gaps(points, floor);
    let known = |&(sigma, lambda): &Point| {
        let settled = || settled.iter().find(|signed| signed.sigma == sigma);
        sign(lambda, floor).or_else(|| settled().map(|signed| signed.negative))
    };
    let certain: Vec<(f64, bool)> =
        points.iter().filter_map(|point| Some((point.0, known(point)?))).collect();
    for point in points.iter().filter(|point| known(point).is_none()) {
        let after = certain.partition_point(|certain| certain.0 < point.0);
        if after == certain.len() && after > 0 {
            // Nothing is certain from there on.
            open.push([certain[after - 1].0, points[points.len() - 1].0]);
        } else if after > 0
            && let [before, next] = certain[after - 1..(after + 1).min(certain.len())]
            && before.1 == next.1
        {
            open.push([before.0, next.0]);
        }
    }
    open.sort_by(|a, b| a[0].total_cmp(&b[0]));
    open.dedup();
    open
}

/// Neighbours between which Λ may touch zero, if it bends there as about them.
fn gaps(points: &[Point], floor: f64) -> Vec<[f64; 2]> {
    let is_open = |left: usize| {
        let [(from, a), (to, b)] = [points[left], points[left + 1]];
        if sign(a, floor).is_none() || sign(a, floor) != sign(b, floor) {
            return false;
        }
        // Above zero a curve comes near it and leaves it again where it bends upwards. Next to a pit one
        // of both is that of its rim.
        let bends = [left, left + 1].into_iter().filter_map(|at| bend(points, at));
        let least = bends.map(|bend| bend * a.mean.signum()).reduce(f64::min);
        let bend = SHARPER * least.unwrap_or(0.0).max(0.0);
        may_touch([a.mean.abs(), b.mean.abs()], bend * (to - from).powi(2))
    };
    (0..points.len().saturating_sub(1))
        .filter(|&left| is_open(left))
        .map(|left| [points[left].0, points[left + 1].0])
        .collect()
}

/// Whether the least of g is below 0, for the sizes at both ends and C h².
fn may_touch([a, b]: [f64; 2], bend: f64) -> bool {
    let (low, rise) = (a.min(b), (a - b).abs());
    // g is least at t = 1/2 − (b − a)/(C h²), where it is a − C h² t²/2.
    let at = 0.5 - rise / bend;
    at > 0.0 && low < 0.5 * bend * at * at
}

/// Λ'' at a point by its neighbours; none at the ends.
fn bend(points: &[Point], at: usize) -> Option<f64> {
    let (before, here) = (*points.get(at.checked_sub(1)?)?, points[at]);
    let after = *points.get(at + 1)?;
    let slope = |a: Point, b: Point| (b.1.mean - a.1.mean) / (b.0 - a.0);
    Some(2.0 * (slope(here, after) - slope(before, here)) / (after.0 - before.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exactly(lambda: impl Fn(f64) -> f64) -> impl Fn(f64) -> Estimate {
        move |sigma| Estimate { mean: lambda(sigma), standard_error: 1e-6 }
    }

    fn looked(lambda: impl Fn(f64) -> f64, n_points: u32) -> Between {
        let lambda = exactly(lambda);
        let curve: Vec<Point> = (0..n_points)
            .map(|k| 10.0 * f64::from(k) / f64::from(n_points - 1))
            .map(|sigma| (sigma, lambda(sigma)))
            .collect();
        look((&curve, &[]), 0.0, |sigmas| Ok(sigmas.iter().map(|&sigma| lambda(sigma)).collect()))
            .unwrap()
    }

    #[test]
    fn a_window_between_two_points_is_seen_where_its_curve_bends() {
        // Negative for 5.3 < σ < 5.7 only; the grid has 5 and 6.
        let between = looked(|sigma| (sigma - 5.5).powi(2) - 0.04, 11);
        let negative: Vec<f64> =
            between.signs.iter().filter(|s| s.negative).map(|s| s.sigma).collect();
        assert!(negative.contains(&5.5), "{negative:?}");
        // And one of a narrow dip in a curve that is flat elsewhere.
        let dip = |sigma: f64| 0.3 - 0.4 * f64::exp(-(sigma - 4.75).powi(2) / 0.18);
        assert!(looked(dip, 21).signs.iter().any(|s| s.negative));
    }

    #[test]
    fn where_nothing_comes_near_zero_nothing_is_looked_at() {
        for lambda in
            [|_: f64| 1.0, |sigma: f64| 0.9 - sigma, |sigma: f64| 0.2 + (sigma - 5.0).powi(2)]
        {
            assert_eq!(looked(lambda, 41).n_points, 0);
        }
    }

    #[test]
    fn a_curve_that_falls_away_from_zero_hides_nothing() {
        // As that of a map coupled through itself, ln|1 − σ| + ln 2, which has no bottom.
        let lambda = |sigma: f64| f64::ln((1.0 - sigma).abs().max(1e-300)) + 2f64.ln();
        assert_eq!(looked(|sigma| lambda(0.3 * sigma), 61).n_points, 0);
    }

    #[test]
    fn a_curve_that_touches_zero_stays_in_doubt() {
        let between = looked(|sigma| (sigma - 5.03).powi(2), 11);
        let [[from, to]] = between.doubtful[..] else { panic!("{:?}", between.doubtful) };
        assert!(from < 5.03 && 5.03 < to && to - from < 0.1, "{from} to {to}");
    }

    #[test]
    fn a_point_of_the_grid_that_lies_on_zero_between_others_of_one_sign_stays_in_doubt() {
        // Touches zero at 5, where the grid has a point.
        assert_eq!(looked(|sigma| (sigma - 5.0).abs(), 11).doubtful, [[4.0, 6.0]]);
    }

    #[test]
    fn a_grid_that_ends_on_zero_ends_in_doubt() {
        assert_eq!(looked(|sigma| (sigma - 10.0).abs() * 0.1, 11).doubtful, [[9.0, 10.0]]);
    }

    #[test]
    fn no_more_points_are_added_than_there_are() {
        let fast = |sigma: f64| 1.01 + f64::sin(40.0 * sigma);
        assert!(looked(fast, 31).n_points <= 31);
    }
}
