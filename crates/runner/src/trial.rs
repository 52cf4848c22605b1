//! Short trials of the kernels that a run will use, to tell how long it will take: the master
//! stability function, the steps of the network, and the sampling of its errors, each by itself. They
//! take about a second together, two for a million nodes, since what grows is clipped and scaled.

use eigensync::Sweep;
use std::time::Instant;

use dynamics::lyapunov::{Tangent, Times, master_exponents};
use dynamics::{DynamicsError, Method, Observables, Outcome, Replica, Schedule, Simulation};

use experiment::Plan;

/// Node steps of a trial; a large network takes the twenty samples that there are at least.
const NODE_STEPS: f64 = 2e6;
const SAMPLES: [f64; 2] = [20.0, 1000.0];
/// Differences of the trial of clusters, of which each sample has one for every pair.
const DIFFERENCES: f64 = 2e7;
/// Lanes of a full batch.
const LANES: usize = 16;
/// Most steps of a tangent vector in the trial of the master stability function.
const TANGENT_STEPS: f64 = 2e4;
/// How often what errors cost is tried: where other programs are at work, the steps without errors may
/// come out slower than those with them.
const TRIES: usize = 5;
/// Longest time from sample to sample in a trial of an adaptive method, which takes as many steps in
/// between as it needs.
const ADAPTIVE_INTERVAL: f64 = 0.01;

/// What a trial tells.
#[derive(Clone, Copy)]
pub struct Trial {
    /// On one thread.
    pub seconds: f64,
    /// Whether an orbit escaped, or could not be integrated, even in so short a time.
    pub escaped: bool,
}

/// Seconds of Λ(0) by itself, on one thread, of those of the whole function.
pub fn of_isolated(plan: &Plan, msf: Trial) -> f64 {
    let orbits = msf::ISOLATED_ORBITS as f64 / plan.study.msf_steps() as f64;
    msf.seconds * orbits * plan.study.msf.times.steps() as f64
}

/// Of all tangent vectors that the master stability function takes.
pub fn of_msf(plan: &Plan) -> Trial {
    let study = &plan.study;
    of_curve(&study.node, &study.msf.times, plan.study.msf_steps())
}

/// Of so many steps of tangent vectors.
pub fn of_curve(node: &msf::Node, planned: &Times, steps: u64) -> Trial {
    // Twenty blocks of one interval each, shorter where steps are very many.
    let renormalise = planned.renormalise.min(TANGENT_STEPS / 20.0 * planned.step);
    let times = Times { transient: 0.0, average: 20.0 * renormalise, renormalise, ..*planned };
    let tangents: Vec<_> = (0..16).map(|seed| Tangent { sigma: 1.0, seed }).collect();
    let msf::Node { dynamics, coupling } = node;
    let (seconds, exponents) =
        timed(|| master_exponents(dynamics.as_ref(), coupling, &times, &tangents, dynamics::QUIET));
    let per_step = seconds / (16.0 * times.steps() as f64);
    Trial {
        seconds: per_step * steps as f64,
        escaped: matches!(exponents, Err(DynamicsError::Escaped { .. })),
    }
}

/// Of all replicas of a sweep.
pub fn of_sweep(plan: &Plan, sweep: &Sweep) -> Trial {
    let bench = Bench::new(plan, sweep);
    let bare = bench.run(Observables::default());
    let observed = &sweep.observables;
    let more = |observables: Observables| {
        let more = |_| {
            let bare = bench.run(Observables::default()).seconds;
            bench.run(observables.clone()).seconds - bare
        };
        (0..TRIES).map(more).find(|more| *more > 0.0).unwrap_or(0.0)
    };
    let of_nodes = match observed.pairs || observed.reference.is_some() {
        true => more(Observables { clusters: Vec::new(), ..observed.clone() }),
        false => 0.0,
    };
    let clusters = clipped(&observed.clusters, DIFFERENCES / bench.samples / bench.lanes());
    let share = differences(&observed.clusters) / differences(&clusters).max(1.0);
    let of_clusters = match clusters.is_empty() {
        true => 0.0,
        false => share * more(Observables { clusters, ..Observables::default() }),
    };
    let per_step = bare.seconds * bench.in_real_steps;
    let per_sample = (of_nodes + of_clusters) / f64::from(sweep.schedule.stride);
    let steps_of_trial = bench.samples * bench.lanes();
    let seconds = (per_step + per_sample) / steps_of_trial * sweep.steps() as f64;
    Trial { seconds, escaped: bare.escaped }
}

/// One short schedule for some replicas, run with one set of observables after another.
struct Bench<'a> {
    plan: &'a Plan,
    sweep: &'a Sweep,
    replicas: Vec<Replica>,
    schedule: Schedule,
    samples: f64,
    /// Steps of the sweep in the time of one step of the trial.
    in_real_steps: f64,
}

impl<'a> Bench<'a> {
    fn new(plan: &'a Plan, sweep: &'a Sweep) -> Self {
        let n_nodes = plan.study.network.n_nodes() as f64;
        let replicas = spread(sweep, n_nodes);
        let samples = NODE_STEPS / n_nodes / replicas.len() as f64;
        let samples = samples.clamp(SAMPLES[0], SAMPLES[1]).round();
        let planned = sweep.schedule.step;
        let (step, samples) = match sweep.method {
            Method::Rk4 | Method::Dop853 | Method::Iterate => (planned, samples),
            Method::Adaptive(_) => (planned.min(ADAPTIVE_INTERVAL), SAMPLES[0]),
        };
        // A hair more than so many samples, which rounding would else make one less.
        let average = samples * step * (1.0 + 1e-9);
        let schedule = Schedule { step, transient: 0.0, average, stride: 1 };
        Self { plan, sweep, replicas, schedule, samples, in_real_steps: planned / step }
    }

    fn lanes(&self) -> f64 {
        self.replicas.len() as f64
    }

    fn run(&self, observables: Observables) -> Trial {
        let simulation = Simulation {
            dynamics: self.plan.study.node.dynamics.clone(),
            coupling: self.plan.study.node.coupling.clone(),
            matrix: self.plan.study.matrix.matrix(),
            method: self.sweep.method,
            schedule: self.schedule,
            observables,
            series: None,
            kick: self.sweep.kick,
            instruction_set: self.plan.study.msf.instruction_set,
        };
        let replicas = &self.replicas;
        let (seconds, runs) = timed(|| simulation.run(replicas, dynamics::QUIET));
        let completed = |outcome: &Outcome| matches!(outcome, Outcome::Completed(_));
        let escaped = runs.map_or(true, |runs| runs.iter().any(|run| !completed(&run.outcome)));
        Trial { seconds, escaped }
    }
}

/// As many replicas as one thread will have side by side, fewer of large networks, from the smallest
/// coupling to the largest.
fn spread(sweep: &Sweep, n_nodes: f64) -> Vec<Replica> {
    let all = sweep.replicas();
    let on_a_thread = all.len().div_ceil(rayon::current_num_threads());
    let affordable = (NODE_STEPS / SAMPLES[0] / n_nodes) as usize;
    let n = on_a_thread.min(LANES).min(affordable.max(1));
    (0..n).map(|k| all[(k + 1) * all.len() / n - 1]).collect()
}

/// Clusters, or parts of them, with so many pairs.
fn clipped(clusters: &[Vec<usize>], most_pairs: f64) -> Vec<Vec<usize>> {
    let mut left = most_pairs;
    let mut kept = Vec::new();
    for cluster in clusters {
        let size = ((2.0 * left).sqrt() as usize).clamp(2, cluster.len().max(2));
        kept.push(cluster[..size.min(cluster.len())].to_vec());
        left -= differences(&kept[kept.len() - 1..]);
        if left <= 0.0 {
            break;
        }
    }
    kept
}

/// Pairs within clusters.
fn differences(clusters: &[Vec<usize>]) -> f64 {
    let pairs = |cluster: &Vec<usize>| 0.5 * cluster.len() as f64 * (cluster.len() as f64 - 1.0);
    clusters.iter().map(pairs).sum()
}

/// What some work gives on one thread, and the seconds that it takes.
fn timed<T: Send>(work: impl FnOnce() -> T + Send) -> (f64, T) {
    let started = Instant::now();
    let result = match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(work),
        // Without a pool of its own the trial runs on the common one and comes out too fast.
        Err(_) => work(),
    };
    (started.elapsed().as_secs_f64(), result)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clusters_are_clipped_to_a_number_of_pairs() {
        let large: Vec<usize> = (0..1_000_000).collect();
        let kept = clipped(&[large.clone(), large], 5000.0);
        assert_eq!(kept.len(), 2);
        assert!((differences(&kept) - 5000.0).abs() < 200.0, "{}", differences(&kept));
        let small = [vec![0, 1], vec![2, 3, 4]];
        assert_eq!(clipped(&small, 1e6), small);
    }
}
