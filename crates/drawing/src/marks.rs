//! Vertical lines on a sweep: where the predicted clusters change, and where the source saw that.

use clustering::State;
use eigensync::Findings;
use figures::{Label, Marker, MarkerGroup, MarkerStyle};
use msf::{StableRegion, Transition};

use experiment::Plan;

/// Couplings that differ by less, relative to their size, differ by rounding.
const SAME: f64 = 1e-9;

/// The predicted transitions within the sweep at which clusters change or those of the modes that are
/// asked for, by the first mode of each eigenspace.
pub fn critical(plan: &Plan, findings: &Findings, [first, last]: [f64; 2]) -> MarkerGroup {
    let is_wanted = |transition: &&Transition| match &plan.figure.mark_modes {
        Some(modes) => modes.contains(&(transition.modes.start + 1)),
        None => changes_clusters(transition.epsilon, &findings.cascade),
    };
    let within = findings.transitions.iter().filter(|t| (first..=last).contains(&t.epsilon));
    let marked = within.filter(is_wanted);
    let marker = |transition: &Transition| Marker {
        x: transition.epsilon,
        label: Some(name(transition, &findings.msf.stable)),
    };
    MarkerGroup {
        style: MarkerStyle::Predicted,
        legend: Some(Label::text("predicted")),
        markers: marked.map(marker).collect(),
    }
}

/// Whether a coupling is not within the range of one state. States end where clusters change, or no
/// more is known.
fn changes_clusters(epsilon: f64, cascade: &[State]) -> bool {
    let is_within = |state: &State| {
        let (from, to) = state.epsilon;
        epsilon > from * (1.0 + SAME) && to.is_none_or(|to| epsilon < to * (1.0 - SAME))
    };
    !cascade.iter().any(is_within)
}

/// ε_k, and where a mode is stable between two ends, which of them: the smallest or the largest ε at
/// which it is damped. Of several such windows ends are numbered as the zeros of Λ are.
fn name(Transition { modes, zero, .. }: &Transition, stable: &StableRegion) -> Label {
    let label = Label::math("ε").subscript(&(modes.start + 1).to_string());
    match stable.zeros().count() {
        1 => label,
        2 if stable.intervals.len() == 1 => {
            label.superscript(if zero.falling { "min" } else { "max" })
        }
        _ => {
            let number = 1 + stable.zeros().filter(|other| other.sigma < zero.sigma).count();
            label.superscript(&format!("({number})"))
        }
    }
}

/// The transitions that the source saw in its own simulations.
pub fn seen_by_the_source(plan: &Plan) -> MarkerGroup {
    let transitions = plan.figure.source_transitions.iter();
    MarkerGroup {
        style: MarkerStyle::Reference,
        legend: Some(Label::text("paper")),
        markers: transitions.map(|&x| Marker { x, label: None }).collect(),
    }
}
