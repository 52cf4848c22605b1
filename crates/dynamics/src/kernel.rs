//! A step of a network, `dx_i/dt = F(x_i) + ε Σ_j w_ij H(x_j)`: Fan, Wang & Wang (2023), Eq. (1).
//!
//! The step is the classical Runge–Kutta step of fourth order, written with the points at which its
//! stages evaluate the equations, f(x) being the right-hand side:
//!
//! ```text
//! x_1 = x + h/2 f(x)    x_2 = x + h/2 f(x_1)    x_3 = x + h f(x_2)
//! x(t + h) = x + [(x_1 − x) + 2 (x_2 − x) + (x_3 − x)] / 3 + h/6 f(x_3)
//! ```
//!
//! so that a stage reads points that are there already and writes one, and nothing else.
//!
//! Lanes are replicas (couplings, seeds) advanced side by side. In memory the nodes of one component
//! follow one another, each with its lanes, and are cut into runs of [`WIDTH`] numbers: sixteen
//! nodes of a single replica, or one node of sixteen, or what lies between. Run by run a stage sums
//! the signals H(x_j) into the inputs Σ_j w_ij H(x_j) of its nodes, and evaluates their equations.
//!
//! Every lane goes through the same operations in the same order whatever its neighbours are:
//! results do not depend on the number of lanes, of threads, or on the machine.
//!
//! Source of the step: W. Kutta, Z. Math. Phys. 46, 435 (1901).

use crate::aligned::Aligned;
use crate::links::Links;
use crate::random::initial_states;
use crate::row_sums::RowSums;
use crate::{Coupling, ESCAPE_RADIUS, Lanes, Oscillator, Replica};

/// Numbers of which inputs are summed together. Numbers of lanes divide it.
pub(crate) const WIDTH: usize = 16;

/// Numbers on which equations are evaluated together: one AVX-512 or four SSE2 registers.
const VECTOR: usize = 8;

/// How far from x the stages put the next point, in h.
const ADVANCES: [f64; 3] = [0.5, 0.5, 1.0];

/// Points at which a step evaluates the equations.
const POINTS: usize = ADVANCES.len() + 1;

/// A network of `L` replicas, its rows summed `R` side by side.
pub(crate) struct Network<O, const D: usize, const L: usize, const R: usize> {
    equations: Equations<O>,
    rows: RowSums<L, R>,
    /// x, x_1, x_2, x_3 as `[point][component][place][lane]`; where the coupled component ends, the
    /// signals go on, see [`RowSums`].
    points: [[Aligned; D]; POINTS],
}

/// The points run by run, `[point][component][run]`.
type Points<'a, const D: usize> = [[&'a mut [[f64; WIDTH]]; D]; POINTS];

/// The right-hand side of nodes whose inputs are known.
struct Equations<O> {
    oscillator: O,
    coupling: Coupling,
    /// ε of every number in a run.
    epsilon: [f64; WIDTH],
}

impl<O: Oscillator<D>, const D: usize, const L: usize, const R: usize> Network<O, D, L, R> {
    pub(crate) fn new(
        oscillator: O,
        coupling: Coupling,
        links: &Links,
        replicas: [Replica; L],
    ) -> Self {
        let rows = RowSums::new(links);
        let length = |c: usize| {
            if c == coupling.from { rows.n_signals() } else { rows.n_runs() * WIDTH }
        };
        let point = |_| std::array::from_fn(|c| Aligned::zeros(length(c)));
        let mut network = Self {
            equations: Equations {
                oscillator,
                coupling,
                epsilon: std::array::from_fn(|number| replicas[number % L].epsilon),
            },
            points: std::array::from_fn(point),
            rows,
        };
        let drawn = replicas.map(|replica| initial_states::<O, D>(links.n_nodes(), replica.seed));
        network.change_state(|component, node, lanes| {
            *lanes = std::array::from_fn(|lane| drawn[lane][node][component]);
        });
        network
    }

    /// Advances every node by some steps h.
    #[inline(always)]
    pub(crate) fn advance(&mut self, n_steps: u32, h: f64) {
        let Self { equations, rows, points } = self;
        let mut points = points.each_mut().map(|point| point.each_mut().map(runs_mut));
        for _ in 0..n_steps {
            Self::stage::<0>(h, equations, rows, &mut points);
            Self::stage::<1>(h, equations, rows, &mut points);
            Self::stage::<2>(h, equations, rows, &mut points);
            Self::stage::<3>(h, equations, rows, &mut points);
        }
    }

    /// Evaluates the equations at one of the points, and puts the next one; from the last, x(t + h).
    #[inline(always)]
    fn stage<const POINT: usize>(
        h: f64,
        equations: &Equations<O>,
        rows: &RowSums<L, R>,
        points: &mut Points<'_, D>,
    ) {
        let from = equations.coupling.from;
        rows.share(points[POINT][from].as_flattened_mut().as_chunks_mut().0);
        for run in 0..rows.n_runs() {
            let inputs = rows.inputs(run, points[POINT][from].as_flattened().as_chunks().0);
            for part in 0..WIDTH / VECTOR {
                let place = (run, part);
                equations.stage::<D, POINT>(h, points, place, vector(&inputs, part));
            }
        }
    }

    /// The lanes of one component of every node, in the order of nodes.
    #[inline(always)]
    pub(crate) fn component(&self, component: usize) -> impl Iterator<Item = &[f64; L]> {
        let placed = self.points[0][component].as_chunks().0;
        self.rows.places().iter().map(move |&place| &placed[place as usize])
    }

    /// Changes the lanes of every component of every node, in this order.
    #[inline(always)]
    pub(crate) fn change_state(&mut self, mut change: impl FnMut(usize, usize, &mut [f64; L])) {
        for (c, component) in self.points[0].iter_mut().enumerate() {
            let placed = component.as_chunks_mut().0;
            for (node, &place) in self.rows.places().iter().enumerate() {
                change(c, node, &mut placed[place as usize]);
            }
        }
    }

    /// Lane by lane, whether every component of every node is within [`ESCAPE_RADIUS`]; a NaN is not.
    #[inline(always)]
    pub(crate) fn bounded(&self) -> [bool; L] {
        // 1 where a number was found outside.
        let mut outside = [0.0; L];
        for lanes in (0..D).flat_map(|c| self.component(c)) {
            for (outside, x) in outside.iter_mut().zip(lanes) {
                *outside = if x.abs() < ESCAPE_RADIUS { *outside } else { 1.0 };
            }
        }
        outside.map(|outside| outside == 0.0)
    }
}

impl<O> Equations<O> {
    /// A stage of one part of a run, whose inputs at the point are given.
    #[inline(always)]
    fn stage<const D: usize, const POINT: usize>(
        &self,
        h: f64,
        points: &mut Points<'_, D>,
        place: (usize, usize),
        input: Lanes<VECTOR>,
    ) where
        O: Oscillator<D>,
    {
        let (x, at) = (vectors(&points[0], place), vectors(&points[POINT], place));
        let mut f = self.oscillator.flow(at);
        for c in 0..D {
            if c == self.coupling.to {
                f[c] = f[c] + vector(&self.epsilon, place.1) * input;
            }
        }
        if POINT < ADVANCES.len() {
            for c in 0..D {
                put(points[POINT + 1][c], place, x[c] + f[c] * (ADVANCES[POINT] * h));
            }
        } else {
            let (x_1, x_2) = (vectors(&points[1], place), vectors(&points[2], place));
            for c in 0..D {
                let (d_1, d_2, d_3) = (x_1[c] - x[c], x_2[c] - x[c], at[c] - x[c]);
                let advance = ((d_1 + d_3) + (d_2 + d_2)) * (1.0 / 3.0) + f[c] * (h / 6.0);
                put(points[0][c], place, x[c] + advance);
            }
        }
    }
}

/// One part of a run of every component.
#[inline(always)]
fn vectors<const D: usize>(
    point: &[&mut [[f64; WIDTH]]; D],
    (run, part): (usize, usize),
) -> [Lanes<VECTOR>; D] {
    // A loop, since closures are not compiled for the instruction set of their surroundings.
    let mut vectors = [Lanes([0.0; VECTOR]); D];
    for c in 0..D {
        vectors[c] = vector(&point[c][run], part);
    }
    vectors
}

#[inline(always)]
fn put(component: &mut [[f64; WIDTH]], (run, part): (usize, usize), value: Lanes<VECTOR>) {
    component[run].as_chunks_mut().0[part] = value.0;
}

/// One part of a run.
#[inline(always)]
fn vector(run: &[f64; WIDTH], part: usize) -> Lanes<VECTOR> {
    Lanes(run.as_chunks().0[part])
}

#[inline(always)]
fn runs_mut(numbers: &mut Aligned) -> &mut [[f64; WIDTH]] {
    numbers.as_chunks_mut().0
}
