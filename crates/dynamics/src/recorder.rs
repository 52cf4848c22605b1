//! Hands out the records of a series while replicas run.

use crate::series::Samples;
use crate::{Observer, Record, Schedule, Series};

/// Hands out the records of some replicas, if anybody wants them.
pub(crate) struct Recorder {
    wanted: Option<Wanted>,
}

/// What is wanted of every replica, with room for one record.
struct Wanted {
    samples: Samples,
    /// Component and node of each number of a record.
    places: Vec<(usize, usize)>,
    states: Vec<f64>,
}

impl Recorder {
    pub(crate) fn new(series: Option<&Series>, schedule: &Schedule, n_components: usize) -> Self {
        let wanted = |series: &Series| {
            let components =
                series.components.clone().unwrap_or_else(|| (0..n_components).collect());
            let of = |&node: &usize| components.iter().map(move |&component| (component, node));
            let places: Vec<_> = series.nodes.iter().flat_map(of).collect();
            Wanted {
                samples: series.samples(schedule),
                states: Vec::with_capacity(places.len()),
                places,
            }
        };
        Self { wanted: series.map(wanted) }
    }

    /// Whether a record is wanted of a sample.
    #[inline(always)]
    pub(crate) fn due(&self, sample: u64) -> bool {
        self.wanted.as_ref().is_some_and(|wanted| wanted.samples.contains(sample))
    }

    /// Tells of one replica at a sample that is due, its state given by component and node.
    pub(crate) fn tell(
        &mut self,
        (replica, observer): (usize, &dyn Observer),
        (sample, time): (u64, f64),
        state: impl Fn(usize, usize) -> f64,
    ) {
        let Some(Wanted { samples, places, states }) = &mut self.wanted else { return };
        states.clear();
        states.extend(places.iter().map(|&(component, node)| state(component, node)));
        let number = (sample - samples.first) / samples.every;
        observer.recorded(replica, &Record { number, sample, time, states });
    }
}
