//! Threads that advance one network together, each the nodes of some runs.
//!
//! Every thread has the whole network to itself in memory and computes its own runs. Before an evaluation
//! of the equations it hands out the signals of its runs and takes over those of the others, so that sums
//! over neighbours read plain memory; at a sample the first thread takes over all states, to look at
//! them. What is handed out lies behind a lock that is free whenever it is wanted: a number that counts
//! rounds, for which threads wait, says when it may be read. There are two of each piece, taken in turns.
//! Who puts a piece of round n has had those of round n − 1 from all others, and they had by then read the
//! one of round n − 2, in whose place it goes.

use std::ops::Range;
use std::sync::RwLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::tile::Tile;

/// Looks at a number that another thread will change, before a thread lets others go first.
const SPINS: u32 = 500;

/// What a team of threads has in common.
pub(crate) struct Team {
    /// Of each thread, what it hands out in even and in odd rounds, and at samples.
    hands: Vec<[Piece; 3]>,
    /// The first thread has ended, or another one has failed.
    ended: AtomicBool,
}

/// Numbers that one thread hands out, on cache lines of their own.
#[repr(align(128))]
#[derive(Default)]
struct Piece {
    round: AtomicU64,
    numbers: RwLock<Vec<Tile>>,
}

/// Where states are handed out at samples.
const AT_SAMPLES: usize = 2;

/// The place of one thread in its team.
pub(crate) struct Seat<'a> {
    /// None for a thread by itself.
    team: Option<&'a Team>,
    number: usize,
    /// Of each thread, its runs.
    runs: Vec<Range<usize>>,
    rounds: u64,
    samples: u64,
}

impl Team {
    pub(crate) fn of(n_threads: usize) -> Self {
        Self {
            hands: (0..n_threads).map(|_| Default::default()).collect(),
            ended: AtomicBool::new(false),
        }
    }

    /// The place of each thread; the first one leads.
    pub(crate) fn seats(&self) -> impl Iterator<Item = Seat<'_>> {
        let several = self.hands.len() > 1;
        (0..self.hands.len()).map(move |number| Seat {
            team: several.then_some(self),
            number,
            runs: Vec::new(),
            rounds: 0,
            samples: 0,
        })
    }
}

impl Seat<'_> {
    /// Threads of the team.
    pub(crate) fn n_seats(&self) -> usize {
        self.team.map_or(1, |team| team.hands.len())
    }

    /// Whether this thread is the one that looks at states and speaks with the observer.
    pub(crate) fn leads(&self) -> bool {
        self.number == 0
    }

    /// Says which runs are whose.
    pub(crate) fn share(&mut self, runs: Vec<Range<usize>>) {
        assert_eq!(runs.len(), self.n_seats(), "every thread has runs");
        self.runs = runs;
    }

    /// The runs of this thread.
    pub(crate) fn own(&self) -> Range<usize> {
        self.runs[self.number].clone()
    }

    /// Hands out the own runs of some signals and takes over the others. False when the team has come
    /// to an end.
    #[must_use]
    pub(crate) fn exchange(&mut self, signals: &mut [&mut [Tile]], which: &[usize]) -> bool {
        let Some(team) = self.team else { return true };
        self.rounds += 1;
        let piece = (self.rounds % 2) as usize;
        team.hands[self.number][piece].put(self.rounds, signals, which, self.own());
        self.others().all(|(other, runs)| {
            team.takes(&team.hands[other][piece], self.rounds, signals, which, runs)
        })
    }

    /// Hands over the states of the own runs to the first thread, which takes over all. False when the
    /// team has come to an end.
    #[must_use]
    pub(crate) fn gather(&mut self, states: &mut [&mut [Tile]]) -> bool {
        let Some(team) = self.team else { return true };
        self.samples += 1;
        let all: Vec<usize> = (0..states.len()).collect();
        if self.leads() {
            return self.others().all(|(other, runs)| {
                team.takes(&team.hands[other][AT_SAMPLES], self.samples, states, &all, runs)
            });
        }
        team.hands[self.number][AT_SAMPLES].put(self.samples, states, &all, self.own());
        true
    }

    fn others(&self) -> impl Iterator<Item = (usize, Range<usize>)> {
        let own = self.number;
        self.runs.iter().cloned().enumerate().filter(move |&(number, _)| number != own)
    }
}

impl Drop for Seat<'_> {
    fn drop(&mut self) {
        if let Some(team) = self.team
            && (self.leads() || std::thread::panicking())
        {
            team.ended.store(true, Ordering::Release);
        }
    }
}

impl Team {
    /// Takes over the numbers of a round, once they are there.
    fn takes(
        &self,
        piece: &Piece,
        round: u64,
        to: &mut [&mut [Tile]],
        which: &[usize],
        runs: Range<usize>,
    ) -> bool {
        let is_there = || piece.round.load(Ordering::Acquire) >= round;
        let mut looks = 0;
        while !is_there() {
            // A thread that has ended may have put its numbers just before.
            if self.ended.load(Ordering::Acquire) && !is_there() {
                return false;
            }
            looks += 1;
            if looks < SPINS { std::hint::spin_loop() } else { std::thread::yield_now() }
        }
        let Ok(numbers) = piece.numbers.read() else { return false };
        let mut numbers = numbers.chunks(runs.len().max(1));
        for (&component, numbers) in which.iter().zip(&mut numbers) {
            to[component][runs.clone()].copy_from_slice(numbers);
        }
        true
    }
}

impl Piece {
    fn put(&self, round: u64, from: &[&mut [Tile]], which: &[usize], runs: Range<usize>) {
        let mut numbers = self.numbers.write().expect("no thread fails while it copies");
        numbers.clear();
        which.iter().for_each(|&c| numbers.extend_from_slice(&from[c][runs.clone()]));
        drop(numbers);
        self.round.store(round, Ordering::Release);
    }
}
