//! A look at Λ(σ) that is finer where a window might be hidden.
//!
//! Between neighbours σ_1 < σ_2 the middle is looked at. It lies off the straight line between them by e; a
//! curve that bends in either half eight times as sharply as that stays within 2e of the straight lines
//! through the three points. Where all three have one sign and are further from zero than 2e, no zero lies
//! between; where their signs differ and they fall or rise without turning back, one does. Otherwise both
//! halves are looked at likewise: e falls by four each time.
//!
//! What is then known is no certainty: a window may be hidden by a Λ that bends still more sharply within a
//! gap than about it, and the widest gap says how wide that window can be.

use dynamics::Estimate;

use crate::MsfError;
use crate::zeros::{Signed, sign};

/// In halves Λ stays within this many e of straight lines.
const WITHIN: f64 = 2.0;

/// A point of the curve.
pub(crate) type Point = (f64, Estimate);

/// How far a look goes.
pub(crate) struct Fineness {
    /// What no exponent is known better than.
    pub floor: f64,
    /// Gaps are halved down to this share of their σ.
    pub narrowest: f64,
    /// The most points that are added.
    pub most: usize,
}

/// What a look gave.
pub(crate) struct Seen {
    /// All points, ascending.
    pub points: Vec<Point>,
    /// How many of them were added.
    pub n_added: usize,
    /// Gaps in which Λ may still touch zero.
    pub doubtful: Vec<[f64; 2]>,
    /// The smallest σ above 0 that was given.
    from: f64,
}

impl Seen {
    /// The signs that are certain.
    pub fn signs(&self, floor: f64) -> Vec<Signed> {
        let signed =
            |&(sigma, lambda): &Point| Some(Signed { sigma, negative: sign(lambda, floor)? });
        self.points.iter().filter_map(signed).collect()
    }

    /// The widest gap between neighbours, as a share of its σ, from the first that was given above 0 on: a
    /// narrower window may be missed.
    pub fn widest_gap(&self) -> f64 {
        let pairs = self.points.windows(2).filter(|pair| pair[0].0 >= self.from);
        pairs.map(|pair| 1.0 - pair[0].0 / pair[1].0).fold(0.0, f64::max)
    }
}

/// Looks between points of a curve, ascending.
pub(crate) fn look(
    mut points: Vec<Point>,
    fineness: &Fineness,
    mut measure: impl FnMut(&[f64]) -> Result<Vec<Estimate>, MsfError>,
) -> Result<Seen, MsfError> {
    let n_given = points.len();
    let from = points.iter().map(|point| point.0).find(|&sigma| sigma > 0.0).unwrap_or(0.0);
    let mut open: Vec<[Point; 2]> = points.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let mut given_up = Vec::new();
    while !open.is_empty() {
        if points.len() - n_given + open.len() > fineness.most {
            given_up.append(&mut open);
            break;
        }
        let middles: Vec<f64> = open.iter().map(|[a, b]| 0.5 * (a.0 + b.0)).collect();
        let measured = middles.iter().copied().zip(measure(&middles)?).collect::<Vec<Point>>();
        let mut halves = Vec::new();
        for ([a, b], middle) in open.into_iter().zip(&measured) {
            if !is_settled([a, *middle, b], fineness.floor) {
                halves.extend([[a, *middle], [*middle, b]]);
            }
        }
        points.extend(&measured);
        let is_narrow = |[a, b]: &[Point; 2]| b.0 - a.0 <= fineness.narrowest * b.0;
        let (narrow, wide): (Vec<_>, Vec<_>) = halves.into_iter().partition(is_narrow);
        given_up.extend(narrow);
        open = wide;
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let doubtful = doubtful(&points, &given_up, fineness.floor);
    Ok(Seen { n_added: points.len() - n_given, points, doubtful, from })
}

/// Whether the signs between three neighbours are known.
fn is_settled([a, middle, b]: [Point; 3], floor: f64) -> bool {
    let off = (middle.1.mean - 0.5 * (a.1.mean + b.1.mean)).abs();
    let signs = [a, middle, b].map(|point| sign(point.1, floor));
    match signs {
        [Some(first), Some(second), Some(third)] if first == second && second == third => {
            let least = [a, middle, b].map(|point| point.1.mean.abs()).into_iter();
            least.fold(f64::INFINITY, f64::min) > WITHIN * off
        }
        // One zero, unless the curve turns back.
        [Some(first), _, Some(third)] if first != third => off < 0.5 * (b.1.mean - a.1.mean).abs(),
        _ => false,
    }
}

/// Gaps given up between points of one sign, and those about points whose sign is in doubt while their
/// neighbours agree.
fn doubtful(points: &[Point], given_up: &[[Point; 2]], floor: f64) -> Vec<[f64; 2]> {
    let known = |point: &Point| sign(point.1, floor);
    let agree = |[a, b]: &&[Point; 2]| known(a).is_some() && known(a) == known(b);
    let mut open: Vec<[f64; 2]> = given_up.iter().filter(agree).map(|[a, b]| [a.0, b.0]).collect();
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
    // Neighbouring gaps are one.
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for gap in open {
        match joined.last_mut() {
            Some(last) if gap[0] <= last[1] => last[1] = last[1].max(gap[1]),
            _ => joined.push(gap),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    const FINENESS: Fineness = Fineness { floor: 0.0, narrowest: 1e-3, most: 400 };

    fn looked(lambda: impl Fn(f64) -> f64, n_points: u32) -> Seen {
        let lambda = |sigma: f64| Estimate { mean: lambda(sigma), standard_error: 1e-6 };
        let points = (0..n_points)
            .map(|k| 10.0 * f64::from(k) / f64::from(n_points - 1))
            .map(|sigma| (sigma, lambda(sigma)))
            .collect();
        look(points, &FINENESS, |sigmas| Ok(sigmas.iter().map(|&s| lambda(s)).collect())).unwrap()
    }

    fn windows(seen: &Seen) -> usize {
        seen.signs(0.0).windows(2).filter(|pair| !pair[0].negative && pair[1].negative).count()
    }

    #[test]
    fn a_window_between_two_points_is_seen() {
        // Negative for 5.3 < σ < 5.7 only; the grid has 5 and 6.
        assert_eq!(windows(&looked(|sigma| (sigma - 5.5).powi(2) - 0.04, 11)), 1);
        // A narrow dip in a curve that is flat elsewhere, and one off the middle of two points.
        let dip = |at: f64| move |sigma: f64| 0.3 - 0.4 * f64::exp(-(sigma - at).powi(2) / 0.18);
        assert_eq!(windows(&looked(dip(4.75), 21)), 1);
        assert_eq!(windows(&looked(dip(5.38), 11)), 1);
    }

    #[test]
    fn a_window_two_grid_steps_wide_between_points_far_from_zero_is_seen() {
        // Steep walls: 1 at 4 and at 7, with the window (4.4, 6.6) in between.
        let walls = |sigma: f64| f64::tanh(4.0 * ((sigma - 5.5).abs() - 1.1));
        assert_eq!(windows(&looked(walls, 8)), 1);
    }

    #[test]
    fn a_smooth_curve_far_from_zero_is_looked_at_once_between_neighbours() {
        for lambda in [|_: f64| 1.0, |sigma: f64| -1.0 - sigma, |sigma: f64| 1.0 + sigma * sigma] {
            let seen = looked(lambda, 41);
            assert_eq!((seen.n_added, seen.doubtful.len()), (40, 0));
            assert!((seen.widest_gap() - 1.0 / 3.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_curve_that_touches_zero_stays_in_doubt() {
        let seen = looked(|sigma| (sigma - 5.03).powi(2), 11);
        let [[from, to]] = seen.doubtful[..] else { panic!("{:?}", seen.doubtful) };
        assert!(from < 5.03 && 5.03 < to && to - from < 0.1, "{from} to {to}");
    }

    #[test]
    fn a_curve_that_ends_on_zero_ends_in_doubt() {
        let seen = looked(|sigma| (sigma - 10.0).abs() * 0.1, 11);
        let [[from, to]] = seen.doubtful[..] else { panic!("{:?}", seen.doubtful) };
        assert!(to == 10.0 && from > 9.9, "{from}");
    }

    #[test]
    fn no_more_points_are_added_than_allowed() {
        let fast = |sigma: f64| 1.01 + f64::sin(40.0 * sigma);
        let seen = looked(fast, 31);
        assert!(seen.n_added <= 400 && !seen.doubtful.is_empty(), "{}", seen.n_added);
    }
}
