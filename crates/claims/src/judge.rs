//! The verdict on a claim.

use std::collections::BTreeSet;

use eigensync::numbers::plain;
use eigensync::{Findings, Study};
use serde_json::{Value, json};

use crate::answer::Answer;
use crate::claim::{Claim, Stated};
use crate::found::Found;
use crate::judged::{Judged, Runs, Verdict};
use crate::name::named;
use crate::number::{Number, all, follows};
use crate::order;
use crate::quantity::{Clusters, ClustersAt, From, Obtained};
use crate::trend::Trend;

/// Judges a claim by what was found; `is_quick` says whether averages were shortened.
pub fn judge(claim: &Claim, study: &Study, findings: &Findings, is_quick: bool) -> Judged {
    let found = Found { study, findings, at: &claim.at };
    let Sides { paper, obtained, tolerance, uncertainty, answer } = sides(claim, &found);
    let verdict = match (&answer, &claim.known_difference) {
        (Answer::Holds, _) => Verdict::Holds,
        (Answer::CannotBeJudged(_), _) if is_quick && claim.of.is_averaged() => {
            Verdict::NeedsFullRun
        }
        (Answer::CannotBeJudged(_), _) => Verdict::CannotBeJudged,
        (Answer::Differs, Some(_)) => Verdict::DiffersAsKnown,
        (Answer::Differs, _) if is_quick && claim.of.is_simulated() => Verdict::NeedsFullRun,
        (Answer::Differs | Answer::NothingToJudge, _) => Verdict::Differs,
    };
    let reason = match answer {
        Answer::CannotBeJudged(why) => why,
        Answer::NothingToJudge => "there is nothing to judge".into(),
        Answer::Holds | Answer::Differs => {
            let known = claim.known_difference.clone();
            let known = known.filter(|_| verdict == Verdict::DiffersAsKnown);
            known.unwrap_or_else(|| claim.reason.clone())
        }
    };
    Judged {
        name: claim.name.clone(),
        source: claim.source.clone(),
        paper,
        obtained,
        uncertainty,
        runs: runs(claim, &found).filter(|runs| runs.bounded < runs.of || runs.of == 1),
        refined: (claim.of.is_unrefined)(&found).then_some(false),
        tolerance,
        verdict,
        reason,
    }
}

/// The runs on which a simulated claim stands.
fn runs(claim: &Claim, found: &Found<'_>) -> Option<Runs> {
    let of = found.findings.simulated.as_ref()?.seeds.len();
    Some(Runs { bounded: (claim.of.bounded_runs)(found)?, of })
}

/// Both sides of a claim and the answer.
struct Sides {
    paper: Value,
    obtained: Value,
    tolerance: String,
    /// How well a single obtained number is known, where that is more than rounding.
    uncertainty: Option<f64>,
    answer: Answer,
}

impl Sides {
    fn new(paper: Value, obtained: Value, tolerance: impl Into<String>, answer: Answer) -> Self {
        Self { paper, obtained, tolerance: tolerance.into(), uncertainty: None, answer }
    }
}

fn sides(claim: &Claim, found: &Found<'_>) -> Sides {
    match (&claim.of.obtained, &claim.stated) {
        (Obtained::Numbers(of) | Obtained::List(of), stated) => {
            let obtained = of(found);
            let uncertainty = uncertainty(claim, &obtained);
            Sides { uncertainty, ..numbers(&obtained, stated) }
        }
        (Obtained::Vectors(of), Stated::Vectors { vectors, abs_tol }) => {
            eigenvectors(claim, of(found, vectors), *abs_tol)
        }
        (Obtained::Clusters(of), Stated::Clusters { named, nodes }) => {
            let epsilon = claim.at.epsilon.first().copied().unwrap_or_default();
            clusters(found, epsilon, of(found, epsilon), (named, nodes))
        }
        (Obtained::Losses { between, exactly }, Stated::Order(order)) => {
            let lost = claim.at.clusters.iter().enumerate();
            let lost: Result<Vec<[f64; 2]>, Answer> =
                lost.map(|(at, cluster)| between(found, at, cluster)).collect();
            in_order(order, lost, *exactly)
        }
        // A claim that was checked states what its quantity is.
        _ => Sides::new(Value::Null, Value::Null, "exact", Answer::NothingToJudge),
    }
}

/// Eigenvalues are known to rounding, and in an order it is not one number that matters.
fn uncertainty(claim: &Claim, obtained: &[Number]) -> Option<f64> {
    match obtained {
        _ if claim.of.from == From::Modes || claim.at.in_order => None,
        [Number::Known { error, .. }] if *error > 0.0 => Some(*error),
        _ => None,
    }
}

fn numbers(obtained: &[Number], stated: &Stated) -> Sides {
    let shown = match obtained {
        [single] => single.shown(),
        many => many.iter().map(Number::shown).collect(),
    };
    match stated {
        Stated::AtMost(limit) => {
            let answer = all(obtained, |_, x| x.is_within(f64::NEG_INFINITY, *limit));
            Sides::new(json!(format!("at most {limit}")), shown, "exact", answer)
        }
        Stated::AtLeast(limit) => {
            let answer = all(obtained, |_, x| x.is_within(*limit, f64::INFINITY));
            Sides::new(json!(format!("at least {limit}")), shown, "exact", answer)
        }
        Stated::Trend(trend) => {
            let word = if *trend == Trend::Rises { "rising" } else { "falling" };
            Sides::new(json!(word), shown, "exact", follows(obtained, *trend))
        }
        Stated::Numbers { values, abs_tol, rel_tol } => {
            let (abs, rel) = (*abs_tol, *rel_tol);
            // A hair of slack: 4.2 ± 0.1 holds 4.1, whose difference is 0.10000000000000053.
            let allowed = |expected: f64| (abs + rel * expected.abs()) * (1.0 + 1e-9);
            let near = |at: usize, x: &Number| {
                let expected = values[at];
                x.is_within(expected - allowed(expected), expected + allowed(expected))
            };
            let is_complete = obtained.len() == values.len();
            let answer = match is_complete {
                // None are claimed, and there are none.
                true if values.is_empty() => Answer::Holds,
                true => all(obtained, near),
                false => Answer::Differs,
            };
            let paper = if let [single] = values[..] { json!(single) } else { json!(values) };
            Sides::new(paper, shown, tolerance(abs, rel), answer)
        }
        Stated::Vectors { .. } | Stated::Clusters { .. } | Stated::Order(_) => {
            Sides::new(Value::Null, shown, "exact", Answer::NothingToJudge)
        }
    }
}

fn tolerance(abs: f64, rel: f64) -> String {
    match (abs > 0.0, rel > 0.0) {
        (true, true) => format!("± {abs} ± {} %", 100.0 * rel),
        (true, false) => format!("± {abs}"),
        (false, true) => format!("± {} %", 100.0 * rel),
        (false, false) => "exact".into(),
    }
}

fn eigenvectors(claim: &Claim, distances: Result<Vec<f64>, String>, allowed: f64) -> Sides {
    let modes = claim.at.modes.as_deref().unwrap_or_default();
    let (first, last) = (modes.iter().min().unwrap_or(&0), modes.iter().max().unwrap_or(&0));
    let paper = json!(format!("modes {first} to {last}"));
    let tolerance = format!("≤ {allowed}");
    match distances {
        Err(why) => Sides::new(paper, Value::Null, tolerance, Answer::CannotBeJudged(why)),
        Ok(distances) => {
            let farthest = distances.iter().copied().fold(0.0, f64::max);
            let near = distances.iter().map(|&distance| (distance <= allowed).into());
            let shown = json!(format!("{farthest:.4} away"));
            Sides::new(paper, shown, tolerance, Answer::of_all(near))
        }
    }
}

/// Whether these are the clusters, whichever of those found is right; the first is shown.
fn clusters(
    found: &Found<'_>,
    epsilon: f64,
    obtained: ClustersAt,
    (paper, nodes): (&[Vec<String>], &[Vec<usize>]),
) -> Sides {
    let (shown, answer) = match obtained {
        Ok(all) => {
            let clusters = all[0].as_deref().unwrap_or_default();
            (json!(named(clusters, &found.study.network)), is_one_of(epsilon, nodes, &all))
        }
        Err(why) => (Value::Null, why.map_or(Answer::Differs, Answer::CannotBeJudged)),
    };
    Sides::new(json!(paper), shown, "exact", answer)
}

fn is_one_of(epsilon: f64, stated: &[Vec<usize>], obtained: &[Clusters]) -> Answer {
    let stated = as_sets(stated);
    let is_stated = |clusters: &&Clusters| clusters.as_ref().is_some_and(|c| as_sets(c) == stated);
    match obtained.iter().filter(is_stated).count() {
        0 => Answer::Differs,
        all if all == obtained.len() => Answer::Holds,
        _ => Answer::CannotBeJudged(format!(
            "a critical coupling is not known well enough to tell on which side of it epsilon = {} lies",
            plain(epsilon)
        )),
    }
}

/// Clusters without an order.
fn as_sets(clusters: &[Vec<usize>]) -> BTreeSet<BTreeSet<usize>> {
    clusters.iter().map(|cluster| cluster.iter().copied().collect()).collect()
}

/// Positions of the clusters, from 1, in the order in which they are lost as ε falls.
fn in_order(order: &[usize], lost: Result<Vec<[f64; 2]>, Answer>, exactly: bool) -> Sides {
    let paper = json!(order);
    match lost {
        Err(answer) => Sides::new(paper, Value::Null, "exact", answer),
        Ok(lost) => {
            let answer = order::follows(order, &lost, exactly);
            let shown = match answer {
                Answer::CannotBeJudged(_) => Value::Null,
                _ => json!(order::order_shown(&lost, exactly)),
            };
            Sides::new(paper, shown, "exact", answer)
        }
    }
}
