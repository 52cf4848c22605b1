//! Vertical lines on a sweep: where the predicted clusters change, and where the source saw that.

use clustering::State;
use eigensync::Findings;
use figures::{Label, Marker, MarkerGroup, MarkerStyle};
use msf::{CriticalCoupling, StableRegion};

use experiment::Plan;

/// Critical couplings of one transition differ by rounding alone, relative to their size.
const SAME: f64 = 1e-9;

/// The predicted critical couplings within the sweep at which clusters change or those of the modes
/// that are asked for, one for each run of equal eigenvalues.
pub fn critical(plan: &Plan, findings: &Findings, [first, last]: [f64; 2]) -> MarkerGroup {
    let eigenspaces = findings.spectrum.real_modes().eigenspaces;
    let leads = |mode: usize| eigenspaces.iter().any(|e| e.start + 1 == mode);
    let is_wanted = |critical: &CriticalCoupling| match &plan.figure.mark_modes {
        Some(modes) => modes.contains(&critical.mode),
        None => changes_clusters(critical.epsilon, &findings.cascade),
    };
    let within = findings.critical.iter().filter(|c| (first..=last).contains(&c.epsilon));
    let marked = within.filter(|c| leads(c.mode) && is_wanted(c));
    let marker = |critical: &CriticalCoupling| Marker {
        x: critical.epsilon,
        label: Some(name(critical, &findings.msf.stable)),
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
fn name(critical: &CriticalCoupling, stable: &StableRegion) -> Label {
    let label = Label::math("ε").subscript(&critical.mode.to_string());
    let zeros: Vec<f64> = stable.zeros().map(|zero| zero.sigma).collect();
    match zeros.len() {
        1 => label,
        2 if stable.intervals.len() == 1 => {
            label.superscript(if critical.stable_above { "min" } else { "max" })
        }
        _ => {
            let sigma = critical.epsilon * critical.lambda.abs();
            let is_nearer = |a: &usize, b: &usize| {
                (zeros[*a] - sigma).abs().total_cmp(&(zeros[*b] - sigma).abs())
            };
            let number = (0..zeros.len()).min_by(is_nearer).map_or(0, |zero| zero + 1);
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
