//! What an experiment will do and cost, in words: `eigensync check`.

use std::fmt::Write;

use clustering::ClusterRule;
use dynamics::{Adaptive, AdaptiveOrder, Method};
use spectra::Spectrum;

use crate::drawing;
use crate::output::one_line;
use crate::plan::{Memory, Plan, Sweep};
use crate::spec::{FigureKind, MatrixKind};
use crate::table::{four_digits, two_digits};
use crate::trial;
use crate::warning::Warnings;

/// The largest residual, relative to the eigenvalue, that leaves this certain.
const CERTAIN: f64 = 0.1;

/// What is unusual about a network, before anything is computed.
pub fn warn(plan: &Plan, warnings: &mut Warnings) {
    let network = &plan.network;
    let isolated = network.isolated_nodes();
    if !isolated.is_empty() {
        let labels: Vec<_> =
            isolated.iter().take(5).map(|&i| network.labels()[i].as_str()).collect();
        let more = if isolated.len() > labels.len() { ", …" } else { "" };
        let message = format!(
            "{} of {} nodes have no links ({}{more}); they receive no coupling",
            isolated.len(),
            network.n_nodes(),
            labels.join(", ")
        );
        warnings.add("network.isolated_nodes", message);
    }
}

/// Warns of eigenvalues that rounding beside the largest weight leaves uncertain.
pub fn warn_of_weak_links(spectrum: &Spectrum, warnings: &mut Warnings) {
    let spectrum = spectrum.real_modes();
    let n_zero = spectrum.eigenspaces.first().map_or(0, ExactSizeIterator::len);
    let modes = spectrum.eigenvalues.iter().enumerate().skip(n_zero);
    let mut lost = modes.filter(|(mode, lambda)| spectrum.error(*mode) > CERTAIN * lambda.abs());
    let Some((mode, lambda)) = lost.next() else { return };
    let message = format!(
        "lambda_{} = {} is uncertain by {}, and so are {} more eigenvalues: links much weaker than \
         the strongest are lost in rounding",
        mode + 1,
        four_digits(*lambda),
        two_digits(spectrum.error(mode)),
        lost.count()
    );
    warnings.add("eigenvalues", message);
}

/// The resolved plan and its cost.
pub fn describe(plan: &Plan) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        writeln!(text, "{name:<12} {}", one_line(&value)).expect("a string takes every line");
    };
    let (network, experiment) = (&plan.network, &plan.experiment);
    line("experiment", format!("{}: {}", plan.id, experiment.title));
    line(
        "network",
        format!(
            "{} nodes, {} links, {} component(s), {} isolated",
            network.n_nodes(),
            network.n_links(),
            plan.n_components,
            network.isolated_nodes().len()
        ),
    );
    let parameters = serde_json::to_string(&plan.node.model).unwrap_or_default();
    line("oscillator", parameters);
    let matrix = match experiment.coupling.matrix {
        MatrixKind::Laplacian => "laplacian",
        MatrixKind::Normalized => "normalized",
    };
    let (from, to) = (&experiment.coupling.from, &experiment.coupling.to);
    line("coupling", format!("{matrix}; {from} into {to}"));
    line(
        "prediction",
        match plan.rule {
            ClusterRule::Exact => "exact clusters".into(),
            ClusterRule::Threshold(threshold) => format!("clusters at the threshold {threshold}"),
        },
    );
    let (times, sigma) = (plan.msf.times, &plan.msf.sigma);
    line(
        "msf",
        format!(
            "{} values of sigma, {} to {}; step {}, transient {}, average {}",
            sigma.len(),
            sigma[0],
            sigma[sigma.len() - 1],
            times.step,
            times.transient,
            times.average
        ),
    );
    if let Some(sweep) = &plan.sweep {
        let (schedule, epsilon) = (sweep.schedule, &sweep.epsilon);
        line(
            "sweep",
            format!(
                "{} values of epsilon, {} to {}; {} seeds, {} runs; {}, step {}, transient {}, average {}; \
                 synchronised below {}",
                epsilon.len(),
                epsilon[0],
                epsilon[epsilon.len() - 1],
                sweep.seeds.len(),
                epsilon.len() * sweep.seeds.len(),
                method(sweep),
                schedule.step,
                schedule.transient,
                schedule.average,
                sweep.synchronised_below
            ),
        );
    }
    line("figure", figure(plan));
    line("claims", experiment.claims.len().to_string());
    line("memory", format!("about {}", Memory::of(plan)));
    line("cost", cost(plan));
    text
}

/// The kind of the figure, and what it will not show as asked.
fn figure(plan: &Plan) -> String {
    let kind = match plan.figure().kind {
        FigureKind::Sweep => "sweep",
        FigureKind::Matrices => "matrices",
        FigureKind::Regions => "regions",
        FigureKind::None => "none",
    };
    std::iter::once(kind.to_owned()).chain(drawing::foreseen(plan)).collect::<Vec<_>>().join("; ")
}

/// The integrator by the name that experiment files call it.
fn method(sweep: &Sweep) -> &'static str {
    match sweep.method {
        Method::Rk4 => "rk4",
        Method::Adaptive(Adaptive { order: AdaptiveOrder::Five, .. }) => "dopri5",
        Method::Adaptive(Adaptive { order: AdaptiveOrder::Eight, .. }) => "dop853",
    }
}

/// Steps to be done, and the time they will take at the speed of a short trial on this machine.
fn cost(plan: &Plan) -> String {
    let threads = rayon::current_num_threads() as f64;
    let msf = trial::of_msf(plan);
    let mut text = format!("msf {:.1e} tangent steps", plan.msf_steps() as f64);
    let (mut seconds, mut notes) = (msf.seconds, String::new());
    if msf.escaped {
        notes.push_str("; the orbit of the msf escapes at once: no time can be told");
    }
    if let Some(sweep) = &plan.sweep {
        let node_steps = sweep.steps() as f64 * plan.network.n_nodes() as f64;
        write!(text, ", sweep {node_steps:.1e} node steps").expect("a string takes every line");
        let trial = trial::of_sweep(plan, sweep);
        seconds += trial.seconds;
        if trial.escaped {
            notes.push_str("; in the trial orbits of the sweep escape at once: it may end early");
        }
    }
    let seconds = (seconds / threads).ceil();
    format!("{text}: about {seconds:.0} s on {threads} thread(s){notes}")
}
