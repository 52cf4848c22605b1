//! Vertical lines on a sweep: where the predicted clusters change, and where the source saw that.

use eigensync::Findings;
use figures::{Label, Marker, MarkerGroup, MarkerStyle};
use msf::{StableRegion, Transition};

use crate::stretches::{Stretch, stretches};
use experiment::Plan;

/// Couplings that differ by less, relative to their size, differ by rounding.
const SAME: f64 = 1e-9;

/// The predicted transitions within the sweep at which clusters change or those of the modes that are
/// asked for, by the first mode of each eigenspace.
pub fn critical(plan: &Plan, findings: &Findings, [first, last]: [f64; 2]) -> MarkerGroup {
    let seen = stretches(&findings.cascade);
    let is_wanted = |transition: &&Transition| match &plan.figure.mark_modes {
        Some(modes) => modes.contains(&(transition.modes.start + 1)),
        None => changes_clusters(transition.epsilon, &seen),
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

/// Whether predicted clusters change at a coupling: one stretch of the same ones ends there and another
/// begins. What ends with nothing known below it does not count.
fn changes_clusters(epsilon: f64, stretches: &[Stretch]) -> bool {
    let begins = stretches.iter().skip(1).filter_map(|stretch| stretch.epsilon.1);
    begins.into_iter().any(|begin| (epsilon - begin).abs() <= SAME * begin)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stretches::tests::state;

    #[test]
    fn only_where_clusters_are_known_to_change_is_a_mark() {
        let states = [
            state((3.0, None), &[0, 0, 0]),
            state((2.0, Some(3.0)), &[0, 0, 1]),
            state((1.0, Some(2.0)), &[0, 0, 1]),
            state((0.5, Some(1.0)), &[0, 1, 2]),
        ];
        let seen = stretches(&states);
        let marked = [4.0, 3.0, 2.0, 1.0, 0.5].map(|epsilon| changes_clusters(epsilon, &seen));
        assert_eq!(marked, [false, true, false, true, false]);
    }
}
