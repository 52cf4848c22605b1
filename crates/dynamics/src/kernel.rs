//! A step of a network, `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`: Fan, Wang & Wang (2023), Eq. (1).
//!
//! Lanes are replicas (couplings, seeds) advanced side by side. In memory the nodes of one component
//! follow one another, each with its lanes, and are cut into runs of [`WIDTH`] numbers: sixteen
//! nodes of a single replica, or one node of sixteen, or what lies between. Each stage of a step
//!
//! 1. sums the signals H(x_j) into the input Σ_j w_ij H(x_j) of every node, lane by lane;
//! 2. evaluates the equations on runs of numbers, whatever nodes and lanes these are.
//!
//! Every lane goes through the same operations in the same order whatever its neighbours are:
//! results do not depend on the number of lanes, of threads, or on the machine.

use crate::aligned::Aligned;
use crate::integrators::rk4::STAGES;
use crate::random::initial_states;
use crate::row_sums::RowSums;
use crate::{Coupling, ESCAPE_RADIUS, Oscillator, Replica, SparseMatrix};

/// Numbers that are advanced together: two AVX-512 or eight SSE2 registers. Numbers of lanes divide
/// it.
pub(crate) const WIDTH: usize = 16;

pub(crate) type Run = [f64; WIDTH];

/// A network of `L` replicas, its rows summed `R` side by side.
pub(crate) struct Network<O, const D: usize, const L: usize, const R: usize> {
    equations: Equations<O>,
    rows: RowSums<R>,
    n_nodes: usize,
    /// x at the start of the step, `[run][component][number in the run]`.
    state: Aligned,
    /// x at which the stage evaluates the equations, laid out as `state`.
    ahead: Aligned,
    /// What the stages so far have made of x(t + h), laid out as `state`.
    sum: Aligned,
    /// The coupled component of `ahead`, `[node][lane]`; beyond the last run a node that is always 0.
    signals: Aligned,
    /// Σ_j w_ij H(x_j), `[node][lane]`.
    inputs: Aligned,
}

impl<O: Oscillator<D>, const D: usize, const L: usize, const R: usize> Network<O, D, L, R> {
    pub(crate) fn new(
        oscillator: O,
        coupling: Coupling,
        matrix: &SparseMatrix,
        replicas: [Replica; L],
    ) -> Self {
        let n_nodes = matrix.rows();
        let n_runs = (n_nodes * L).div_ceil(WIDTH);
        let zeros = |of_each_run: usize| Aligned::zeros(n_runs * of_each_run);
        let mut network = Self {
            equations: Equations {
                oscillator,
                coupling,
                epsilon: std::array::from_fn(|number| replicas[number % L].epsilon),
            },
            rows: RowSums::new(matrix, n_runs * WIDTH / L),
            n_nodes,
            state: zeros(D * WIDTH),
            ahead: zeros(D * WIDTH),
            sum: zeros(D * WIDTH),
            signals: Aligned::zeros((n_runs + 1) * WIDTH),
            inputs: Aligned::zeros((n_runs + 1) * WIDTH),
        };
        let drawn = replicas.map(|replica| initial_states::<O, D>(n_nodes, replica.seed));
        network.change_state(|component, node, lanes| {
            *lanes = std::array::from_fn(|lane| drawn[lane][node][component]);
        });
        network
    }

    /// Advances every node by one step h.
    #[inline(always)]
    pub(crate) fn step(&mut self, h: f64) {
        self.stage::<0>(h);
        self.stage::<1>(h);
        self.stage::<2>(h);
        self.stage::<3>(h);
    }

    /// One stage of the step, for all nodes.
    #[inline(always)]
    fn stage<const INDEX: usize>(&mut self, h: f64) {
        self.rows.sum::<L>(self.signals.as_chunks().0, self.inputs.as_chunks_mut().0);
        let runs = runs_mut::<D>(&mut self.state)
            .iter_mut()
            .zip(runs_mut::<D>(&mut self.ahead))
            .zip(runs_mut::<D>(&mut self.sum))
            .zip(self.signals.as_chunks_mut().0)
            .zip(self.inputs.as_chunks().0);
        for ((((state, ahead), sum), signal), input) in runs {
            self.equations.stage::<D, INDEX>(h, state, ahead, sum, signal, input);
        }
    }

    /// One component of the state, `[node][lane]`, run by run. What fills the last run up is no node.
    #[inline(always)]
    pub(crate) fn component(&self, component: usize) -> impl Iterator<Item = &[f64; WIDTH]> {
        self.state.as_chunks().0.as_chunks::<D>().0.iter().map(move |run| &run[component])
    }

    /// Changes the lanes of every component of every node, in this order.
    #[inline(always)]
    pub(crate) fn change_state(&mut self, mut change: impl FnMut(usize, usize, &mut [f64; L])) {
        for c in 0..D {
            let runs = runs_mut::<D>(&mut self.state).iter_mut();
            let nodes = runs.flat_map(|run| run[c].as_chunks_mut::<L>().0).take(self.n_nodes);
            nodes.enumerate().for_each(|(node, lanes)| change(c, node, lanes));
        }
        let coupled =
            self.state.as_chunks::<WIDTH>().0.iter().skip(self.equations.coupling.from).step_by(D);
        self.signals.as_chunks_mut::<WIDTH>().0.iter_mut().zip(coupled).for_each(|(s, x)| *s = *x);
    }

    /// Lane by lane, whether every component of every node is within [`ESCAPE_RADIUS`]; a NaN is not.
    #[inline(always)]
    pub(crate) fn bounded(&self) -> [bool; L] {
        let runs = self.state.as_chunks().0.as_chunks::<D>().0;
        let (whole, rest) = runs.split_at(self.n_nodes * L / WIDTH);
        // 1 where a number was found outside.
        let mut outside = [0.0; WIDTH];
        let mut look = |run: &[[f64; WIDTH]; D], length: usize| {
            for x in run {
                for (outside, x) in outside[..length].iter_mut().zip(&x[..length]) {
                    *outside = if x.abs() < ESCAPE_RADIUS { *outside } else { 1.0 };
                }
            }
        };
        whole.iter().for_each(|run| look(run, WIDTH));
        rest.iter().for_each(|run| look(run, self.n_nodes * L % WIDTH));
        std::array::from_fn(|lane| outside[lane..].iter().step_by(L).all(|&outside| outside == 0.0))
    }
}

/// The equations of nodes whose inputs are known.
struct Equations<O> {
    oscillator: O,
    coupling: Coupling,
    /// ε of every number in a run.
    epsilon: Run,
}

impl<O> Equations<O> {
    /// One stage of a step h for a run of numbers: k = F(x) + ε · input at `ahead`, its part of
    /// x(t + h), and the x at which the next stage looks.
    #[inline(always)]
    fn stage<const D: usize, const INDEX: usize>(
        &self,
        h: f64,
        state: &mut [Run; D],
        ahead: &mut [Run; D],
        sum: &mut [Run; D],
        signal: &mut Run,
        input: &Run,
    ) where
        O: Oscillator<D>,
    {
        let (weight, advance) = STAGES[INDEX];
        let (first, last) = (INDEX == 0, INDEX + 1 == STAGES.len());
        let Coupling { from, to } = self.coupling;
        for number in 0..WIDTH {
            let at = if first { column(state, number) } else { column(ahead, number) };
            let mut k = self.oscillator.flow(at);
            for c in 0..D {
                if c == to {
                    k[c] += self.epsilon[number] * input[number];
                }
                let before = if first { state[c][number] } else { sum[c][number] };
                let total = before + k[c] * (weight * h);
                let next = if last { total } else { state[c][number] + k[c] * (advance * h) };
                if last {
                    state[c][number] = total;
                } else {
                    sum[c][number] = total;
                    ahead[c][number] = next;
                }
                if c == from {
                    signal[number] = next;
                }
            }
        }
    }
}

/// One number of every component.
#[inline(always)]
fn column<const D: usize>(run: &[Run; D], number: usize) -> [f64; D] {
    let mut column = [0.0; D];
    for c in 0..D {
        column[c] = run[c][number];
    }
    column
}

#[inline(always)]
fn runs_mut<const D: usize>(numbers: &mut Aligned) -> &mut [[[f64; WIDTH]; D]] {
    numbers.as_chunks_mut().0.as_chunks_mut().0
}
