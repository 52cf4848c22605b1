//! What must be known beside the master stability function: zeros that could not be refined, ends of
//! the look, attractors of several kinds, and what an isolated oscillator does.

use dynamics::Estimate;
use dynamics::lyapunov::{Integrator, takes_series};
use msf::{Attractor, End, Isolated, Zero};

use crate::numbers::{four_digits, plain, with_error};
use crate::{Study, Warnings};

/// What half the step changes is said of Λ(0) from this share of it on; below, it is in its error.
const STEP_MATTERS: f64 = 0.02;

/// What the isolated oscillator does, in a word.
pub fn word(state: Isolated) -> &'static str {
    match state {
        Isolated::Chaotic => "chaotic",
        Isolated::Periodic => "periodic",
        Isolated::AtRest => "at rest",
    }
}

/// Adds what is doubtful about a curve, and what follows for the network.
pub fn warn(study: &Study, msf: &msf::MasterStability, warnings: &mut Warnings<'_>) {
    for zero in msf.stable.zeros().filter(|zero| !zero.refined) {
        warnings.add("msf.zeros", unrefined(study, zero));
    }
    if let Some(shift) =
        msf.certain_isolated_step_shift().filter(|shift| is_large(*shift, msf.isolated))
    {
        warnings.add("msf.lyapunov_isolated", shifted_isolated(study, shift));
    }
    for interval in &msf.stable.intervals {
        if let End::Looked { sigma } = interval.from {
            let message = format!(
                "Λ < 0 from sigma = {} on, where the look begins, and it is not known how far below: \
                 nothing is predicted where a mode has a smaller sigma",
                four_digits(sigma)
            );
            warnings.add("msf.stable_ends", message);
        }
    }
    for &[from, to] in &msf.doubtful {
        let [from, to] = [from, to].map(four_digits);
        let message = format!(
            "between sigma = {from} and {to} Λ comes so near zero that it may change its sign twice unseen: \
             take a finer `msf.sigma` there, or a longer `msf.average`"
        );
        warnings.add("msf.doubtful", message);
    }
    if !msf.attractors.is_empty() {
        warnings.add("msf.attractors", several(&msf.attractors));
    }
    if msf.state == Isolated::AtRest {
        warnings.add("msf.isolated_state", at_rest(msf));
    }
    if study.n_components > 1 && !msf.stable.contains(0.0) {
        let n = study.n_components;
        let message = format!(
            "the network has {n} components, so {n} modes have eigenvalue 0 and no coupling \
             synchronises it globally"
        );
        warnings.add("network.components", message);
    }
}

fn at_rest(msf: &msf::MasterStability) -> String {
    let exponent = with_error(msf.isolated.mean, msf.isolated.standard_error);
    let rests = format!("an isolated oscillator comes to rest, Λ(0) = {exponent}");
    if msf.rests.len() <= 1 {
        return format!("{rests}: nodes become equal even without coupling");
    }
    let counts: Vec<String> = msf.rests.iter().map(usize::to_string).collect();
    format!(
        "{rests}, but of {} with different initial states {} ended in {} different states: nodes do not \
         become equal by themselves, and what is predicted holds for nodes in the same one only",
        msf.rests.iter().sum::<usize>(),
        counts.join(" and "),
        counts.len()
    )
}

fn unrefined(study: &Study, zero: Zero) -> String {
    let asked = study.msf.refinement.relative_error;
    let by_step = zero.certain_step_shift();
    let why = match by_step.filter(|shift| shift.mean.abs() > asked * zero.sigma) {
        Some(shift) => format!(
            "{} moves it by {}, and would help",
            finer(study),
            with_error(shift.mean, shift.standard_error)
        ),
        None => "a longer `msf.average` or a finer grid near it would help".to_owned(),
    };
    format!(
        "the zero of Λ at sigma = {} is not as good as `msf.relative_error` = {asked} asks for, and \
         neither is any critical coupling, range of ε or claim that follows from it: {why}",
        with_error(zero.sigma, zero.standard_error),
    )
}

/// What was tried beside the integrator that was asked for.
fn finer(study: &Study) -> String {
    let msf::Node { dynamics, coupling } = &study.node;
    let times = &study.msf.times;
    match times.integrator {
        Integrator::Taylor { tolerance } | Integrator::Auto { tolerance }
            if takes_series(dynamics.as_ref(), coupling, times) =>
        {
            format!("a thousandth of `msf.tolerance` = {}", plain(tolerance))
        }
        _ => format!("half of `msf.step` = {}", plain(times.step)),
    }
}

/// Whether a change by the step matters beside the number.
fn is_large(shift: Estimate, number: Estimate) -> bool {
    shift.mean.abs() > STEP_MATTERS * number.mean.abs()
}

fn shifted_isolated(study: &Study, shift: Estimate) -> String {
    format!(
        "{} changes Λ(0) by {}, and the curve Λ(sigma) likewise, and would be better",
        finer(study),
        with_error(shift.mean, shift.standard_error)
    )
}

fn several(attractors: &[Attractor]) -> String {
    let each: Vec<String> = attractors.iter().map(one).collect();
    format!(
        "orbits settle on {} different attractors, told apart by Λ at sigma = {}: {}. The curve is that \
         of the first; the stable set is what is stable on each",
        attractors.len(),
        four_digits(attractors[0].told_at),
        each.join("; ")
    )
}

fn one(attractor: &Attractor) -> String {
    let zeros: Vec<String> =
        attractor.stable.zeros().map(|zero| with_error(zero.sigma, zero.standard_error)).collect();
    let zeros = if zeros.is_empty() {
        "no zero".to_owned()
    } else {
        format!("zeros at sigma = {}", zeros.join(", "))
    };
    format!(
        "{} of {} orbits with Λ = {} there, {zeros}",
        attractor.orbits,
        attractor.of,
        with_error(attractor.lambda.mean, attractor.lambda.standard_error)
    )
}
