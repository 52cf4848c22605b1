//! What an experiment will do and cost, in words: `eigensync check`.

use eigensync::{Sweep, Warning};
use std::fmt::Write;

use clustering::ClusterRule;
use dynamics::{Adaptive, AdaptiveOrder, Method};

use crate::drawing;
use crate::output::one_line;
use crate::plan::{Memory, Plan};
use crate::spec::{FigureKind, MatrixKind};
use crate::trial;

/// What is unusual about a network, before anything is computed.
pub fn doubts(plan: &Plan) -> Vec<Warning> {
    let network = &plan.study.network;
    let isolated = network.isolated_nodes();
    if isolated.is_empty() {
        return Vec::new();
    }
    let labels: Vec<_> = isolated.iter().take(5).map(|&i| network.labels()[i].as_str()).collect();
    let more = if isolated.len() > labels.len() { ", …" } else { "" };
    let message = format!(
        "{} of {} nodes have no links ({}{more}); they receive no coupling",
        isolated.len(),
        network.n_nodes(),
        labels.join(", ")
    );
    vec![Warning { about: "network.isolated_nodes", message }]
}

/// The resolved plan and its cost.
pub fn describe(plan: &Plan) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        writeln!(text, "{name:<12} {}", one_line(&value)).expect("a string takes every line");
    };
    let (network, experiment) = (&plan.study.network, &plan.experiment);
    line("experiment", format!("{}: {}", plan.id, experiment.title));
    line(
        "network",
        format!(
            "{} nodes, {} links, {} component(s), {} isolated",
            network.n_nodes(),
            network.n_links(),
            plan.study.n_components,
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
        match plan.study.rule {
            ClusterRule::Exact => "exact clusters".into(),
            ClusterRule::Threshold(threshold) => format!("clusters at the threshold {threshold}"),
        },
    );
    let (times, sigma) = (plan.study.msf.times, &plan.study.msf.sigma);
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
    if let Some(sweep) = &plan.study.sweep {
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
    let mut text = format!("msf {:.1e} tangent steps", plan.study.msf_steps() as f64);
    let (mut seconds, mut notes) = (msf.seconds, String::new());
    if msf.escaped {
        notes.push_str("; the orbit of the msf escapes at once: no time can be told");
    }
    if let Some(sweep) = &plan.study.sweep {
        let node_steps = sweep.steps() as f64 * plan.study.network.n_nodes() as f64;
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
