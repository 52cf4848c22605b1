//! What an experiment will do and cost, in words: `eigensync check`.

use eigensync::Warning;
use std::fmt::Write;

use clustering::ClusterRule;
use serde::Serialize;
use serde_json::Value;

use crate::orbits::Orbits;
use crate::overview;
use crate::trial::{self, Trial};
use experiment::spec::{FigureKind, MatrixKind};
use experiment::{Memory, Plan};
use user::text::one_line;

/// Characters of a number in a table.
const TEXT_OF_A_NUMBER: f64 = 20.0;

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
    let network = &plan.study.network;
    line("experiment", format!("{}: {}", plan.id, plan.title));
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
    let parameters = serde_json::to_string(&plan.node.oscillator).unwrap_or_default();
    line("oscillator", parameters);
    let matrix = match plan.matrix {
        MatrixKind::Laplacian => "laplacian",
        MatrixKind::Normalized => "normalized",
    };
    line("coupling", format!("{matrix}; {}", plan.node.function));
    line(
        "prediction",
        match plan.study.rule {
            ClusterRule::Exact => "exact clusters".into(),
            ClusterRule::Threshold(threshold) => format!("clusters at the threshold {threshold}"),
        },
    );
    let (times, sigma) = (plan.study.msf.times, &plan.study.msf.sigma);
    let where_to = match sigma[..] {
        [first, .., last] => format!("{} values of sigma, {first} to {last}", sigma.len()),
        _ => "sigma as far as the step goes".to_owned(),
    };
    line(
        "msf",
        format!(
            "{where_to}; step {}, transient {}, average {}",
            times.step, times.transient, times.average
        ),
    );
    if let Some(sweep) = &plan.study.sweep {
        let (schedule, epsilon) = (sweep.schedule, &sweep.epsilon);
        line(
            "sweep",
            format!(
                "{} values of epsilon, {} to {}; {} seeds, {} runs; {}{}, step {}, transient {}, average {}; \
                 synchronised below {}",
                epsilon.len(),
                epsilon[0],
                epsilon[epsilon.len() - 1],
                sweep.seeds.len(),
                epsilon.len() * sweep.seeds.len(),
                overview::method_name(sweep.method),
                plan.chosen
                    .map(|chosen| format!(" ({})", overview::error_of(&chosen)))
                    .unwrap_or_default(),
                schedule.step,
                schedule.transient,
                schedule.average,
                sweep.synchronised_below
            ),
        );
    }
    if let Some(recorded) = &plan.recorded {
        line(
            "series",
            format!(
                "{} replicas, {} states of {} numbers each; about {} of tables",
                recorded.replicas.len(),
                recorded.n_states,
                recorded.columns.len(),
                in_bytes(TEXT_OF_A_NUMBER * recorded.n_numbers())
            ),
        );
    }
    let msf = trial::of_msf(plan);
    line("orbits", Orbits::of(plan, msf).to_string());
    line("figure", figure(plan));
    line("claims", plan.claims.len().to_string());
    line("memory", format!("about {}", Memory::of(plan)));
    line("cost", Cost::of(plan, msf).words());
    for warning in doubts(plan).iter().chain(&plan.doubts) {
        line("warning", warning.message.clone());
    }
    text
}

/// A size as people read it.
fn in_bytes(bytes: f64) -> String {
    match bytes {
        1e9.. => format!("{:.1} GB", bytes / 1e9),
        1e6.. => format!("{:.0} MB", bytes / 1e6),
        _ => format!("{:.0} kB", (bytes / 1e3).ceil()),
    }
}

/// The kind of the figure, and what it will not show as asked.
fn figure(plan: &Plan) -> String {
    let kind = match plan.figure.kind {
        FigureKind::Sweep => "sweep",
        FigureKind::Matrices => "matrices",
        FigureKind::Regions => "regions",
        FigureKind::None => "none",
    };
    std::iter::once(kind.to_owned()).chain(drawing::foreseen(plan)).collect::<Vec<_>>().join("; ")
}

/// Steps to be done, and the time they will take at the speed of a short trial on this machine.
#[derive(Serialize)]
struct Cost {
    msf_tangent_steps: u64,
    /// None without a sweep.
    sweep_node_steps: Option<f64>,
    seconds: f64,
    threads: usize,
    /// What the trial showed that makes the time uncertain.
    notes: Vec<&'static str>,
}

impl Cost {
    fn of(plan: &Plan, msf: Trial) -> Self {
        let threads = rayon::current_num_threads();
        let (mut seconds, mut notes) = (msf.seconds, Vec::new());
        if msf.escaped {
            notes.push("the orbit of the msf escapes at once: no time can be told");
        }
        let nodes = plan.study.network.n_nodes() as f64;
        if let Some(sweep) = &plan.study.sweep {
            let trial = trial::of_sweep(plan, sweep);
            seconds += trial.seconds;
            if trial.escaped {
                notes.push("in the trial orbits of the sweep escape at once: it may end early");
            }
        }
        Self {
            msf_tangent_steps: plan.study.msf_steps(),
            sweep_node_steps: plan.study.sweep.as_ref().map(|sweep| sweep.steps() as f64 * nodes),
            seconds: (seconds / threads as f64).ceil(),
            threads,
            notes,
        }
    }

    fn words(&self) -> String {
        let mut text = format!("msf {:.1e} tangent steps", self.msf_tangent_steps as f64);
        if let Some(node_steps) = self.sweep_node_steps {
            write!(text, ", sweep {node_steps:.1e} node steps").expect("a string takes every line");
        }
        let notes: String = self.notes.iter().map(|note| format!("; {note}")).collect();
        format!("{text}: about {:.0} s on {} thread(s){notes}", self.seconds, self.threads)
    }
}

/// What a plan will do and cost, for programs; keys are those of `summary.json` where it has them.
#[derive(Serialize)]
pub struct Checked {
    id: String,
    file: String,
    title: String,
    /// Every parameter that will be used.
    parameters: Value,
    shortened: f64,
    network: CheckedNetwork,
    claims: usize,
    /// What the figure will not show as asked.
    figure_without: Vec<String>,
    memory_bytes: u64,
    orbits: Orbits,
    cost: Cost,
    warnings: Vec<Warning>,
}

/// The network of a plan.
#[derive(Serialize)]
struct CheckedNetwork {
    links_hash: String,
    nodes: usize,
    links: usize,
    components: usize,
    isolated_nodes: usize,
    groups: usize,
}

impl Checked {
    /// Of a plan, after a short trial.
    pub fn of(plan: &Plan) -> Self {
        let msf = trial::of_msf(plan);
        let network = &plan.study.network;
        Self {
            id: plan.id.clone(),
            file: plan.file.to_string_lossy().into_owned(),
            title: plan.title.clone(),
            parameters: plan.parameters.clone(),
            shortened: plan.shortened,
            network: CheckedNetwork {
                links_hash: plan.links_hash.clone(),
                nodes: network.n_nodes(),
                links: network.n_links(),
                components: plan.study.n_components,
                isolated_nodes: network.isolated_nodes().len(),
                groups: network.groups().len(),
            },
            claims: plan.claims.len(),
            figure_without: drawing::foreseen(plan),
            memory_bytes: Memory::of(plan).bytes(),
            orbits: Orbits::of(plan, msf),
            cost: Cost::of(plan, msf),
            warnings: [doubts(plan), plan.doubts.clone()].concat(),
        }
    }
}
