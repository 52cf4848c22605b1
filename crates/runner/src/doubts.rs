//! What must be known beside the errors of a sweep: runs that escaped, nodes that settle by themselves
//! or are uncoupled, averages over less time than the oscillator needs to come back.

use msf::{Isolated, MasterStability};

use crate::plan::{Plan, Sweep};
use crate::problem::plain;
use crate::simulated::Simulated;
use crate::stability::with_error;
use crate::table::two_digits;
use crate::warning::Warnings;

/// The least averages and transients, in slow times of the oscillator.
const LEAST_AVERAGE: f64 = 10.0;
const LEAST_TRANSIENT: f64 = 2.0;
/// Ranges of ε named one by one.
const NAMED: usize = 8;

/// Warns of times too short for the slowest motion of the oscillator, before anything is simulated.
pub fn warn_of_short_times(plan: &Plan, warnings: &mut Warnings) {
    let component = plan.sweep.as_ref().map_or(0, |sweep| sweep.observables.component);
    let seed = plan.experiment.seed;
    let slow = dynamics::slow_time(&plan.node.model, component, plan.msf.times.step, seed);
    // An orbit at rest has no slow time, and the master stability function tells of one that escapes.
    let Ok(Some(slow)) = slow else { return };
    let mut times = vec![
        ("experiment.msf.average", "msf.average", plan.msf.times.average, LEAST_AVERAGE),
        ("experiment.msf.transient", "msf.transient", plan.msf.times.transient, LEAST_TRANSIENT),
    ];
    if let Some(Sweep { schedule, .. }) = &plan.sweep {
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
pub fn warn_of_runs(msf: &MasterStability, simulated: &Simulated, warnings: &mut Warnings) {
    warn_of_rest(msf, warnings);
    warn_of_zero_coupling(simulated, warnings);
    warn_of_escapes(simulated, warnings);
}

/// Where neighbouring orbits of one oscillator do not part, nodes may agree without any coupling.
fn warn_of_rest(msf: &MasterStability, warnings: &mut Warnings) {
    let isolated = msf.isolated;
    if msf.state == Isolated::Chaotic {
        return;
    }
    let by_itself = if msf.rests.len() > 1 {
        "an oscillator by itself comes to rest in one of several states, in the same one as many others"
    } else {
        "an oscillator by itself forgets where it started"
    };
    let message = format!(
        "Lambda(0) = {} is not above zero within its error: {by_itself}, so that small errors are no \
         sign of coupling",
        with_error(isolated.mean, isolated.standard_error)
    );
    warnings.add("simulations", message);
}

/// Nodes without coupling whose errors are small are alike by their own dynamics.
fn warn_of_zero_coupling(simulated: &Simulated, warnings: &mut Warnings) {
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
fn warn_of_escapes(simulated: &Simulated, warnings: &mut Warnings) {
    let (epsilon, n_runs) = (&simulated.epsilon, simulated.seeds.len());
    let escaped: Vec<usize> = (0..epsilon.len()).map(|at| simulated.escaped(at)).collect();
    let stretches: Vec<Vec<usize>> = (0..epsilon.len())
        .collect::<Vec<_>>()
        .chunk_by(|&a, &b| escaped[a] == escaped[b])
        .filter(|stretch| escaped[stretch[0]] > 0)
        .map(<[usize]>::to_vec)
        .collect();
    for stretch in stretches.iter().take(NAMED) {
        let place = match stretch[..] {
            [at] => plain(epsilon[at]),
            _ => format!(
                "{} to {}",
                plain(epsilon[stretch[0]]),
                plain(epsilon[stretch[stretch.len() - 1]])
            ),
        };
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
    if let Some(left) = stretches.len().checked_sub(NAMED).filter(|&left| left > 0) {
        let message = format!("runs escaped in {left} more ranges of epsilon, see sweep.csv");
        warnings.add("simulations", message);
    }
}
