//! The first answer of a prediction, at once: the same study with short averages and zeros to a per cent.

use std::time::Instant;

use crate::output::tell;
use crate::run::seconds;
use experiment::Plan;
use runner::computed::Curves;
use runner::{Work, findings, overview};
use user::Stages;

/// Standard error of a zero, relative to it, that is good enough for a first answer.
const ACCURACY: f64 = 0.01;
/// Times of its exponents, in units of the model: enough for Λ to a few per cent, and for most orbits to have
/// settled.
const TRANSIENT: f64 = 200.0;
const AVERAGE: f64 = 1000.0;

/// Tells what a prediction will be, about. What keeps it from being found is for the whole answer to say.
pub fn tell(work: &mut FirstWork<'_>, curves: &mut Curves) {
    let started = Instant::now();
    let whole = work.plan.study.msf.clone();
    let times = &mut work.plan.study.msf.times;
    times.transient = times.transient.min(TRANSIENT);
    times.average = times.average.min(AVERAGE.max(20.0 * times.renormalise));
    work.plan.study.msf.refinement.relative_error = ACCURACY;
    let found = {
        let first = Work { plan: work.plan, journal: work.journal, stages: work.stages };
        findings::find(&first, curves)
    };
    if let Ok(found) = found {
        let text = overview::of(work.plan, &found);
        tell!(
            "first answer, after {}, with zeros to about a per cent:\n\n{text}\n\nnow to {}",
            seconds(started.elapsed()),
            whole.refinement.relative_error
        );
    }
    work.plan.study.msf = whole;
}

/// What the first answer is found with.
pub struct FirstWork<'a> {
    /// The plan of the whole answer, which is left as it was.
    pub plan: &'a mut Plan,
    pub journal: &'a journal::Journal,
    /// Those that nobody watches: warnings belong to the whole answer.
    pub stages: &'a Stages,
}
