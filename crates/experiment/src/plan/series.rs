//! States of nodes on the way: of which nodes, at which couplings, and how many numbers that makes.

use std::cmp::Ordering;
use std::collections::HashSet;

use dynamics::{NodeDynamics, Replica, Series};
use eigensync::Sweep;
use eigensync::numbers::plain;
use graph::{Names, Network};
use user::Result;

use super::checker::Checker;
use crate::spec::SeriesSpec;

/// The most numbers that are written, 8 bytes each and some twenty more as text.
const MOST_NUMBERS: f64 = 2e9;

/// Of which replicas states are written, and what the numbers of one are.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// The replicas, in their order.
    pub replicas: Vec<Replica>,
    /// Names of the numbers of a state: `x_LABEL`.
    pub columns: Vec<String>,
    /// States of one replica that comes to its end.
    pub n_states: u64,
}

impl Recorded {
    /// Numbers of all replicas together, times among them.
    pub fn n_numbers(&self) -> f64 {
        let of_one = self.n_states as f64 * (1.0 + self.columns.len() as f64);
        self.replicas.len() as f64 * of_one
    }
}

impl Checker<'_> {
    /// What the simulation is asked for.
    pub(super) fn series(
        &self,
        spec: &SeriesSpec,
        network: &Network,
        dynamics: &dyn NodeDynamics,
    ) -> Result<Series> {
        let key = "sweep.series.nodes";
        let names = Names::of(network);
        let mut nodes = Vec::new();
        for name in &spec.nodes {
            let named = names.nodes(name.as_ref());
            nodes.extend(named.map_err(|error| self.misnamed(key, &error))?);
        }
        if nodes.is_empty() {
            return Err(self.problem(key, "is empty, but needs a node"));
        }
        let mut seen = HashSet::new();
        if let Some(&twice) = nodes.iter().find(|&&node| !seen.insert(node)) {
            let label = &network.labels()[twice];
            let message = format!("has node \"{label}\" twice, by its label or by its group");
            return Err(self.problem(key, message).hint("name each node once"));
        }
        for (key, count) in [("sweep.series.every", spec.every), ("sweep.series.seeds", spec.seeds)]
        {
            if count == 0 {
                return Err(self.problem(key, "is 0, but must be 1 or more"));
            }
        }
        let time = |key: &str, time: Option<f64>| {
            time.map(|time| self.not_negative(key, time).map(|()| time / self.shortened))
                .transpose()
        };
        Ok(Series {
            nodes,
            components: self.series_components(spec, dynamics)?,
            every: spec.every,
            from: time("sweep.series.from", spec.from)?,
            to: time("sweep.series.to", spec.to)?,
        })
    }

    fn series_components(
        &self,
        spec: &SeriesSpec,
        dynamics: &dyn NodeDynamics,
    ) -> Result<Option<Vec<usize>>> {
        let key = "sweep.series.components";
        let Some(names) = &spec.components else { return Ok(None) };
        if names.is_empty() {
            return Err(self.problem(key, "is empty").hint("leave it out for all components"));
        }
        let mut components = Vec::new();
        for name in names {
            let component = self.component(key, name, dynamics)?;
            if components.contains(&component) {
                return Err(self.problem(key, format!("has \"{name}\" more than once")));
            }
            components.push(component);
        }
        Ok(Some(components))
    }

    /// Of which replicas of the sweep states are written.
    pub(super) fn recorded(
        &self,
        sweep: &Sweep,
        network: &Network,
        dynamics: &dyn NodeDynamics,
    ) -> Result<Option<Recorded>> {
        let spec = self.experiment.sweep.as_ref().and_then(|sweep| sweep.series.as_ref());
        let (Some(spec), Some(series)) = (spec, &sweep.series) else { return Ok(None) };
        let epsilon = self.recorded_epsilon(spec, sweep)?;
        let seeds = usize::try_from(spec.seeds).unwrap_or(usize::MAX);
        if seeds > sweep.seeds.len() {
            let message = format!("is {seeds}, but the sweep has {} seeds", sweep.seeds.len());
            return Err(self.problem("sweep.series.seeds", message));
        }
        let of = |&epsilon: &f64| {
            sweep.seeds[..seeds].iter().map(move |&seed| Replica { epsilon, seed })
        };
        let n_states = series.n_records(&sweep.schedule);
        let samples = sweep.schedule.samples() as f64 * sweep.schedule.sampling_interval();
        let end = sweep.schedule.transient + samples;
        if let Some(to) = series.to.filter(|to| *to > end * (1.0 + 1e-9)) {
            let message = format!("is {}, but a run ends at {}", plain(to), plain(end));
            return Err(self.problem("sweep.series.to", message).hint("leave it out for the end"));
        }
        if n_states == 0 {
            return Err(self.no_states([sweep.schedule.transient, end]));
        }
        let recorded = Recorded {
            replicas: epsilon.iter().flat_map(of).collect(),
            columns: columns(series, network, dynamics),
            n_states,
        };
        if recorded.n_numbers() > MOST_NUMBERS {
            let message = format!(
                "asks for {} numbers: {} replicas of {n_states} states of {} numbers; the most is {}",
                plain(recorded.n_numbers()),
                recorded.replicas.len(),
                recorded.columns.len() + 1,
                plain(MOST_NUMBERS)
            );
            let hint = "take fewer `nodes`, `components`, points of `epsilon`, or every tenth state: \
                        `every = 10`";
            return Err(self.problem("sweep.series", message).hint(hint));
        }
        Ok(Some(recorded))
    }

    fn no_states(&self, times: [f64; 2]) -> user::Problem {
        let [transient, end] = times.map(plain);
        let message = format!(
            "asks for no state: `from`, which is {transient} where it is left out, comes after `to` or \
             after the end of a run at {end}"
        );
        self.problem("sweep.series", message)
            .hint("leave out `from` and `to` for all averaged states")
    }

    fn recorded_epsilon(&self, spec: &SeriesSpec, sweep: &Sweep) -> Result<Vec<f64>> {
        let key = "sweep.series.epsilon";
        let Some(asked) = &spec.epsilon else { return Ok(sweep.epsilon.clone()) };
        if asked.is_empty() {
            return Err(self.problem(key, "is empty").hint("leave it out for all points"));
        }
        let mut asked = asked.clone();
        asked.sort_by(f64::total_cmp);
        if let Some(pair) = asked.windows(2).find(|pair| pair[0] == pair[1]) {
            let message = format!("contains {} more than once", plain(pair[0]));
            return Err(self.problem(key, message));
        }
        let points = &sweep.epsilon;
        let point = |epsilon: &f64| {
            let found =
                points.binary_search_by(|p| p.partial_cmp(epsilon).unwrap_or(Ordering::Less));
            found.map(|at| points[at]).map_err(|_| self.no_point(key, *epsilon, sweep))
        };
        asked.iter().map(point).collect()
    }

    fn no_point(&self, key: &str, epsilon: f64, sweep: &Sweep) -> user::Problem {
        let message = format!("has {}, which is not a point of `sweep.epsilon`", plain(epsilon));
        let problem = self.problem(key, message);
        match sweep.nearest(epsilon) {
            Some(nearest) => problem.hint(format!("the nearest point is {}", plain(nearest))),
            None => problem,
        }
    }
}

/// Names of the numbers of a state: node by node, component by component.
fn columns(series: &Series, network: &Network, dynamics: &dyn NodeDynamics) -> Vec<String> {
    let all = dynamics.components();
    let components = match &series.components {
        Some(components) => components.iter().map(|&component| all[component]).collect(),
        None => all.to_vec(),
    };
    let of = |&node: &usize| {
        let label = &network.labels()[node];
        components.iter().map(move |component| format!("{component}_{label}"))
    };
    series.nodes.iter().flat_map(of).collect()
}
