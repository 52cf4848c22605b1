//! A step of a network, `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`: Fan, Wang & Wang (2023), Eq. (1); of maps,
//! `x_i(n + 1) = F(x_i(n)) + ε Σ_j w_ij H(x_j(n))`.
//!
//! Lanes are replicas (couplings, seeds) advanced side by side. In memory the nodes of one component
//! follow one another, each with its lanes, and are cut into runs of [`TILE`] numbers. Some runs at a
//! time, a stage sums the signals h(x_j) into the inputs Σ_j w_ij h(x_j) of their nodes, and has their
//! equations evaluated, see [`Stage`].
//!
//! What is here is compiled once for each number of lanes and instruction set, whatever the equations.
//!
//! Every lane goes through the same operations in the same order whatever its neighbours are:
//! results do not depend on the number of lanes, of threads, or on the machine.

use crate::aligned::Aligned;
use crate::coupling::{Channels, Gain};
use crate::integrators::fixed::Fixed;
use crate::links::Links;
use crate::random::initial_states;
use crate::row_sums::RowSums;
use crate::stage::{RUNS, Stage, Strength, by_flow};
use crate::team::Seat;
use crate::tile::{TILE, Tile, slices, slices_mut};
use crate::{Coupling, InstructionSet, NodeDynamics, Replica};

/// A network of `L` replicas, its rows summed `R` side by side.
pub(crate) struct Network<'a, const L: usize, const R: usize> {
    dynamics: &'a dyn NodeDynamics,
    method: Fixed,
    instruction_set: InstructionSet,
    coupling: &'a Coupling,
    strengths: Vec<Strength>,
    rows: RowSums<L, R>,
    /// Of this thread, where several advance the network.
    seat: Seat<'a>,
    /// The slots of the step as `[slot][component][place][lane]`, x in the first. Where a component that
    /// is a channel ends, the signals go on, see [`RowSums`].
    slots: Vec<Aligned>,
    /// Signals that are not components, channel by channel.
    signals: Vec<Aligned>,
    /// Of some runs, channel by channel.
    inputs: Vec<[Tile; RUNS]>,
    /// Of some runs, component by component.
    slopes: Vec<[Tile; RUNS]>,
}

impl<'a, const L: usize, const R: usize> Network<'a, L, R> {
    pub(crate) fn new(
        (dynamics, coupling): (&'a dyn NodeDynamics, &'a Coupling),
        (method, instruction_set): (Fixed, InstructionSet),
        links: &Links,
        replicas: [Replica; L],
        mut seat: Seat<'a>,
    ) -> Self {
        let rows = RowSums::new(links);
        seat.share(rows.shares(seat.n_seats()));
        let n_components = dynamics.start().len();
        let (sent, n_sent) = match coupling.channels() {
            Channels::Components(components) => (components.as_slice(), 0),
            Channels::Formulas(_) => (&[][..], coupling.n_channels()),
        };
        let length =
            |c: usize| if sent.contains(&c) { rows.n_signals() } else { rows.n_runs() * TILE };
        let n_slots = method.slots() * n_components;
        let slots = (0..n_slots).map(|k| Aligned::zeros(length(k % n_components)));
        let strength = |&Gain { equation, channel, weight }: &Gain| {
            let of = std::array::from_fn(|number| replicas[number % L].epsilon * weight);
            Strength { equation, channel, of: vec![of; RUNS] }
        };
        let mut network = Self {
            dynamics,
            method,
            instruction_set,
            coupling,
            strengths: coupling.gains().iter().map(strength).collect(),
            slots: slots.collect(),
            signals: (0..n_sent).map(|_| Aligned::zeros(rows.n_signals())).collect(),
            inputs: vec![[[0.0; TILE]; RUNS]; coupling.n_channels()],
            slopes: vec![[[0.0; TILE]; RUNS]; n_components],
            rows,
            seat,
        };
        let n_nodes = links.n_nodes();
        let drawn = replicas.map(|replica| initial_states(dynamics.start(), n_nodes, replica.seed));
        network.change_state(|component, node, lanes| {
            *lanes = std::array::from_fn(|lane| drawn[lane][node * n_components + component]);
        });
        network
    }

    pub(crate) fn n_components(&self) -> usize {
        self.slopes.len()
    }

    /// Advances every node by some steps h. False when the threads that do so have come to an end.
    #[inline(always)]
    #[must_use]
    pub(crate) fn advance(&mut self, n_steps: u32, h: f64) -> bool {
        let n_components = self.n_components();
        let Self { dynamics, method, coupling, strengths, rows, seat, inputs, slopes, .. } = self;
        let own = seat.own();
        let instruction_set = self.instruction_set;
        let mut slots: Vec<&mut [Tile]> = self.slots.iter_mut().map(runs_mut).collect();
        let mut signals: Vec<&mut [Tile]> = self.signals.iter_mut().map(runs_mut).collect();
        // Of the longer step what goes through memory is the slots, beside which the slopes are little.
        let fused = dynamics.fused().filter(|_| *method == Fixed::Rk4);
        let all_sent: Vec<usize> = (0..signals.len()).collect();
        let points = method.points().iter().copied().enumerate();
        for (number, point) in (0..n_steps).flat_map(|_| points.clone()) {
            let here = &mut slots[point * n_components..][..n_components];
            match coupling.channels() {
                Channels::Components(components) => {
                    if !seat.exchange(here, components) {
                        return false;
                    }
                    for &from in components {
                        rows.share(here[from].as_flattened_mut().as_chunks_mut().0);
                    }
                }
                channels @ Channels::Formulas(_) => {
                    let at = slices(here.iter().map(|x| x[own.clone()].as_flattened()));
                    let n_sent = signals.len();
                    let mut to = slices_mut(
                        signals.iter_mut().map(|sent| sent[own.clone()].as_flattened_mut()),
                    );
                    channels.send(instruction_set, &at[..n_components], &mut to[..n_sent]);
                    if !seat.exchange(&mut signals, &all_sent) {
                        return false;
                    }
                    for sent in &mut signals {
                        rows.share(sent.as_flattened_mut().as_chunks_mut().0);
                    }
                }
            }
            let mut start = own.start;
            while start < own.end {
                let end = (start + RUNS).min(own.end);
                for (channel, inputs) in inputs.iter_mut().enumerate() {
                    let sent: &[Tile] = match coupling.channels() {
                        Channels::Components(from) => slots[point * n_components + from[channel]],
                        Channels::Formulas(_) => signals[channel],
                    };
                    let signals = sent.as_flattened().as_chunks().0;
                    for run in start..end {
                        rows.put_inputs(run, signals, &mut inputs[run - start]);
                    }
                }
                let mut stage = Stage {
                    method: *method,
                    number,
                    h,
                    gains: strengths,
                    inputs,
                    slots: &mut slots,
                    runs: start..end,
                    slopes,
                };
                match fused {
                    Some(fused) => fused.stage(instruction_set, &mut stage),
                    None => by_flow::stage(*dynamics, instruction_set, &mut stage),
                }
                start = end;
            }
            if dynamics.is_map() {
                let (now, next) = slots.split_at_mut(n_components);
                now.swap_with_slice(next);
            }
        }
        let going = seat.gather(&mut slots[..n_components]);
        if dynamics.is_map() && n_steps % 2 == 1 {
            self.slots.rotate_left(n_components);
        }
        going
    }

    /// The lanes of one component of every node, in the order of nodes.
    #[inline(always)]
    pub(crate) fn component(&self, component: usize) -> impl Iterator<Item = &[f64; L]> {
        let placed = self.slots[component].as_chunks().0;
        self.rows.places().iter().map(move |&place| &placed[place as usize])
    }

    /// The lanes of one component of one node.
    pub(crate) fn node(&self, component: usize, node: usize) -> &[f64; L] {
        &self.slots[component].as_chunks().0[self.rows.places()[node] as usize]
    }

    /// Changes the lanes of every component of every node, in this order.
    #[inline(always)]
    pub(crate) fn change_state(&mut self, change: impl FnMut(usize, usize, &mut [f64; L])) {
        self.change_components(self.n_components(), change);
    }

    /// The same of the first components.
    #[inline(always)]
    pub(crate) fn change_components(
        &mut self,
        n_components: usize,
        mut change: impl FnMut(usize, usize, &mut [f64; L]),
    ) {
        for (c, component) in self.slots[..n_components].iter_mut().enumerate() {
            let placed = component.as_chunks_mut().0;
            for (node, &place) in self.rows.places().iter().enumerate() {
                change(c, node, &mut placed[place as usize]);
            }
        }
    }

    /// Lane by lane, whether every component of every node but a clock is within the radius of escape; a
    /// NaN is not.
    #[inline(always)]
    pub(crate) fn bounded(&self) -> [bool; L] {
        let radius = self.dynamics.escape_radius();
        // 1 where a number was found outside.
        let mut outside = [0.0; L];
        for lanes in (0..self.dynamics.n_free()).flat_map(|c| self.component(c)) {
            for (outside, x) in outside.iter_mut().zip(lanes) {
                *outside = if x.abs() < radius { *outside } else { 1.0 };
            }
        }
        outside.map(|outside| outside == 0.0)
    }
}

#[inline(always)]
fn runs_mut(numbers: &mut Aligned) -> &mut [Tile] {
    numbers.as_chunks_mut().0
}
