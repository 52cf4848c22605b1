//! What must be known beside the master stability function: zeros that could not be refined, ends of
//! the look, attractors of several kinds, and what an isolated oscillator does.

use msf::{Attractor, End, Isolated, Zero};

use crate::plan::Plan;
use crate::table::{four_digits, two_digits};
use crate::warning::Warnings;

/// What the isolated oscillator does, in a word.
pub fn word(state: Isolated) -> &'static str {
    match state {
        Isolated::Chaotic => "chaotic",
        Isolated::Periodic => "periodic",
        Isolated::AtRest => "at rest",
    }
}

/// A number with its standard error.
pub fn with_error(value: f64, error: f64) -> String {
    format!("{} ± {}", four_digits(value), two_digits(error))
}

/// Adds what is doubtful about a curve, and what follows for the network.
pub fn warn(plan: &Plan, msf: &msf::MasterStability, warnings: &mut Warnings) {
    for zero in msf.stable.zeros().filter(|zero| !zero.refined) {
        warnings.add("msf.zeros", unrefined(plan, zero));
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
    if !msf.attractors.is_empty() {
        warnings.add("msf.attractors", several(&msf.attractors));
    }
    if msf.state == Isolated::AtRest {
        warnings.add("msf.isolated_state", at_rest(msf));
    }
    if plan.n_components > 1 && !msf.stable.contains(0.0) {
        let n = plan.n_components;
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

fn unrefined(plan: &Plan, zero: Zero) -> String {
    format!(
        "the zero of Λ at sigma = {} is not as good as `msf.relative_error` = {} asks for: neither is \
         any critical coupling, range of ε or claim that follows from it. A longer `msf.average` or a \
         finer grid near it would help",
        with_error(zero.sigma, zero.standard_error),
        plan.msf.refinement.relative_error
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
