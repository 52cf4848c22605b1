//! A prediction in words: the network, its leading modes, the stable set, the cascade of states, which
//! of their clusters are exact, where these were seen in simulation, and what it all took.

mod exactness;
mod onsets;
mod words;

use dynamics::{Method, StepChoice};
use eigensync::Findings;
use eigensync::numbers::{four_digits, plain, six_digits, two_digits, with_error};
use std::fmt::Write;

use clustering::{ClusterKind, State, StateLabels};
use comfy_table::Table;
use comfy_table::presets::NOTHING;
use dynamics::Closes;
use msf::{End, Interval, Isolated, Looked, MasterStability};
use spectra::Verification;

use crate::provenance::peak_memory;
use experiment::Plan;
use figures::grouped;
use user::Stages;
use words::{SHOWN, abridged};

/// Sizes shown of the clusters of one state.
const SIZES: usize = 5;

/// The prediction of a plan, beside what its sweep shows of it, without what it took.
pub fn of(plan: &Plan, findings: &Findings) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        writeln!(text, "{name:<12} {value}").expect("a string takes every line");
    };
    line("network", network(plan));
    line("modes", modes(findings));
    line("lambda", lambda(findings));
    line("isolated", isolated(&findings.msf));
    line("stable for", stable(&findings.msf));
    if let Some(chosen) = &plan.chosen {
        let (method, step) = (method_name(chosen.method), step_in_words(chosen.step));
        line("step", format!("{method} at {step}, {}", error_of(chosen)));
    }
    line("verdict", findings.synchrony.verdict.clone());
    line("", String::new());
    text.push_str(&cascade(plan, findings));
    text.push_str(&exactness::of(plan, findings));
    if let Some(onsets) = onsets::of(plan, findings) {
        text.push('\n');
        text.push_str(&onsets);
    }
    text
}

/// That a method and its step were chosen, and what a step errs by.
pub fn error_of(chosen: &StepChoice) -> String {
    let error = two_digits(chosen.error);
    format!("chosen: a step errs by {error} of the attractor per unit of time")
}

/// The integrator by the name that experiment files call it.
pub fn method_name(method: Method) -> String {
    serde_json::to_value(experiment::method(method))
        .ok()
        .and_then(|name| name.as_str().map(ToOwned::to_owned))
        .unwrap_or_default()
}

/// As a fraction where it is one.
fn step_in_words(step: f64) -> String {
    let parts = (1.0 / step).round();
    if step < 1.0 && 1.0 / parts == step { format!("1/{parts}") } else { plain(step) }
}

fn network(plan: &Plan) -> String {
    let network = &plan.study.network;
    let parts = match plan.study.n_components {
        1 => "connected".into(),
        parts => format!("{} components", grouped(parts)),
    };
    format!("{} nodes, {} links, {parts}", grouped(network.n_nodes()), grouped(network.n_links()))
}

fn modes(findings: &Findings) -> String {
    let spectrum = &findings.spectrum;
    let residual = spectrum.largest_residual();
    let multiple = spectrum.eigenspaces.iter().filter(|space| space.multiplicity() > 1).count();
    let verified = match spectrum.verification {
        Verification::Dense => "all of them were computed".to_owned(),
        Verification::Inertia { .. } => {
            "none missing, by the inertia of a factorisation".to_owned()
        }
        Verification::Probed { confidence, .. } => {
            format!(
                "none missing, unless with a probability below {}",
                two_digits(1.0 - confidence)
            )
        }
    };
    let mut text = format!(
        "{} computed, residuals up to {}; {verified}",
        spectrum.n_modes(),
        two_digits(residual)
    );
    if multiple > 0 {
        write!(text, ", {multiple} multiple eigenvalues").expect("a string takes every text");
    }
    text
}

fn lambda(findings: &Findings) -> String {
    let values = findings.spectrum.real_eigenvalues();
    abridged(values.into_iter().skip(1).map(four_digits))
}

/// Λ(0) and what it says.
pub fn isolated(msf: &MasterStability) -> String {
    let isolated = msf.isolated;
    let says = match msf.state {
        Isolated::Chaotic => "chaotic".to_owned(),
        Isolated::Periodic => "periodic, 0 within its errors".to_owned(),
        Isolated::AtRest => match msf.rests.len() {
            0 | 1 => "at rest, nodes become equal without coupling".to_owned(),
            several => format!(
                "at rest in {several} different states, nodes in the same one become equal without \
                 coupling"
            ),
        },
    };
    match msf.closes {
        Some(closes) => format!("Λ(0) = {}: {}", four_digits(isolated.mean), closed(closes, &says)),
        None => format!("Λ(0) = {}: {says}", with_error(isolated.mean, isolated.standard_error)),
    }
}

/// What an orbit that closes is, and where Λ on it comes from.
fn closed(closes: Closes, at_rest: &str) -> String {
    match closes {
        Closes::AtOnce => format!("{at_rest}; Λ from the eigenvalues there"),
        Closes::AfterPeriod { period } => {
            format!("a limit cycle of period {}; Λ from Floquet multipliers", six_digits(period))
        }
        Closes::AfterIterations { n: 1 } => format!("{at_rest}; Λ from the eigenvalues there"),
        Closes::AfterIterations { n } => {
            format!("a cycle of period {n}; Λ from its multipliers")
        }
    }
}

/// The stable set, and what was looked at.
pub fn stable(MasterStability { stable, looked, .. }: &MasterStability) -> String {
    let looked = looked_at(looked);
    if stable.intervals.is_empty() {
        return format!("none of {looked}: nothing is predicted to synchronise");
    }
    let looked = format!("looked at {looked}");
    let intervals: Vec<String> = stable.intervals.iter().map(interval).collect();
    let beyond = if stable.is_unbounded() { ", and taken to be stable beyond" } else { "" };
    format!("{} ({looked}{beyond})", intervals.join(", "))
}

/// How far and how finely was looked, and how narrow a window could have been missed.
pub fn looked_at(Looked { from, to, points, widest_gap, .. }: &Looked) -> String {
    let [from, to] = [*from, *to].map(four_digits);
    format!(
        "{points} sigma from {from} to {to}, where a window narrower than {} % of its sigma could be missed",
        two_digits(100.0 * widest_gap)
    )
}

/// A window of stable σ.
pub fn interval(Interval { from, to }: &Interval) -> String {
    match to {
        End::Looked { .. } => format!("sigma > {}", end(from)),
        _ => format!("{} < sigma < {}", end(from), end(to)),
    }
}

fn end(end: &End) -> String {
    match end {
        End::Zero(zero) if zero.refined => with_error(zero.sigma, zero.standard_error),
        End::Zero(zero) => {
            format!("{} (not as good as asked)", with_error(zero.sigma, zero.standard_error))
        }
        End::Origin { .. } => "0".into(),
        End::Looked { sigma } => format!("{} (the end of the look)", four_digits(*sigma)),
    }
}

fn cascade(plan: &Plan, findings: &Findings) -> String {
    let mut table = Table::new();
    table.load_style(NOTHING);
    table.set_header([
        "epsilon",
        "unstable modes",
        "clusters",
        "exact",
        "their sizes",
        "nodes alone",
    ]);
    for (state, labels) in findings.cascade.iter().zip(&findings.labels).take(SHOWN) {
        table.add_row(row(state, labels));
    }
    let mut text = format!("{table}\n");
    if findings.cascade.len() > SHOWN {
        let more = findings.cascade.len() - SHOWN;
        writeln!(text, "… and {more} more states").expect("a string takes every line");
    }
    if let Some(last) = findings.cascade.last().filter(|state| state.truncated) {
        let computed = findings.spectrum.n_modes();
        let n_nodes = plan.study.network.n_nodes();
        let why = match findings.spectrum.cutoff {
            _ if computed == n_nodes => {
                "below which a mode comes to a sigma that was not looked at".to_owned()
            }
            Some(_) => {
                format!("down to which unstable modes of {} were asked for", grouped(n_nodes))
            }
            None => format!(
                "where mode {computed} of {} becomes unstable, the last one computed",
                grouped(n_nodes)
            ),
        };
        writeln!(text, "The states end at epsilon = {}, {why}.", four_digits(last.epsilon.0))
            .expect("a string takes every line");
    }
    text
}

/// Seconds by stage, and memory where the system tells it.
pub fn cost(stages: &Stages) -> String {
    let stages = stages.took().into_iter();
    let stages = stages.map(|(name, time)| format!("{name} {:.1} s", time.as_secs_f64()));
    let mut text = stages.collect::<Vec<_>>().join(", ");
    if let Some(bytes) = peak_memory() {
        write!(text, "; at most {:.2} GB of memory", bytes as f64 / 1e9)
            .expect("a string takes every text");
    }
    text
}

fn row(state: &State, labels: &StateLabels) -> [String; 6] {
    let (from, to) = state.epsilon;
    let epsilon = match to {
        Some(to) => format!("{} to {}", four_digits(to), four_digits(from)),
        None => format!("above {}", four_digits(from)),
    };
    let mut sizes = vec![0usize; state.clusters.n_clusters()];
    state.clusters.cluster_of().iter().for_each(|&cluster| sizes[cluster] += 1);
    let alone = sizes.iter().filter(|&&size| size == 1).count();
    sizes.retain(|&size| size > 1);
    sizes.sort_unstable_by(|a, b| b.cmp(a));
    let mut largest: Vec<String> = sizes.iter().take(SIZES).map(|&size| grouped(size)).collect();
    if sizes.len() > SIZES {
        largest.push("…".into());
    }
    [
        epsilon,
        match state.n_unstable {
            (least, most) if least == most => grouped(least),
            (least, most) => format!("{} to {}", grouped(least), grouped(most)),
        },
        grouped(sizes.len()),
        grouped(labels.count(ClusterKind::Exact)),
        largest.join(" + "),
        grouped(alone),
    ]
}
