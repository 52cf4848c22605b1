//! The curves of an atlas, pair by pair: a first look finds how far each must reach, then it is computed.
//! What an earlier run has left in the journal is taken from there.

use dynamics::Progress;
use experiment::{AtlasPlan, Pair, System};
use journal::{Journal, Kind};
use msf::{MasterStability, MsfError};
use user::{Problem, Result, Stages};

use crate::computed::{LOOK_SEED, curve_key, first_look, look_key, refined};

/// σ of a first look, about.
const LOOKS: u64 = 150;

/// The curves of all pairs, in order.
pub fn find(plan: &AtlasPlan, journal: &Journal, stages: &Stages) -> Result<Vec<MasterStability>> {
    let reaches = reaches(plan, journal, stages)?;
    let asked: Vec<(&System, &Pair, msf::Request)> = plan
        .pairs()
        .zip(reaches)
        .map(|((system, pair), reach)| (system, pair, system.request(reach, plan.points)))
        .collect();
    let key = |(_, pair, request): &(&System, &Pair, msf::Request)| {
        curve_key(journal, &pair.node, request)
    };
    let taken: Vec<Option<MasterStability>> =
        asked.iter().map(|asked| journal.take(Kind::Curve, &key(asked))).collect();
    journal.tell_taken();
    let missing = || asked.iter().zip(&taken).filter(|(_, taken)| taken.is_none());
    let mut left: u64 = missing().map(|((.., request), _)| request.steps()).sum();
    let computed = stages.extended("msf", left, |progress, ahead| {
        let mut one = |asked: &(&System, &Pair, msf::Request)| {
            let (system, pair, request) = asked;
            left -= request.steps();
            let advance = |zero: msf::Advance| {
                let steps = zero.exponents_ahead as u64 * request.times.steps();
                ahead(left + steps, &format!("{}: {}", name(system, pair), refined(zero)));
            };
            let curve =
                msf::master_stability_with(&pair.node.equations, request, progress, &advance)
                    .map_err(|error| failed(plan, (system, pair), &error))?;
            ahead(left, &format!("{} done", name(system, pair)));
            journal.keep(Kind::Curve, &key(asked), &curve);
            Ok(curve)
        };
        missing().map(|(asked, _)| one(asked)).collect::<Result<Vec<_>>>()
    })?;
    let mut computed = computed.into_iter();
    let each = taken.into_iter().map(|taken| taken.or_else(|| computed.next()));
    Ok(each.map(|curve| curve.expect("every curve was taken over or computed")).collect())
}

fn reaches(plan: &AtlasPlan, journal: &Journal, stages: &Stages) -> Result<Vec<f64>> {
    let looks: Vec<_> = plan
        .pairs()
        .map(|(system, pair)| {
            let times = first_look(pair.node.dynamics().is_map(), system.times());
            let key = look_key(journal, &pair.node, &times);
            (system, pair, times, key, journal.take::<f64>(Kind::Look, &key))
        })
        .collect();
    let missing = looks.iter().filter(|(.., taken)| taken.is_none());
    let steps = missing.map(|(_, _, times, ..)| LOOKS * times.steps()).sum();
    stages.measured("first looks", steps, |progress: Progress<'_>| {
        let reach = |(system, pair, times, key, taken): &(&System, &Pair, _, _, Option<f64>)| {
            if let Some(reach) = taken {
                return Ok(*reach);
            }
            let reach = msf::reach(&pair.node.equations, times, LOOK_SEED, progress)
                .map_err(|error| failed(plan, (system, pair), &error))?;
            journal.keep(Kind::Look, key, &reach);
            Ok(reach)
        };
        looks.iter().map(reach).collect()
    })
}

/// A pair in words.
pub fn name(system: &System, pair: &Pair) -> String {
    format!("{} {} to {}", system.name, pair.from, pair.to)
}

fn failed(plan: &AtlasPlan, (system, pair): (&System, &Pair), error: &MsfError) -> Problem {
    let message = format!("`atlas.{}`: {} to {}: {error}", system.name, pair.from, pair.to);
    Problem::new(message).in_file(&plan.file).hint(
        "either its parameters leave it no bounded attractor, or its `step` is too long for it",
    )
}
