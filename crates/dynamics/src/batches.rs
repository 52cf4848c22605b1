//! Replicas cut into batches of lanes, and a batch run from its initial states to its end.

use std::cmp::Reverse;

use crate::instruction_set::Work;
use crate::integrators::fixed::Fixed;
use crate::kernel::Network;
use crate::kicks::Kicks;
use crate::links::Links;
use crate::observables::ErrorSums;
use crate::recorder::Recorder;
use crate::team::Seat;
use crate::tile::TILE;
use crate::{Next, Observables, Observer, Outcome, Simulation, Snapshot, Start};

/// Numbers of lanes, and what a step of so many costs beside that of a single one: measured on
/// networks of 90 and 989 nodes with AVX-512, and rounded.
const COSTS: [(usize, f64); 5] = [(1, 1.0), (2, 1.1), (4, 1.6), (8, 2.25), (TILE, 3.8)];

/// Nanoseconds that it takes threads which advance a network together to meet at an evaluation, and for
/// each number that they hand one another: measured on two cores, and rounded up.
const MEETING: (f64, f64) = (2000.0, 1.0);

/// How large a network is.
#[derive(Clone, Copy)]
pub(crate) struct Size {
    /// Nanoseconds that an evaluation of a single replica takes, see [`Links::work`].
    pub(crate) work: f64,
    pub(crate) n_nodes: usize,
}

/// How replicas are run: some teams at once, each of so many threads, and the batches that they take.
pub(crate) struct Cut {
    pub(crate) n_teams: usize,
    pub(crate) n_seats: usize,
    pub(crate) batches: Vec<Vec<Numbered>>,
}

/// The batches of all replicas, the furthest first. Those of one batch go on from the same sample,
/// fresh ones from none.
pub(crate) fn of(mut starts: Vec<Numbered>, n_threads: usize, size: Size) -> Cut {
    starts.sort_by_key(|start| Reverse(start.1.sample()));
    let same = starts.chunk_by(|a, b| a.1.sample() == b.1.sample());
    let numbers: Vec<usize> = same.map(<[Numbered]>::len).collect();
    let (n_seats, sizes) = cut(&numbers, n_threads, size);
    let mut left = starts.into_iter();
    let batches = sizes.into_iter().map(|size| left.by_ref().take(size).collect()).collect();
    Cut { n_teams: n_threads / n_seats, n_seats, batches }
}

/// Threads of a team, and sizes of the batches, such that the slowest team ends earliest: every team gets an
/// equal share of those numbers of replicas that may share a batch, cut as costs least.
fn cut(numbers: &[usize], n_threads: usize, size: Size) -> (usize, Vec<usize>) {
    let with = |n_seats: usize| {
        let teams = Teams { n: n_threads / n_seats, n_seats, size };
        let cuts: Vec<(f64, Vec<usize>)> = numbers.iter().map(|&n| teams.cut(n)).collect();
        let time: f64 = cuts.iter().map(|cut| cut.0).sum();
        (time, n_seats, cuts.into_iter().flat_map(|cut| cut.1).collect())
    };
    let all = (1..=n_threads).map(with);
    let (_, n_seats, sizes) = all.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there is a thread");
    (n_seats, sizes)
}

/// Some teams with as many threads each.
struct Teams {
    n: usize,
    n_seats: usize,
    size: Size,
}

impl Teams {
    /// How long the slowest takes for its share of some replicas, and the sizes of all batches.
    fn cut(&self, n_replicas: usize) -> (f64, Vec<usize>) {
        let share = |team: usize| (n_replicas + team) / self.n;
        let cuts = (0..self.n).rev().map(|team| self.cheapest(share(team)));
        let all: Vec<(f64, Vec<usize>)> = cuts.collect();
        let slowest = all.iter().map(|cut| cut.0).fold(0.0, f64::max);
        (slowest, all.into_iter().flat_map(|cut| cut.1).collect())
    }

    /// Nanoseconds for an evaluation of a batch with so many lanes.
    fn time(&self, (lanes, cost): (usize, f64)) -> f64 {
        let Size { work, n_nodes } = self.size;
        let meeting = match self.n_seats {
            1 => 0.0,
            _ => MEETING.0 + MEETING.1 * (n_nodes * lanes) as f64,
        };
        cost * work / self.n_seats as f64 + meeting
    }

    /// How long one team takes for some replicas, and the sizes of its batches, large ones first.
    fn cheapest(&self, n_replicas: usize) -> (f64, Vec<usize>) {
        // Of each number of replicas: the least time, and the batch with which its cut begins.
        let mut best = vec![(0.0, 0)];
        for n in 1..=n_replicas {
            let cut = |&(lanes, cost): &(usize, f64)| {
                let batch = lanes.min(n);
                (self.time((lanes, cost)) + best[n - batch].0, batch)
            };
            let cheaper = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0);
            best.push(COSTS.iter().map(cut).min_by(cheaper).expect("there are costs"));
        }
        let next = |&left: &usize| Some(left - best[left].1);
        let left = std::iter::successors(Some(n_replicas), next).take_while(|&left| left > 0);
        let mut sizes: Vec<usize> = left.map(|left| best[left].1).collect();
        sizes.sort_unstable_by(|a, b| b.cmp(a));
        (best[n_replicas].0, sizes)
    }
}

/// A replica to run, with its place in the list that was asked for.
pub(crate) type Numbered = (usize, Start);

/// Replicas advanced side by side in `L` lanes, their rows summed `R` side by side.
pub(crate) struct Batch<'a, const L: usize, const R: usize> {
    pub(crate) simulation: &'a Simulation<'a>,
    pub(crate) method: Fixed,
    pub(crate) links: &'a Links,
    /// At most `L`, all after the same sample.
    pub(crate) starts: Vec<Numbered>,
    pub(crate) observer: &'a dyn Observer,
    /// Of the thread that runs this, one of those that advance these replicas together. Each goes
    /// through all, for its own nodes; the leading one alone knows all states, and tells of them.
    pub(crate) seat: Seat<'a>,
}

impl<const L: usize, const R: usize> Work for Batch<'_, L, R> {
    /// None when the observer wanted to stop, and for a thread that does not lead.
    type Output = Option<Vec<(usize, Outcome)>>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self { simulation, method, links, starts, observer, seat } = self;
        let Simulation { dynamics, coupling, schedule, observables, kick, .. } = simulation;
        // Lanes beyond the batch repeat its last replica and are never read.
        let in_lanes = std::array::from_fn(|lane| starts[lane.min(starts.len() - 1)].1.replica);
        let equations = (dynamics.as_ref(), coupling);
        let n_components = dynamics.start().len();
        let leads = seat.leads();
        let nothing = Observables::default();
        let (observed, series) =
            if leads { (observables, simulation.series.as_ref()) } else { (&nothing, None) };
        let compiled = (method, simulation.instruction_set);
        let mut lanes = InLanes::<L, R> {
            network: Network::new(equations, compiled, links, in_lanes, seat),
            sums: ErrorSums::new(observed, links.n_nodes(), schedule.samples_per_block()),
            kicks: Kicks::new(*kick, schedule.sampling_interval(), in_lanes),
            recorder: Recorder::new(series, schedule, n_components),
        };
        let numbers: Vec<usize> = starts.iter().map(|start| start.0).collect();
        let transient = schedule.transient_samples();
        let (done, end) = (starts[0].1.sample(), transient + schedule.samples());
        if done > 0 {
            let shape = (links.n_nodes(), dynamics.n_free());
            lanes.restore(starts, (done, transient), shape);
        }
        let mut outcomes: [Option<Outcome>; L] = std::array::from_fn(|_| None);
        if done == 0 && lanes.recorder.due(0) {
            lanes.record((0, 0.0), going(&numbers, &outcomes), observer);
        }
        for sample in done + 1..=end {
            if !lanes.network.advance(schedule.stride, schedule.step) {
                return None;
            }
            if leads {
                for (lane, bounded) in lanes.network.bounded().into_iter().enumerate() {
                    if outcomes[lane].is_none() && !bounded {
                        let outcome = Outcome::Escaped { time: schedule.time_of(sample) };
                        finish(&mut outcomes, lane, outcome, &numbers, observer);
                    }
                }
                if outcomes.iter().all(Option::is_some) {
                    break;
                }
                if sample > transient {
                    lanes.sums.sample(lanes.network.component(observables.component));
                }
                if lanes.recorder.due(sample) {
                    let at = (sample, schedule.time_of(sample));
                    lanes.record(at, going(&numbers, &outcomes), observer);
                }
            }
            if lanes.kicks.due(sample) {
                let InLanes { network, kicks, .. } = &mut lanes;
                network.change_components(dynamics.n_free(), |_, _, lanes| kicks.apply(lanes));
            }
            if !leads {
                continue;
            }
            let steps = u64::from(schedule.stride) * numbers.len() as u64;
            match observer.advanced(&numbers, steps) {
                Next::GoOn => {}
                Next::Snapshot if sample < end => {
                    for (number, lane) in going(&numbers, &outcomes) {
                        observer.snapshot(number, lanes.snapshot(lane, (sample, transient)));
                    }
                }
                Next::Stop if sample < end => return None,
                Next::Snapshot | Next::Stop => {}
            }
        }
        if !leads {
            return None;
        }
        for lane in 0..numbers.len() {
            if outcomes[lane].is_none() {
                let outcome = Outcome::Completed(lanes.sums.errors(lane));
                finish(&mut outcomes, lane, outcome, &numbers, observer);
            }
        }
        Some(numbers.into_iter().zip(outcomes.into_iter().flatten()).collect())
    }
}

/// Keeps the outcome of a lane and tells it, if a replica of its own is in it.
#[cold]
#[inline(never)]
fn finish(
    outcomes: &mut [Option<Outcome>],
    lane: usize,
    outcome: Outcome,
    numbers: &[usize],
    observer: &dyn Observer,
) {
    if let Some(&number) = numbers.get(lane) {
        observer.finished(number, &outcome);
    }
    outcomes[lane] = Some(outcome);
}

/// The replicas that have come to no end yet, each with its lane.
fn going(numbers: &[usize], outcomes: &[Option<Outcome>]) -> impl Iterator<Item = (usize, usize)> {
    numbers.iter().copied().zip(0..).filter(|&(_, lane)| outcomes[lane].is_none())
}

/// All that changes while a batch runs.
struct InLanes<'a, const L: usize, const R: usize> {
    network: Network<'a, L, R>,
    sums: ErrorSums<L>,
    kicks: Kicks<L>,
    recorder: Recorder,
}

impl<const L: usize, const R: usize> InLanes<'_, L, R> {
    /// Takes up every replica where its snapshot left it.
    #[cold]
    #[inline(never)]
    fn restore(
        &mut self,
        starts: Vec<Numbered>,
        (sample, transient): (u64, u64),
        (n_nodes, n_free): (usize, usize),
    ) {
        let snapshots: Vec<Snapshot> =
            starts.into_iter().filter_map(|start| start.1.from).collect();
        let of = |lane: usize| &snapshots[lane.min(snapshots.len() - 1)];
        self.network.change_state(|component, node, lanes| {
            *lanes = std::array::from_fn(|lane| of(lane).state[component * n_nodes + node]);
        });
        if sample > transient {
            (0..L).for_each(|lane| self.sums.restore(lane, &of(lane).sums));
            self.sums.go_on_after(sample - transient);
        }
        self.kicks.go_on_after(sample, n_free * n_nodes);
    }

    /// Tells of replicas in their lanes at a sample, of which a record is due.
    #[cold]
    #[inline(never)]
    fn record(
        &mut self,
        at: (u64, f64),
        replicas: impl Iterator<Item = (usize, usize)>,
        observer: &dyn Observer,
    ) {
        let Self { network, recorder, .. } = self;
        for (number, lane) in replicas {
            let state = |component, node| network.node(component, node)[lane];
            recorder.tell((number, observer), at, state);
        }
    }

    /// What a lane has come to.
    #[cold]
    #[inline(never)]
    fn snapshot(&mut self, lane: usize, (sample, transient): (u64, u64)) -> Snapshot {
        let component = |c| self.network.component(c).map(|lanes| lanes[lane]);
        let state = (0..self.network.n_components()).flat_map(component).collect();
        let sums = if sample > transient { self.sums.kept(lane) } else { Vec::new() };
        Snapshot { sample, state, sums }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Replica;

    /// About the work of a network of 90 nodes, and of one of a thousand.
    const SMALL: Size = Size { work: 600.0, n_nodes: 90 };
    const LARGE: Size = Size { work: 17_000.0, n_nodes: 1000 };

    fn sizes(n_replicas: usize, n_threads: usize) -> Vec<usize> {
        cut(&[n_replicas], n_threads, SMALL).1
    }

    fn cheapest(n_replicas: usize) -> Vec<usize> {
        Teams { n: 1, n_seats: 1, size: SMALL }.cheapest(n_replicas).1
    }

    fn cost(sizes: &[usize]) -> f64 {
        let of = |&size: &usize| {
            COSTS.iter().find(|(lanes, _)| *lanes >= size).expect("no batch is wider").1
        };
        sizes.iter().map(of).sum()
    }

    #[test]
    fn every_replica_is_in_one_batch_and_no_batch_is_wider_than_the_lanes() {
        for (n_replicas, n_threads) in (0..70).flat_map(|n| [1, 2, 3, 8].map(|t| (n, t))) {
            let sizes = sizes(n_replicas, n_threads);
            assert_eq!(sizes.iter().sum::<usize>(), n_replicas);
            assert!(sizes.iter().all(|size| (1..=TILE).contains(size)), "{sizes:?}");
        }
    }

    #[test]
    fn replicas_that_have_begun_are_ended_before_others_begin() {
        let replica = Replica { epsilon: 0.0, seed: 1 };
        let snapshot = |sample| Snapshot { sample, state: Vec::new(), sums: Vec::new() };
        let start = |sample: u64| Start { replica, from: (sample > 0).then(|| snapshot(sample)) };
        let starts = [0, 7, 0, 9, 7].into_iter().map(start).enumerate().collect();
        let numbers = |batch: Vec<Numbered>| batch.into_iter().map(|start| start.0).collect();
        let batches: Vec<Vec<usize>> =
            of(starts, 1, LARGE).batches.into_iter().map(numbers).collect();
        assert_eq!(batches, [vec![3], vec![1, 4], vec![0, 2]]);
    }

    #[test]
    fn threads_share_replicas_equally_and_lanes_stay_empty_only_where_that_costs_less() {
        assert_eq!(sizes(4, 2), [2, 2]);
        assert_eq!(sizes(40, 2), [16, 4, 16, 4]);
        assert_eq!(sizes(5, 8), [1; 5]);
        // One lane of sixteen empty costs less than batches of 8, 4, 2 and 1.
        assert_eq!(sizes(15, 1), [15]);
        assert_eq!(sizes(9, 1), [8, 1]);
    }

    #[test]
    fn threads_share_a_large_network_of_few_replicas_and_no_small_one() {
        let seats =
            |n_replicas: usize, n_threads: usize, size| cut(&[n_replicas], n_threads, size).0;
        assert_eq!([1, 2].map(|n| seats(n, 2, LARGE)), [2; 2]);
        assert_eq!(seats(3, 8, LARGE), 4, "two batches on four threads each");
        assert_eq!([1, 2, 3, 4].map(|n| seats(n, 2, SMALL)), [1; 4]);
        assert_eq!(seats(64, 2, LARGE), 1, "lanes are full without that");
        assert_eq!(seats(1, 1, LARGE), 1);
    }

    #[test]
    fn no_cut_into_full_batches_costs_less() {
        for n in 1..50usize {
            let binary: Vec<usize> =
                (0..4).map(|bit| 1 << bit).filter(|size| n & size != 0).collect();
            let full = [vec![TILE; n / TILE], binary].concat();
            assert!(cost(&cheapest(n)) <= cost(&full) + 1e-12, "{n}: {:?}", cheapest(n));
        }
    }
}
