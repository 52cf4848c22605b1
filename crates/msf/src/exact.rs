//! Λ(σ) on orbits that close: a function without noise, whose zeros are found by bisection and secants.
//!
//! On a limit cycle Λ(0) = 0 and Λ(σ) = cσ + … near it, since a simple multiplier is analytic in σ; so Λ/σ is
//! looked at instead, which is c at σ = 0 and has the same zeros and signs above.

use dynamics::{ClosedOrbit, Closes, Estimate, Settled};

use crate::attractors::Attractor;
use crate::curve::{Looked, MasterStability};
use crate::look::{Fineness, Point, look};
use crate::range::{CLOSED, by_factors};
use crate::region::region;
use crate::zero::Zero;
use crate::zeros::Signed;
use crate::{End, Isolated, MsfError, Request};

/// Gaps are halved down to this share of their σ, and so many points are added at the most.
const NARROWEST: f64 = 1e-4;
const MOST: usize = 2000;
/// Points of the curve where nobody says which.
pub(crate) const SHOWN: u32 = 65;
/// A zero is found to this share of its σ.
const ACCURACY: f64 = 1e-11;
/// Steps towards a zero, at most; twenty are usual.
const MOST_STEPS: usize = 100;
/// The slope at a zero is that between σ a share of this to either side.
const APART: f64 = 1e-5;
/// Two orbits are told apart by exponents that differ by more, relative to 1 or themselves.
const SAME: f64 = 1e-7;

/// The curve of orbits that close, on each attractor where they are several.
pub(crate) fn on_closed_orbits(
    settled: &[Settled],
    request: &Request,
    furthest: f64,
) -> Result<MasterStability, MsfError> {
    let base = match request.sigma[..] {
        [] => by_factors(furthest.max(CLOSED)),
        _ => {
            [0.0].into_iter().chain(request.looked_at().into_iter().filter(|s| *s > 0.0)).collect()
        }
    };
    let mut groups: Vec<(Curve, usize)> = Vec::new();
    for Settled { orbit, seeds } in settled {
        let at_base = orbit.exponents(&base);
        match groups.iter_mut().find(|(curve, _)| curve.differs_at(&at_base).is_none()) {
            Some((_, count)) => *count += seeds.len(),
            None => groups.push((Curve::of(orbit, &base, at_base, request)?, seeds.len())),
        }
    }
    groups.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let of = groups.iter().map(|(_, count)| count).sum();
    let attractors = if groups.len() > 1 { attractors(&groups, &base, of) } else { Vec::new() };
    let (first, _) = groups.swap_remove(0);
    let all = attractors.iter().map(|attractor| attractor.stable.clone());
    let common = all.reduce(|all, next| all.intersection(&next));
    let stable = common.unwrap_or(first.of.stable.clone());
    Ok(MasterStability { stable, attractors, ..first.of })
}

/// The curve on one closed orbit.
struct Curve {
    of: MasterStability,
    /// Λ at the σ at which all orbits are compared.
    at_base: Vec<Estimate>,
}

impl Curve {
    fn of(
        orbit: &ClosedOrbit,
        base: &[f64],
        at_base: Vec<Estimate>,
        request: &Request,
    ) -> Result<Self, MsfError> {
        let is_cycle = matches!(orbit.closes(), Closes::AfterPeriod { .. });
        let per_sigma = |sigma: f64, lambda: Estimate| {
            let by = if is_cycle { sigma } else { 1.0 };
            Estimate { mean: lambda.mean / by, standard_error: lambda.standard_error / by }
        };
        let at_zero = orbit.first_order().unwrap_or(at_base[0]);
        let mut points: Vec<Point> = vec![(0.0, at_zero)];
        let others = base.iter().zip(&at_base).skip(1);
        points.extend(others.map(|(&sigma, &lambda)| (sigma, per_sigma(sigma, lambda))));
        let fineness = Fineness { floor: 0.0, narrowest: NARROWEST, most: MOST };
        let seen = look(points, &fineness, |sigmas| {
            let exponents = orbit.exponents(sigmas).into_iter();
            Ok(sigmas.iter().zip(exponents).map(|(&s, lambda)| per_sigma(s, lambda)).collect())
        })?;
        let certain = seen.signs(0.0);
        let changes = certain.windows(2).filter(|pair| pair[0].negative != pair[1].negative);
        let wanted = request.refinement.relative_error;
        let zeros: Vec<Zero> =
            changes.map(|pair| zero(orbit, [pair[0], pair[1]], wanted)).collect();
        let stable = region(&certain, &zeros, begins(&certain, !is_cycle));
        let (isolated, state) = match is_cycle {
            true => (Estimate::default(), Isolated::Periodic),
            false => (at_base[0], Isolated::AtRest),
        };
        let sigma = match request.sigma[..] {
            [] => shown(zeros.last().map_or(base[base.len() - 1], |zero| 2.0 * zero.sigma)),
            _ => request.looked_at(),
        };
        let looked = Looked {
            from: request.looked_at().first().copied().unwrap_or(0.0),
            to: certain.last().map_or(0.0, |last| last.sigma),
            points: seen.points.len(),
            between: seen.n_added,
            widest_gap: seen.widest_gap(),
        };
        let of = MasterStability {
            lambda: orbit.exponents(&sigma),
            sigma,
            isolated,
            state,
            closes: Some(orbit.closes()),
            looked,
            doubtful: seen.doubtful,
            stable,
            ..MasterStability::default()
        };
        Ok(Self { of, at_base })
    }

    /// Where exponents differ most, if that is more than errors.
    fn differs_at(&self, exponents: &[Estimate]) -> Option<usize> {
        let off = |k: &usize| {
            let [a, b] = [self.at_base[*k], exponents[*k]];
            let error = a.standard_error.hypot(b.standard_error).max(SAME * (1.0 + a.mean.abs()));
            (a.mean - b.mean).abs() / error
        };
        let widest = (0..exponents.len()).max_by(|a, b| off(a).total_cmp(&off(b)))?;
        (off(&widest) > 1.0).then_some(widest)
    }
}

/// Evenly spaced σ from 0 up to the last.
pub(crate) fn shown(last: f64) -> Vec<f64> {
    (0..SHOWN).map(|k| last * f64::from(k) / f64::from(SHOWN - 1)).collect()
}

/// What the lower end of the stable set is where Λ < 0 from the first certain σ on.
fn begins(certain: &[Signed], included: bool) -> Option<End> {
    let first = certain.first().filter(|first| first.negative)?;
    Some(match first.sigma {
        0.0 => End::Origin { included },
        sigma => End::Looked { sigma },
    })
}

fn attractors(groups: &[(Curve, usize)], base: &[f64], of: usize) -> Vec<Attractor> {
    let told = groups[0].0.differs_at(&groups[1].0.at_base).unwrap_or(0);
    let attractor = |(curve, orbits): &(Curve, usize)| Attractor {
        orbits: *orbits,
        of,
        told_at: base[told],
        lambda: curve.at_base[told],
        isolated: curve.of.isolated,
        state: curve.of.state,
        stable: curve.of.stable.clone(),
    };
    groups.iter().map(attractor).collect()
}

/// The zero between two σ of opposite signs: secants that keep it between, of which one end is halved where
/// it stays (the Illinois rule: M. Dowell & P. Jarratt, BIT 11, 168 (1971)).
fn zero(orbit: &ClosedOrbit, [from, to]: [Signed; 2], wanted: f64) -> Zero {
    let at = |sigma: f64| orbit.exponents(&[sigma])[0];
    let falling = to.negative;
    let (mut low, mut high) = (from.sigma, to.sigma);
    // The sign that Λ has right above 0 need not be that of Λ(0) = 0.
    let mut ends = [low, high].map(|sigma| at(sigma).mean);
    let mut error = 0.0f64;
    for _ in 0..MOST_STEPS {
        if high - low <= ACCURACY * high {
            break;
        }
        let secant = low + (high - low) * ends[0] / (ends[0] - ends[1]);
        let middle = 0.5 * (low + high);
        let inside = low + 0.02 * (high - low)..high - 0.02 * (high - low);
        let is_near = (secant - low).min(high - secant) < ACCURACY * high;
        let sigma = if inside.contains(&secant) || is_near { secant } else { middle };
        let sigma = if sigma > low && sigma < high { sigma } else { middle };
        let lambda = at(sigma);
        error = lambda.standard_error;
        if (lambda.mean < 0.0) == falling {
            (high, ends) = (sigma, [0.5 * ends[0], lambda.mean]);
        } else {
            (low, ends) = (sigma, [lambda.mean, 0.5 * ends[1]]);
        }
        if lambda.mean.abs() <= 0.1 * error {
            (low, high) = (sigma, sigma);
        }
    }
    let sigma = 0.5 * (low + high);
    let [before, after] = [1.0 - APART, 1.0 + APART].map(|factor| at(factor * sigma));
    let slope = (after.mean - before.mean) / (2.0 * APART * sigma);
    let standard_error = (error / slope.abs()).hypot(ACCURACY * sigma).hypot(high - low);
    let refined = standard_error <= wanted * sigma;
    Zero { sigma, standard_error, falling, refined, step_shift: None }
}
