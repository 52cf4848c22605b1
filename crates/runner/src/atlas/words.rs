//! An atlas in words: what it will do and cost, the classes of each system, the whole table.

use std::fmt::Write;

use comfy_table::Table;
use comfy_table::presets::{NOTHING, UTF8_BORDERS_ONLY};
use eigensync::Warning;
use eigensync::numbers::four_digits;
use experiment::{AtlasPlan, System};
use golden::Comparison;
use msf::MasterStability;
use serde::Serialize;
use serde_json::Value;
use user::text::{one_line, printable};

use super::found::Found;
use crate::overview::interval;
use crate::report::add_judged;
use crate::trial;

/// The class of every pair: a line for each system.
pub fn classes(plan: &AtlasPlan, curves: &[MasterStability]) -> String {
    let mut table = Table::new();
    table.load_style(NOTHING);
    let mut curves = curves.iter();
    for system in &plan.systems {
        let pairs = system.pairs.iter().zip(curves.by_ref());
        let classes = pairs
            .map(|(pair, curve)| format!("{}→{} {}", pair.from, pair.to, curve.stable.class()));
        table.add_row(std::iter::once(system.name.clone()).chain(classes));
    }
    table.to_string()
}

/// The report; times and memory stand in the summary alone, so that equal runs have equal reports.
pub fn report(found: &Found<'_>, warnings: &[Warning], comparison: Option<&Comparison>) -> String {
    let plan = found.plan;
    let mut text = format!("{}: {}\n\n", plan.id, one_line(&plan.title));
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY);
    table.set_header(["system", "coupling", "class", "stable for", "looked at up to", "at sigma"]);
    for (system, pair, curve) in found.each() {
        let windows: Vec<String> = curve.stable.intervals.iter().map(interval).collect();
        let last = curve.looked.to;
        table.add_row([
            system.name.clone(),
            format!("{} into {}", pair.from, pair.to),
            curve.stable.class().to_string(),
            if windows.is_empty() { "none".into() } else { windows.join(", ") },
            four_digits(last),
            curve.looked.points.to_string(),
        ]);
    }
    writeln!(text, "{table}").expect("a string takes every line");
    add_judged(&mut text, found.claims, None, warnings, comparison);
    printable(&text).into_owned()
}

/// The resolved plan and its cost.
pub fn describe(plan: &AtlasPlan) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        writeln!(text, "{name:<12} {}", one_line(&value)).expect("a string takes every line");
    };
    line("atlas", format!("{}: {}", plan.id, plan.title));
    for system in &plan.systems {
        let oscillator = serde_json::to_string(&system.pairs[0].node.oscillator);
        let (n, times) = (system.pairs.len(), system.times());
        let cost = format!("step {}, average {}", times.step, times.average);
        let oscillator = oscillator.unwrap_or_default();
        line("system", format!("{}: {oscillator}; {n} pairs, {cost}", system.name));
    }
    let times = plan.systems[0].times();
    line(
        "msf",
        format!(
            "{} values of sigma a pair, as far as a first look finds changes of stability; transient {}",
            plan.points, times.transient
        ),
    );
    line("claims", published(plan).to_string());
    line("cost", Cost::of(plan).words());
    text
}

/// What will be done, for programs.
#[derive(Serialize)]
pub struct Checked<'a> {
    id: &'a str,
    file: String,
    title: &'a str,
    parameters: &'a Value,
    shortened: f64,
    systems: Vec<&'a str>,
    pairs: usize,
    claims: usize,
    cost: Cost,
}

impl<'a> Checked<'a> {
    /// Of a plan, after a short trial of each system.
    pub fn of(plan: &'a AtlasPlan) -> Self {
        Self {
            id: &plan.id,
            file: plan.file.to_string_lossy().into_owned(),
            title: &plan.title,
            parameters: &plan.parameters,
            shortened: plan.shortened,
            systems: plan.systems.iter().map(|system| &system.name[..]).collect(),
            pairs: plan.pairs().count(),
            claims: published(plan),
            cost: Cost::of(plan),
        }
    }
}

fn published(plan: &AtlasPlan) -> usize {
    plan.pairs().filter(|(_, pair)| pair.published.is_some()).count()
}

/// Steps to be done, and the time they will take at the speed of short trials on this machine.
#[derive(Serialize)]
struct Cost {
    msf_tangent_steps: u64,
    seconds: f64,
    threads: usize,
    /// Systems whose orbits escape at once.
    escaping: Vec<String>,
}

impl Cost {
    fn of(plan: &AtlasPlan) -> Self {
        let threads = rayon::current_num_threads();
        let (mut seconds, mut escaping) = (0.0, Vec::new());
        for system in &plan.systems {
            let trial = trial_of(system, plan.points);
            seconds += trial.seconds;
            if trial.escaped {
                escaping.push(system.name.clone());
            }
        }
        let seconds = (seconds / threads as f64).ceil();
        Self { msf_tangent_steps: plan.steps(), seconds, threads, escaping }
    }

    fn words(&self) -> String {
        let Self { msf_tangent_steps: steps, seconds, threads, escaping } = self;
        let mut text = format!(
            "msf {:.1e} tangent steps: about {seconds:.0} s on {threads} thread(s)",
            *steps as f64
        );
        if !escaping.is_empty() {
            let names = escaping.join(", ");
            write!(text, "; orbits escape at once, and no time can be told, of {names}")
                .expect("a string takes every text");
        }
        text
    }
}

fn trial_of(system: &System, points: u32) -> trial::Trial {
    let steps = system.request(1.0, points).steps() * system.pairs.len() as u64;
    trial::of_curve(&system.pairs[0].node.equations, system.times(), steps)
}
