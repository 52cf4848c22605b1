//! What must be known beside the errors of a sweep: runs that escaped, nodes that settle by themselves
//! or are uncoupled, averages over less time than the oscillator needs to come back.

use std::collections::BTreeMap;

use dynamics::lyapunov::Times;
use dynamics::{Outcome, Run};
use msf::{Isolated, MasterStability};

use crate::numbers::{four_digits, plain, two_digits, with_error};
use crate::simulated::end::Known;
use crate::simulated::range::Seen;
use crate::simulated::{Apart, Simulated};
use crate::stability::word;
use crate::{Findings, Study, Sweep, Warnings};

/// The least averages and transients, in slow times of the oscillator.
const LEAST_AVERAGE: f64 = 10.0;
const LEAST_TRANSIENT: f64 = 2.0;
/// Ranges of ε named one by one.
const NAMED: usize = 8;

/// Warns of times too short for the slowest motion of the oscillator, before anything is simulated.
pub fn warn_of_short_times(study: &Study, msf: &MasterStability, warnings: &mut Warnings<'_>) {
    let component = study.sweep.as_ref().map_or(0, |sweep| sweep.observables.component);
    let seed = study.seed;
    let slow =
        dynamics::slow_time(study.node.dynamics.as_ref(), component, study.msf.times.step, seed);
    // An orbit at rest has no slow time, and the master stability function tells of one that escapes.
    let Ok(Some(slow)) = slow else { return };
    let Times { average, transient, .. } = study.msf.times;
    let mut times = vec![
        ("experiment.msf.average", "msf.average", average, LEAST_AVERAGE),
        ("experiment.msf.transient", "msf.transient", transient, LEAST_TRANSIENT),
    ];
    // Nothing is averaged over an orbit that closes.
    if msf.closes.is_some() {
        times.clear();
    }
    if let Some(Sweep { schedule, .. }) = &study.sweep {
        times.push(("experiment.sweep.average", "sweep.average", schedule.average, LEAST_AVERAGE));
        times.push((
            "experiment.sweep.transient",
            "sweep.transient",
            schedule.transient,
            LEAST_TRANSIENT,
        ));
    }
    for (about, key, time, least) in times {
        if time < least * slow {
            let message = format!(
                "`{key}` is {}, but an isolated oscillator takes up to {} from one upward crossing of \
                 its mean to the next: take {} or more",
                plain(time),
                two_digits(slow),
                two_digits(least * slow)
            );
            warnings.add(about, message);
        }
    }
}

/// Warns of what errors of a sweep do not mean, and of runs that are in no mean.
pub fn warn_of_runs(msf: &MasterStability, simulated: &Simulated, warnings: &mut Warnings<'_>) {
    warn_of_isolated(msf, warnings);
    warn_of_zero_coupling(simulated, warnings);
    warn_of_escapes(simulated, warnings);
    warn_of_parted_runs(simulated, warnings);
}

/// How far apart groups of seeds must be to count: less where orbits are known to end in several ways.
pub fn apart(msf: &MasterStability) -> Apart {
    let has_several = msf.attractors.len() > 1 || msf.rests.len() > 1;
    if has_several { Apart::EXPECTED } else { Apart::UNEXPECTED }
}

/// Warns of predicted states that seeds of the sweep show from, or up to, different ε on.
pub fn warn_of_groups(findings: &Findings, warnings: &mut Warnings<'_>) {
    if !findings.simulated.as_ref().is_some_and(Simulated::has_pairs) {
        return;
    }
    for (at, state) in findings.cascade.iter().enumerate() {
        let clusters = state.clusters.nontrivial();
        let seen = findings.state_seen(at, &clusters).filter(|_| !clusters.is_empty());
        let Some(Seen { onset, end }) = seen else { continue };
        for (name, end) in [("onset", onset), ("upper end", end)] {
            if end.bound == Known::Groups {
                let groups: Vec<String> = end.groups.iter().map(ToString::to_string).collect();
                let message = format!(
                    "the {name} of the state predicted from epsilon = {} on is not one number, so that \
                     no mean is given: {}",
                    four_digits(state.epsilon.0),
                    groups.join(", ")
                );
                warnings.add("cascade", message);
            }
        }
    }
}

/// What errors mean follows from what a node does by itself, where that is not chaos on one attractor.
fn warn_of_isolated(msf: &MasterStability, warnings: &mut Warnings<'_>) {
    let exponent = with_error(msf.isolated.mean, msf.isolated.standard_error);
    let what = if msf.attractors.len() > 1 {
        let kinds: Vec<&str> = msf.attractors.iter().map(|a| word(a.state)).collect();
        format!(
            "an isolated oscillator settles on one of {} attractors ({}): which of them nodes come to \
             depends on where they start, so that errors and onsets may differ from seed to seed by \
             more than chance",
            kinds.len(),
            kinds.join(", ")
        )
    } else {
        match (msf.state, msf.rests.len()) {
            (Isolated::Chaotic, _) => return,
            (Isolated::Periodic, _) => format!(
                "Lambda(0) = {exponent} is zero within its error, as on a limit cycle or a torus, where \
                 neighbours neither part nor approach: without coupling nodes keep the phases in which \
                 they start, so that errors at weak coupling depend on the seed, and longer averages do \
                 not change that"
            ),
            (Isolated::AtRest, 0 | 1) => format!(
                "Lambda(0) = {exponent} is below zero: an oscillator by itself comes to rest in the same \
                 state from wherever it starts, so that small errors are no sign of coupling"
            ),
            (Isolated::AtRest, n) => format!(
                "Lambda(0) = {exponent} is below zero: an oscillator by itself comes to rest in one of {n} \
                 states, so that small errors of nodes in the same one are no sign of coupling, and \
                 those of others are the distances of these states"
            ),
        }
    };
    warnings.add("simulations", what);
}

/// Every stretch of ε at which runs fall into two groups.
fn warn_of_parted_runs(simulated: &Simulated, warnings: &mut Warnings<'_>) {
    let parted: Vec<usize> =
        (0..simulated.epsilon.len()).filter(|&at| simulated.parted(at).is_some()).collect();
    let stretches: Vec<&[usize]> = parted.chunk_by(|a, b| b - a == 1).collect();
    for stretch in stretches.iter().take(NAMED) {
        let Some(groups) = simulated.parted(stretch[0]) else { continue };
        let group = |(n_runs, [least, most]): &(usize, [f64; 2])| {
            let range = if n_runs == &1 {
                two_digits(*most)
            } else {
                format!("{} to {}", two_digits(*least), two_digits(*most))
            };
            format!("{n_runs} with largest errors of {range}")
        };
        let groups: Vec<String> = groups.iter().map(group).collect();
        let message = format!(
            "at epsilon = {} runs fall into two groups, and means are of neither: {}{}",
            place(simulated, stretch),
            groups.join(", "),
            if stretch.len() > 1 { " at the first of these" } else { "" }
        );
        warnings.add("simulations", message);
    }
    tell_of_others("fall into groups", stretches.len(), warnings);
}

/// Couplings at which the integrator gave up, each with its seeds.
pub fn warn_of_failures(runs: &[Run], warnings: &mut Warnings<'_>) {
    let mut at: BTreeMap<u64, Vec<(&Run, f64, &str)>> = BTreeMap::new();
    for run in runs {
        if let Outcome::Failed { time, reason } = &run.outcome {
            at.entry(run.replica.epsilon.to_bits()).or_default().push((run, *time, reason));
        }
    }
    for failed in at.into_values() {
        let (run, time, reason) = failed[0];
        let seeds: Vec<String> =
            failed.iter().map(|(run, ..)| run.replica.seed.to_string()).collect();
        warnings.add(
            "simulations",
            format!(
                "at epsilon = {} the integrator gave up with seed{} {}, first at time {}: {}; a \
                 looser `sweep.tolerance` or weaker coupling is within its reach",
                plain(run.replica.epsilon),
                if seeds.len() == 1 { "" } else { "s" },
                seeds.join(", "),
                plain(time),
                reason
            ),
        );
    }
}

/// Ranges of ε that are not named.
fn tell_of_others(what: &str, stretches: usize, warnings: &mut Warnings<'_>) {
    if let Some(left) = stretches.checked_sub(NAMED).filter(|&left| left > 0) {
        let message = format!("runs {what} in {left} more ranges of epsilon, see sweep.csv");
        warnings.add("simulations", message);
    }
}

/// A stretch of points of a sweep.
fn place(simulated: &Simulated, stretch: &[usize]) -> String {
    let epsilon = |at: &usize| plain(simulated.epsilon[*at]);
    match stretch {
        [at] => epsilon(at),
        _ => format!("{} to {}", epsilon(&stretch[0]), epsilon(&stretch[stretch.len() - 1])),
    }
}

/// Nodes without coupling whose errors are small are alike by their own dynamics.
fn warn_of_zero_coupling(simulated: &Simulated, warnings: &mut Warnings<'_>) {
    let Some(position) = simulated.position(0.0) else { return };
    let Some(mean) = simulated.mean_pairs(position) else { return };
    let (bound, n_nodes) = (simulated.bound(position), simulated.n_nodes());
    let pairs = (0..n_nodes).flat_map(|i| (i + 1..n_nodes).map(move |j| (i, j)));
    let alike = pairs.filter(|&(i, j)| mean.of(i, j) < bound).count();
    if alike == 0 {
        return;
    }
    let message = format!(
        "at epsilon = 0 nodes are uncoupled and none counts as synchronised, though {alike} of {} \
         pairs have errors below {}: their own dynamics makes them alike, or the average is too short",
        n_nodes * (n_nodes - 1) / 2,
        two_digits(bound)
    );
    warnings.add("simulations", message);
}

/// Every stretch of ε at which the same number of runs escaped.
fn warn_of_escapes(simulated: &Simulated, warnings: &mut Warnings<'_>) {
    let n_runs = simulated.seeds.len();
    let escaped: Vec<usize> =
        (0..simulated.epsilon.len()).map(|at| simulated.escaped(at)).collect();
    let stretches: Vec<Vec<usize>> = (0..simulated.epsilon.len())
        .collect::<Vec<_>>()
        .chunk_by(|&a, &b| escaped[a] == escaped[b])
        .filter(|stretch| escaped[stretch[0]] > 0)
        .map(<[usize]>::to_vec)
        .collect();
    for stretch in stretches.iter().take(NAMED) {
        let place = place(simulated, stretch);
        let message = match escaped[stretch[0]] {
            all if all == n_runs => {
                let who = if all == 1 { "the only run".into() } else { format!("all {all} runs") };
                format!("at epsilon = {place} {who} escaped: no bounded orbit was found")
            }
            some => format!(
                "at epsilon = {place} {some} of {n_runs} runs escaped; means there are over {}, and no \
                 cluster counts as synchronised in a run that escaped",
                simulated.bounded(stretch[0])
            ),
        };
        warnings.add("simulations", message);
    }
    tell_of_others("escaped", stretches.len(), warnings);
}
