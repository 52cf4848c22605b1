//! From a request to Λ(σ): on orbits that close as a function, on all others as averages over orbits.

use dynamics::lyapunov::{Tangent, Times, master_exponents_with};
use dynamics::{Estimate, Progress, Settled, closed_orbits};

use crate::attractors::{self, Attractor, Column};
use crate::curve::{Looked, MasterStability};
use crate::exact::{on_closed_orbits, shown};
use crate::look::{Fineness, Point, Seen, look};
use crate::range::{by_factors, furthest};
use crate::reach::{beyond_last_change, on_one_orbit};
use crate::refinement::Advance;
use crate::region::region;
use crate::seeds::Seeds;
use crate::step::{Step, with_shift};
use crate::zeros::{Finder, Signed, sign};
use crate::{Isolated, MsfError, Node, Request, origin, rest};

/// So many isolated orbits are run at half the step as well.
const HALVED_ORBITS: usize = 8;
/// A look for windows averages over a quarter of the time of other exponents, but no less and no more than
/// this: over units of time, and over iterations.
const LOOK_FLOW: [f64; 2] = [1000.0, 4000.0];
const LOOK_MAP: [f64; 2] = [5000.0, 20_000.0];
/// Gaps in doubt after it are looked at with full averages, so many of them, with so many points each, down
/// to this share of their σ.
const CLOSER: usize = 4;
const CLOSER_POINTS: usize = 12;
const NARROWEST: f64 = 0.02;

/// Computes Λ on the grid, the isolated exponent, and every zero to the accuracy asked for, or as
/// well as the allowed rounds of refinement give; each zero carries the standard error it has. Where
/// orbits settle on different attractors each has a curve of its own, and no average is taken.
///
/// Runs on the current rayon pool; the result does not depend on the number of threads.
///
/// # Errors
/// [`MsfError::BadGrid`]; an orbit that escapes or times that make no sense as [`MsfError::Dynamics`].
pub fn master_stability(
    node: &Node,
    request: &Request,
    progress: Progress<'_>,
) -> Result<MasterStability, MsfError> {
    master_stability_with(node, request, progress, &|_| ())
}

/// The same, telling how far the refinement of each zero has come, which no one knows beforehand.
///
/// # Errors
/// As [`master_stability`].
pub fn master_stability_with(
    node: &Node,
    request: &Request,
    progress: Progress<'_>,
    advance: &dyn Fn(Advance),
) -> Result<MasterStability, MsfError> {
    let ascending = request.sigma.windows(2).all(|pair| pair[0] < pair[1]);
    let from_zero = request.sigma.first().is_none_or(|&sigma| sigma >= 0.0);
    if request.sigma.len() == 1 || !ascending || !from_zero {
        return Err(MsfError::BadGrid);
    }
    let work = Work { node, request, progress, advance, furthest: furthest_of(node, request)? };
    let mut seeds = Seeds::new(request.seed);
    let orbits: Vec<u64> = Seeds::new(request.seed).orbits().collect();
    let mut curve = match work.closed(&orbits)? {
        Some(settled) => on_closed_orbits(&settled, request, work.furthest)?,
        None => match work.curve(&mut seeds)? {
            (curve, Some(sigma)) => work.on_each_attractor(curve, sigma, &mut seeds)?,
            (curve, None) => curve,
        },
    };
    curve.rests = work.rests(&curve)?;
    if curve.rests.len() > 1 {
        curve.stable.exclude_origin();
        curve.attractors.iter_mut().for_each(|attractor| attractor.stable.exclude_origin());
    }
    Ok(curve)
}

/// Where a look ends for which nobody says what to look at.
fn furthest_of(node: &Node, request: &Request) -> Result<f64, MsfError> {
    match request.sigma.last() {
        Some(&last) => Ok(last),
        None => furthest(node, &request.times, request.seed),
    }
}

/// One computation.
struct Work<'a> {
    node: &'a Node,
    request: &'a Request,
    progress: Progress<'a>,
    advance: &'a dyn Fn(Advance),
    /// The largest σ to be looked at.
    furthest: f64,
}

impl Work<'_> {
    fn exponents(&self, tangents: &[Tangent], step: Step) -> Result<Vec<Estimate>, MsfError> {
        let mut times = self.request.times;
        match step {
            Step::Asked => {}
            Step::Halved => times = times.finer(),
            Step::Later => times.transient += times.average,
        }
        self.exponents_over(&times, tangents)
    }

    fn exponents_over(
        &self,
        times: &Times,
        tangents: &[Tangent],
    ) -> Result<Vec<Estimate>, MsfError> {
        let (node, set) = (self.node, self.request.instruction_set);
        let (dynamics, coupling) = (node.dynamics.as_ref(), &node.coupling);
        Ok(master_exponents_with(set, dynamics, coupling, times, tangents, self.progress)?)
    }

    /// The closed orbits on which isolated oscillators settle, if all do.
    fn closed(&self, seeds: &[u64]) -> Result<Option<Vec<Settled>>, MsfError> {
        let Times { step, transient, .. } = self.request.times;
        let Node { dynamics, coupling } = self.node;
        Ok(closed_orbits(dynamics, coupling, (step, transient), seeds, self.progress)?)
    }

    /// Times of the look for windows.
    fn look_times(&self) -> Times {
        let [least, most] = if self.node.dynamics.is_map() { LOOK_MAP } else { LOOK_FLOW };
        let times = self.request.times;
        let average = (0.25 * times.average).clamp(least, most).min(times.average);
        Times { average, ..times }
    }

    /// A look for windows on an orbit of its own, at the grid or as far as the step goes, with Λ(0).
    fn look(&self, seed: u64) -> Result<Seen, MsfError> {
        let times = self.look_times();
        let on_orbit = |sigmas: &[f64]| {
            let tangents: Vec<_> = sigmas.iter().map(|&sigma| Tangent { sigma, seed }).collect();
            self.exponents_over(&times, &tangents)
        };
        let base = match self.request.sigma[..] {
            [] => by_factors(self.furthest),
            _ => with_zero(self.request.looked_at()),
        };
        on_one_orbit(&base, &times, on_orbit)
    }

    /// What an average over this time does not know of an exponent in any case: the length of a
    /// tangent varies along the orbit by a factor of order one.
    fn floor(&self) -> f64 {
        1.0 / self.request.times.average
    }

    /// Where the orbits of Λ(0) come to rest.
    fn rests(&self, curve: &MasterStability) -> Result<Vec<usize>, MsfError> {
        if curve.state != Isolated::AtRest {
            return Ok(Vec::new());
        }
        let seeds: Vec<u64> = Seeds::new(self.request.seed).orbits().collect();
        let Times { step, transient, .. } = self.request.times;
        rest::counts(self.node.dynamics.as_ref(), (step, transient), curve.isolated.mean, &seeds)
    }

    /// The curve of the orbits that the seeds give, and a σ at which these differ in kind.
    fn curve(&self, seeds: &mut Seeds) -> Result<(MasterStability, Option<f64>), MsfError> {
        let floor = self.floor();
        let seen = self.look(seeds.of_look())?;
        let seen_signs = seen.signs(1.0 / self.look_times().average);
        let sigma = match self.request.sigma[..] {
            [] => shown(beyond_last_change(&seen_signs)),
            _ => self.request.looked_at(),
        };
        let (isolated, isolated_step_shift, split) = self.isolated(seeds)?;
        // One orbit serves the whole grid. Zeros are found from orbits of their own, since their
        // standard errors come from the scatter of independent exponents.
        let seed = seeds.next();
        let on_orbit = |sigmas: &[f64]| {
            let tangents: Vec<_> = sigmas.iter().map(|&sigma| Tangent { sigma, seed }).collect();
            self.exponents(&tangents, Step::Asked)
        };
        let lambda = on_orbit(&sigma)?;
        let state = match sign(isolated, floor) {
            Some(true) => Isolated::AtRest,
            Some(false) => Isolated::Chaotic,
            None => Isolated::Periodic,
        };
        let measure = |sigmas: &[f64], step| {
            let tangents: Vec<_> =
                sigmas.iter().map(|&sigma| Tangent { sigma, seed: seeds.next() }).collect();
            self.exponents(&tangents, step)
        };
        let (refinement, advance) = (&self.request.refinement, self.advance);
        let has_step = !self.node.dynamics.is_map();
        // Means over a chaotic orbit are right on average; one that is not may come back after a time T to
        // where it has another length, in every phase.
        let bias = if state == Isolated::Chaotic { 0.0 } else { floor };
        let mut finder = Finder { refinement, advance, floor, measure, split, has_step, bias };
        let positive: Vec<Point> =
            sigma.iter().copied().zip(lambda.iter().copied()).filter(|p| p.0 > 0.0).collect();
        let certain = finder.settle(&positive)?;
        let (certain, from) = origin::with(state, certain, &mut finder)?;
        let (closer, doubtful) = self.closer(&seen.doubtful, &certain, on_orbit)?;
        let certain = reveal(certain, seen_signs);
        let certain = reveal(certain, closer);
        let found = finder.zeros(&certain)?;
        let stable = region(&certain, &found.zeros, from);
        let looked = Looked {
            from: self.request.looked_at().first().copied().unwrap_or(0.0),
            to: self.furthest,
            points: seen.points.len(),
            between: seen.n_added,
            widest_gap: seen.widest_gap(),
        };
        let curve = MasterStability {
            sigma,
            lambda,
            isolated,
            isolated_step_shift,
            state,
            looked,
            doubtful,
            stable,
            ..MasterStability::default()
        };
        Ok((curve, found.split))
    }

    /// Λ(0), what half the step changes of it, and whether its orbits differ in kind.
    fn isolated(&self, seeds: &mut Seeds) -> Result<(Estimate, Estimate, Option<f64>), MsfError> {
        let orbits: Vec<_> = seeds.orbits().map(|seed| Tangent { sigma: 0.0, seed }).collect();
        let exponents = self.exponents(&orbits, Step::Asked)?;
        let column = [Column { sigma: 0.0, exponents: &exponents }];
        let split = attractors::split(&column, self.floor());
        let isolated = estimate_of(&exponents);
        let shift = if self.node.dynamics.is_map() {
            Estimate::default()
        } else {
            let halved = &orbits[..orbits.len().min(HALVED_ORBITS)];
            difference(&self.exponents(halved, Step::Halved)?, isolated)
        };
        let standard_error = with_shift(isolated.standard_error, shift);
        Ok((Estimate { standard_error, ..isolated }, shift, split))
    }

    /// Gaps that a short look has left in doubt, looked at with full averages: signs that are certain, and
    /// the gaps that stay in doubt.
    fn closer(
        &self,
        doubtful: &[[f64; 2]],
        certain: &[Signed],
        mut on_orbit: impl FnMut(&[f64]) -> Result<Vec<Estimate>, MsfError>,
    ) -> Result<(Vec<Signed>, Vec<[f64; 2]>), MsfError> {
        let floor = self.floor();
        let fineness = Fineness { floor, narrowest: NARROWEST, most: CLOSER_POINTS };
        let (mut signs, mut left) = (Vec::new(), Vec::new());
        for (k, &[from, to]) in doubtful.iter().enumerate() {
            let inside = |signed: &&Signed| from < signed.sigma && signed.sigma < to;
            let known = certain.iter().filter(inside).collect::<Vec<_>>();
            // A zero that the full averages show is no doubt.
            if known.windows(2).any(|pair| pair[0].negative != pair[1].negative) {
                continue;
            }
            if k >= CLOSER {
                left.push([from, to]);
                continue;
            }
            let sigmas = [from, 0.5 * (from + to), to];
            let points = sigmas.into_iter().zip(on_orbit(&sigmas)?).collect();
            let seen = look(points, &fineness, &mut on_orbit)?;
            signs.extend(seen.signs(floor));
            left.extend(seen.doubtful);
        }
        Ok((signs, left))
    }

    /// The curve of each attractor. Orbits belong to one by their exponents where these differ.
    fn on_each_attractor(
        &self,
        mixed: MasterStability,
        sigma: f64,
        seeds: &mut Seeds,
    ) -> Result<MasterStability, MsfError> {
        // Those of Λ(0) among them: an attractor that few orbits settle on need not come again with others.
        let mut first = Seeds::new(self.request.seed);
        let seeds: Vec<u64> = first.orbits().chain(seeds.orbits()).collect();
        let probes: Vec<_> = seeds.iter().map(|&seed| Tangent { sigma, seed }).collect();
        let exponents = self.exponents(&probes, Step::Asked)?;
        let groups = attractors::groups(&exponents, self.floor());
        // Orbits that are all alike now were not for good.
        if groups.len() < 2 {
            return Ok(mixed);
        }
        let mut curves = Vec::new();
        let mut attractors = Vec::new();
        for group in groups {
            let of_group: Vec<Estimate> = group.iter().map(|&orbit| exponents[orbit]).collect();
            let of_group_seeds: Vec<u64> = group.iter().map(|&orbit| seeds[orbit]).collect();
            let curve = match self.closed(&of_group_seeds)? {
                Some(settled) => on_closed_orbits(&settled[..1], self.request, self.furthest)?,
                None => self.curve(&mut Seeds::again(of_group_seeds))?.0,
            };
            attractors.push(Attractor {
                orbits: group.len(),
                of: seeds.len(),
                told_at: sigma,
                lambda: estimate_of(&of_group),
                isolated: curve.isolated,
                state: curve.state,
                stable: curve.stable.clone(),
            });
            curves.push(curve);
        }
        let stable = attractors
            .iter()
            .skip(1)
            .fold(attractors[0].stable.clone(), |all, next| all.intersection(&next.stable));
        Ok(MasterStability { stable, attractors, ..curves.swap_remove(0) })
    }
}

/// What half the step changes.
fn difference(halved: &[Estimate], asked: Estimate) -> Estimate {
    let halved = estimate_of(halved);
    Estimate {
        mean: halved.mean - asked.mean,
        standard_error: halved.standard_error.hypot(asked.standard_error),
    }
}

/// Mean over orbits with its scatter; of a single orbit what its blocks say.
fn estimate_of(exponents: &[Estimate]) -> Estimate {
    match exponents {
        [single] => *single,
        _ => Estimate::from_independent(&exponents.iter().map(|e| e.mean).collect::<Vec<_>>()),
    }
}

/// The σ with 0 before them.
fn with_zero(sigma: Vec<f64>) -> Vec<f64> {
    [0.0].into_iter().chain(sigma.into_iter().filter(|&sigma| sigma > 0.0)).collect()
}

/// Certain signs, with those of another look that lie beyond them or say otherwise than both their
/// neighbours.
fn reveal(certain: Vec<Signed>, others: Vec<Signed>) -> Vec<Signed> {
    let is_new = |other: &Signed| {
        let after = certain.partition_point(|signed| signed.sigma < other.sigma);
        let before = after.checked_sub(1).map(|at| certain[at]);
        match (before, certain.get(after)) {
            (Some(before), Some(after)) => {
                after.sigma > other.sigma
                    && before.negative == after.negative
                    && before.negative != other.negative
            }
            (_, None) => true,
            (None, Some(after)) => after.negative != other.negative && after.sigma > other.sigma,
        }
    };
    let new: Vec<Signed> = others.into_iter().filter(is_new).collect();
    let mut all = [certain, new].concat();
    all.sort_by(|a, b| a.sigma.total_cmp(&b.sigma));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signs(text: &[(f64, bool)]) -> Vec<Signed> {
        text.iter().map(|&(sigma, negative)| Signed { sigma, negative }).collect()
    }

    #[test]
    fn another_look_adds_what_lies_beyond_and_what_says_otherwise() {
        let certain = signs(&[(0.0, false), (1.0, false), (2.0, true), (3.0, true)]);
        let others = signs(&[(0.5, true), (1.5, true), (2.5, true), (2.6, false), (9.0, false)]);
        let all = reveal(certain, others);
        let added: Vec<f64> = all.iter().map(|signed| signed.sigma).collect();
        assert_eq!(added, [0.0, 0.5, 1.0, 2.0, 2.6, 3.0, 9.0]);
    }
}
