//! What an experiment will do and cost, in words: `eigensync check`.

use std::fmt::Write;
use std::time::{Duration, Instant};

use clustering::ClusterRule;
use dynamics::lyapunov::{Tangent, Times, master_exponents};
use dynamics::{Adaptive, AdaptiveOrder, Method, Observables, Schedule, Simulation};
use spectra::Spectrum;

use crate::drawing;
use crate::plan::{Memory, Plan, Sweep};
use crate::spec::{FigureKind, MatrixKind};
use crate::warning::Warnings;

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

/// Where links are too weak beside others to count in the spectrum.
pub fn warn_of_weak_links(plan: &Plan, spectrum: &Spectrum, warnings: &mut Warnings) {
    let n_zero = spectrum.eigenspaces.first().map_or(0, ExactSizeIterator::len);
    if n_zero > plan.n_components {
        let network = match plan.n_components {
            1 => "the network is connected".into(),
            n => format!("the network has {n} components"),
        };
        let message = format!(
            "{network}, yet {n_zero} modes have eigenvalue 0 up to {:.0e}: links much weaker than \
             the strongest hold no nodes together here",
            spectrum.tolerance
        );
        warnings.add("spectrum.tolerance", message);
    }
}

/// The resolved plan and its cost.
pub fn describe(plan: &Plan) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        writeln!(text, "{name:<12} {value}").expect("a string takes every line");
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
                "{} values of epsilon, {} to {}; {} seeds; {}, step {}, transient {}, average {}; \
                 synchronised below {}",
                epsilon.len(),
                epsilon[0],
                epsilon[epsilon.len() - 1],
                sweep.seeds.len(),
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
    line("memory", Memory::of(plan).to_string());
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
    let msf = plan.msf_steps() as f64 * seconds_per_tangent_step(plan) / threads;
    let mut text = format!("msf {:.1e} tangent steps", plan.msf_steps() as f64);
    let mut total = msf;
    if let Some(sweep) = &plan.sweep {
        let node_steps = sweep.steps() as f64 * plan.network.n_nodes() as f64;
        total += sweep.steps() as f64 * seconds_per_step(plan, sweep) / threads;
        write!(text, ", sweep {node_steps:.1e} node steps").expect("a string takes every line");
    }
    format!("{text}: about {:.0} s on {threads} thread(s)", total.ceil())
}

fn seconds_per_tangent_step(plan: &Plan) -> f64 {
    let times =
        Times { transient: 0.0, average: 20.0 * plan.msf.times.renormalise, ..plan.msf.times };
    let tangents: Vec<_> = (0..16).map(|seed| Tangent { sigma: 1.0, seed }).collect();
    let node = &plan.node;
    let took = timed(|| {
        on_one_thread(|| master_exponents(node.model, node.coupling, &times, &tangents, &|_| ()))
    });
    took.as_secs_f64() / (16.0 * times.steps() as f64)
}

fn seconds_per_step(plan: &Plan, sweep: &Sweep) -> f64 {
    // About two million node steps: a tenth of a second.
    let n_nodes = plan.network.n_nodes() as f64;
    let replicas: Vec<_> = sweep.replicas().into_iter().cycle().take(16).collect();
    let samples = (2e6 / (16.0 * n_nodes)).clamp(20.0, 2000.0);
    let schedule = Schedule {
        transient: 0.0,
        average: samples * sweep.schedule.step,
        stride: 1,
        ..sweep.schedule
    };
    let simulation = Simulation {
        model: plan.node.model,
        coupling: plan.node.coupling,
        matrix: plan.matrix.matrix(),
        method: sweep.method,
        schedule,
        observables: Observables::default(),
        kick: sweep.kick,
        instruction_set: plan.msf.instruction_set,
    };
    let took = timed(|| on_one_thread(|| simulation.run(&replicas, &|_| ())));
    took.as_secs_f64() / (16.0 * schedule.steps() as f64)
}

fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(work),
        // Without a pool of its own the trial runs on the common one and comes out too fast.
        Err(_) => work(),
    }
}

fn timed<T>(work: impl FnOnce() -> T) -> Duration {
    let started = Instant::now();
    let _ = work();
    started.elapsed()
}
