//! Time series on request: the states of chosen nodes at every k-th sample, handed out as they come.
//!
//! Record n of a replica is its state at sample s_0 + n k, as it enters the errors: before the kick, if
//! one is due. Nothing is kept of it, so that memory does not grow with the time that is simulated.

use serde::{Deserialize, Serialize};

use crate::error::whole;
use crate::{DynamicsError, Schedule};

/// Which states a simulation hands out to its [`crate::Observer`]. Times are model time, rounded to the
/// nearest sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Nodes (from 0), in the order in which they are wanted.
    pub nodes: Vec<usize>,
    /// Components (from 0), in this order; all of them where none are named.
    pub components: Option<Vec<usize>>,
    /// k, samples from one record to the next.
    pub every: u64,
    /// Time of the first record, 0 for the initial state; where none is given, the end of the
    /// transient, from which errors are averaged.
    pub from: Option<f64>,
    /// No record is later; where none is given, they go on to the end.
    pub to: Option<f64>,
}

/// The states of the chosen nodes of one replica at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record<'a> {
    /// Its place in the series of the replica, from 0, wherever the replica went on from.
    pub number: u64,
    /// Samples done, those of the transient among them.
    pub sample: u64,
    /// Model time.
    pub time: f64,
    /// `[node][component]`, both in the order of the [`Series`].
    pub states: &'a [f64],
}

impl Series {
    /// All components of some nodes at every sample of the averaging time.
    pub fn of(nodes: Vec<usize>) -> Self {
        Self { nodes, components: None, every: 1, from: None, to: None }
    }

    /// Records of one replica, from its beginning to its end.
    pub fn n_records(&self, schedule: &Schedule) -> u64 {
        self.n_records_by(schedule, u64::MAX)
    }

    /// Records of one replica up to a sample and at it: what a replica that goes on from a
    /// [`crate::Snapshot`] of this sample has told already.
    pub fn n_records_by(&self, schedule: &Schedule, sample: u64) -> u64 {
        let Samples { first, last, every } = self.samples(schedule);
        let last = sample.min(last);
        if every == 0 || last < first { 0 } else { (last - first) / every + 1 }
    }

    /// Refuses nodes, components and times that are not there.
    pub(crate) fn check(
        &self,
        schedule: &Schedule,
        (n_nodes, n_components): (usize, usize),
    ) -> Result<(), DynamicsError> {
        if let Some(&node) = self.nodes.iter().find(|&&node| node >= n_nodes) {
            return Err(DynamicsError::NoSuchNode { node, n_nodes });
        }
        let mut components = self.components.iter().flatten();
        if let Some(&component) = components.find(|&&component| component >= n_components) {
            return Err(DynamicsError::NoSuchComponent { component, n_components });
        }
        let times = [("start of the series", self.from), ("end of the series", self.to)];
        for (name, value) in times.into_iter().filter_map(|(name, time)| Some((name, time?))) {
            if !(value.is_finite() && value >= 0.0) {
                return Err(DynamicsError::BadTime { name, value });
            }
        }
        if self.n_records(schedule) == 0 {
            let Samples { first, last, every } = self.samples(schedule);
            let [from, to] = [first, last].map(|sample| schedule.time_of(sample));
            return Err(DynamicsError::EmptySeries { every, from, to });
        }
        Ok(())
    }

    pub(crate) fn samples(&self, schedule: &Schedule) -> Samples {
        let sample = |time: f64| whole(time / schedule.sampling_interval());
        let end = schedule.transient_samples() + schedule.samples();
        Samples {
            first: self.from.map_or(schedule.transient_samples(), sample),
            last: self.to.map_or(end, sample).min(end),
            every: self.every,
        }
    }
}

/// The samples of a series: every so many, from the first to the last at the most.
#[derive(Clone, Copy)]
pub(crate) struct Samples {
    pub(crate) first: u64,
    last: u64,
    pub(crate) every: u64,
}

impl Samples {
    pub(crate) fn contains(self, sample: u64) -> bool {
        (self.first..=self.last).contains(&sample)
            && (sample - self.first).is_multiple_of(self.every)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recorder::Recorder;

    /// Samples at 0.5, 1, …: 20 of transient, 40 of average.
    const SCHEDULE: Schedule = Schedule { step: 0.1, transient: 10.0, average: 20.0, stride: 5 };

    fn due(series: &Series) -> Vec<u64> {
        let recorder = Recorder::new(Some(series), &SCHEDULE, 3);
        (0..200).filter(|&sample| recorder.due(sample)).collect()
    }

    #[test]
    fn records_are_counted_as_they_are_told() {
        for (every, from, to) in [
            (1, None, None),
            (7, None, None),
            (3, Some(0.0), None),
            (4, Some(1.0), Some(6.2)),
            (60, Some(0.0), Some(1e300)),
            (1, Some(30.0), None),
            (5, Some(4.0), Some(3.0)),
        ] {
            let series = Series { every, from, to, ..Series::of(vec![0]) };
            let due = due(&series);
            assert_eq!(series.n_records(&SCHEDULE), due.len() as u64, "{series:?}");
            for sample in 0..80 {
                let told = due.iter().filter(|&&due| due <= sample).count() as u64;
                assert_eq!(series.n_records_by(&SCHEDULE, sample), told, "{series:?} by {sample}");
            }
        }
    }

    #[test]
    fn a_series_begins_where_the_transient_ends_and_ends_with_the_run_unless_told_otherwise() {
        let series = |every| Series { every, ..Series::of(vec![0]) };
        assert_eq!(due(&series(20)), [20, 40, 60]);
        assert_eq!(due(&Series { from: Some(0.0), to: Some(10.1), ..series(10) }), [0, 10, 20]);
    }

    #[test]
    fn series_that_cannot_be_had_are_refused() {
        let refused = |series: Series| series.check(&SCHEDULE, (5, 3)).unwrap_err();
        let one = || Series::of(vec![1]);
        let node = refused(Series::of(vec![0, 5]));
        assert_eq!(node, DynamicsError::NoSuchNode { node: 5, n_nodes: 5 });
        let component = refused(Series { components: Some(vec![3]), ..one() });
        assert_eq!(component, DynamicsError::NoSuchComponent { component: 3, n_components: 3 });
        let before = refused(Series { from: Some(-1.0), ..one() });
        assert_eq!(before, DynamicsError::BadTime { name: "start of the series", value: -1.0 });
        let (name, value) = ("end of the series", f64::INFINITY);
        let never = refused(Series { to: Some(value), ..one() });
        assert_eq!(never, DynamicsError::BadTime { name, value });
        let empty = |every, from, to| DynamicsError::EmptySeries { every, from, to };
        assert_eq!(refused(Series { every: 0, ..one() }), empty(0, 10.0, 30.0));
        assert_eq!(refused(Series { to: Some(9.0), ..one() }), empty(1, 10.0, 9.0));
        assert_eq!(refused(Series { from: Some(31.0), ..one() }), empty(1, 31.0, 30.0));
    }
}
