//! The closed orbit on which an isolated oscillator settles, if it does.
//!
//! The oscillator is followed after its transient in windows, each twice as long as the one before. At the end
//! of one it may be near an attracting equilibrium; or it has come back to where the window began, across its
//! flow there, and Newton's iteration finds a limit cycle nearby. A cycle counts if it attracts (all its
//! multipliers but that along the flow are inside the unit circle) and the orbit is seen to stay on it:
//! the unstable cycles within a chaotic attractor do neither.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::cyclic_product::log_spectral_radius;
use super::mesh::Mesh;
use super::orbit::{ClosedOrbit, Cycle, Kind, extent};
use super::solve::solve;
use crate::error::whole;
use crate::isolated_orbit::IsolatedOrbit;
use crate::jacobians::Jacobians;
use crate::small_eigenvalues::eigenvalues;
use crate::{Coupling, DynamicsError, NodeDynamics, Progress};

/// Steps of the first window, and how many windows there are.
const FIRST_WINDOW: usize = 1 << 14;
const WINDOWS: usize = 5;
/// An orbit comes back when it passes within this distance of a state, in units of its extent.
const COMES_BACK: f64 = 1e-4;
/// Newton's iteration finds the orbit at hand within this distance, and its period within this share.
const AT_HAND: f64 = 0.02;
/// A cycle is looked for within a return after so many turns, each of which comes back within this distance.
const MOST_TURNS: u32 = 8;
const NEARLY_BACK: f64 = 0.1;
/// States of a turn that are held against those of the next one, and how many must be alike.
const STATES_OF_TURN: usize = 256;
const ALIKE: usize = 240;
/// Returns that are tried in a window.
const MOST_RETURNS: usize = 3;
/// The multiplier along the flow is 1 within this, the others are inside the unit circle by as much.
const MULTIPLIER: f64 = 1e-4;
/// Longest cycle of a map.
const LONGEST: usize = 4096;
/// A map has come back within this, relative to 1 and the largest component.
const MAP_COMES_BACK: f64 = 1e-9;
/// States of a window that must be on a closed orbit.
const LOOKS: usize = 64;

/// Dynamics and coupling, and who may want to stop.
pub(super) type Node<'a> = (&'a Arc<dyn NodeDynamics>, &'a Coupling, Progress<'a>);

/// An isolated oscillator after its transient.
pub(super) struct Follower<'a> {
    node: Node<'a>,
    orbit: IsolatedOrbit<'a>,
    step: f64,
}

/// A stretch of an orbit, state after state.
struct Window {
    states: Vec<f64>,
    n: usize,
}

impl<'a> Follower<'a> {
    /// From the initial state of a seed.
    pub fn after(
        node: Node<'a>,
        (step, transient): (f64, f64),
        seed: u64,
    ) -> Result<Self, DynamicsError> {
        let mut orbit = IsolatedOrbit::begin(node.0.as_ref(), step, seed);
        for _ in 0..whole(transient / step) {
            orbit.advance();
            orbit.bounded()?;
        }
        Ok(Self { node, orbit, step })
    }

    /// The closed orbit on which it settles.
    pub fn settles(mut self) -> Result<Option<ClosedOrbit>, DynamicsError> {
        for window in 0..WINDOWS {
            let window = self.window(FIRST_WINDOW << window)?;
            let found = if self.node.0.is_map() {
                self.map_cycle(&window)
            } else {
                self.equilibrium(&window).or_else(|| self.limit_cycle(&window))
            };
            if let Some(found) = found.filter(|found| self.stays_on(found, &window)) {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    /// Whether it settles on a closed orbit that is known.
    pub fn settles_on(mut self, closed: &ClosedOrbit) -> Result<bool, DynamicsError> {
        for window in 0..WINDOWS {
            let window = self.window(FIRST_WINDOW << window)?;
            if self.stays_on(closed, &window) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn window(&mut self, n_steps: usize) -> Result<Window, DynamicsError> {
        if (self.node.2)(0).is_break() {
            return Err(DynamicsError::Cancelled);
        }
        let n = self.orbit.state().len();
        let mut states = Vec::with_capacity((n_steps + 1) * n);
        states.extend(self.orbit.state());
        for _ in 0..n_steps {
            self.orbit.advance();
            states.extend(self.orbit.bounded()?);
        }
        Ok(Window { states, n })
    }

    /// Whether the last quarter of a window is on a closed orbit, and longer than that.
    fn stays_on(&self, closed: &ClosedOrbit, window: &Window) -> bool {
        let (dynamics, n_states) = (self.node.0.as_ref(), window.len());
        let quarter = n_states / 4;
        let is_long = match &closed.kind {
            Kind::LimitCycle(cycle) => quarter as f64 * self.step > cycle.mesh.period,
            Kind::Equilibrium { .. } | Kind::MapCycle { .. } => true,
        };
        let look = |k: usize| n_states - 1 - k * quarter / LOOKS;
        is_long && (0..LOOKS).all(|k| closed.is_near(dynamics, window.at(look(k))))
    }

    fn equilibrium(&self, window: &Window) -> Option<ClosedOrbit> {
        let (dynamics, n) = (self.node.0.as_ref(), window.n);
        let mut state = window.at(window.len() - 1).to_vec();
        for _ in 0..8 {
            let at = Jacobians::of_flow(dynamics, &state);
            let mut change = at.flow.clone();
            solve(&mut at.matrices.clone(), &mut change, n)?;
            state.iter_mut().zip(&change).for_each(|(x, change)| *x -= change);
        }
        let at = Jacobians::of_flow(dynamics, &state);
        let dh = Jacobians::of_coupling(dynamics, self.node.1, &state);
        let rates = eigenvalues(DMatrix::from_row_slice(n, n, at.matrix(0)))?;
        let attracts = rates.iter().all(|rate| rate.re < 0.0);
        let df = at.matrices;
        let kind = Kind::Equilibrium { state, df, dh };
        attracts.then(|| ClosedOrbit { kind, scale: vec![1.0; n] })
    }

    fn limit_cycle(&self, window: &Window) -> Option<ClosedOrbit> {
        let (dynamics, coupling, _) = self.node;
        let (scale, start) = (extent(&window.states, window.n), window.at(0));
        let returns = window.returns(dynamics.as_ref(), &scale).take(MOST_RETURNS);
        let near = |time: f64| {
            let mesh = Mesh::near((dynamics.as_ref(), coupling), (start, time), &scale)?;
            let is_here = apart(&mesh.start, start, &scale) <= AT_HAND
                && (mesh.period / time - 1.0).abs() <= AT_HAND;
            (is_here && attracts(&mesh)).then_some(mesh)
        };
        let mut cycles = returns.filter_map(|steps| near(steps * self.step));
        let found = cycles.next()?;
        // An orbit that spirals in from side to side is nearer after two turns than after one.
        let mut shares = (2..=MOST_TURNS).rev().map(|turns| found.period / f64::from(turns));
        let is_near = |time: &f64| {
            let step = usize::try_from(whole(time / self.step)).unwrap_or(usize::MAX);
            step < window.len() && apart(window.at(step), start, &scale) <= NEARLY_BACK
        };
        let mesh =
            shares.find_map(|time| Some(time).filter(is_near).and_then(near)).unwrap_or(found);
        let scale = extent(&mesh.states, window.n);
        let cycle = Cycle::new(dynamics.clone(), coupling.clone(), mesh);
        Some(ClosedOrbit { kind: Kind::LimitCycle(Box::new(cycle)), scale })
    }

    fn map_cycle(&self, window: &Window) -> Option<ClosedOrbit> {
        let (dynamics, n) = (self.node.0.as_ref(), window.n);
        // The end of the window has come nearer than its beginning.
        let last = window.len() - 1;
        let end = window.at(last);
        let size = end.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
        let is_back = |k: &usize| {
            let before = window.at(last - k).iter().zip(end);
            before.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) <= MAP_COMES_BACK * size
        };
        let length = (1..=LONGEST.min(last)).find(is_back)?;
        let states = window.states[(last + 1 - length) * n..].to_vec();
        let df = Jacobians::of_flow(dynamics, &states).matrices;
        let dh = Jacobians::of_coupling(dynamics, self.node.1, &states);
        let attracts = log_spectral_radius(&df, n) < -MULTIPLIER;
        let kind = Kind::MapCycle { states, df, dh };
        attracts.then(|| ClosedOrbit { kind, scale: vec![1.0; n] })
    }
}

/// Whether all multipliers but that along the flow are inside the unit circle.
fn attracts(mesh: &Mesh) -> bool {
    let n = mesh.start.len();
    let multipliers = eigenvalues(DMatrix::from_row_slice(n, n, &mesh.monodromy));
    let Some(multipliers) = multipliers else { return false };
    let mut off: Vec<(f64, f64)> =
        multipliers.iter().map(|mu| ((mu - 1.0).norm(), mu.norm())).collect();
    off.sort_by(|a, b| a.0.total_cmp(&b.0));
    off[0].0 <= MULTIPLIER && off[1..].iter().all(|(_, size)| *size < 1.0 - MULTIPLIER)
}

/// Distance of two states in units of a scale.
fn apart(a: &[f64], b: &[f64], scale: &[f64]) -> f64 {
    let each = a.iter().zip(b).zip(scale).map(|((a, b), scale)| (a - b).abs() / scale);
    each.fold(0.0, f64::max)
}

impl Window {
    fn len(&self) -> usize {
        self.states.len() / self.n
    }

    fn at(&self, step: usize) -> &[f64] {
        &self.states[step * self.n..][..self.n]
    }

    /// Times, in steps, at which the orbit comes back to where it began: it crosses the plane across its
    /// flow there, the same way, and close by.
    fn returns<'w>(
        &'w self,
        dynamics: &dyn NodeDynamics,
        scale: &'w [f64],
    ) -> impl Iterator<Item = f64> + 'w {
        let start = self.at(0);
        let flow = Jacobians::of_flow(dynamics, start).flow;
        let normal: Vec<f64> = flow.iter().zip(scale).map(|(f, scale)| f / scale.powi(2)).collect();
        let height = move |step: usize| -> f64 {
            let off = self.at(step).iter().zip(start).zip(&normal);
            off.map(|((x, start), normal)| (x - start) * normal).sum()
        };
        (2..self.len() - 2).filter_map(move |step| {
            let heights = [height(step - 1), height(step), height(step + 1), height(step + 2)];
            (heights[1] < 0.0 && heights[2] >= 0.0).then_some(())?;
            let share = crossing(heights);
            let at = |c: usize| {
                let of = |k: usize| self.at(step + k - 1)[c];
                cubic([of(0), of(1), of(2), of(3)], share)
            };
            let crossed: Vec<f64> = (0..self.n).map(at).collect();
            let comes_back = apart(&crossed, start, scale) <= COMES_BACK;
            (comes_back && self.repeats(step, scale)).then_some(step as f64 + share)
        })
    }

    /// Whether what comes after so many steps is about what there was before them, but for a few states, as of
    /// a jump that is met a step later: chaos comes back by chance, and goes another way then.
    fn repeats(&self, n_steps: usize, scale: &[f64]) -> bool {
        let is_alike = |k: &usize| {
            let step = k * n_steps / STATES_OF_TURN;
            apart(self.at(step), self.at(step + n_steps), scale) <= NEARLY_BACK
        };
        let is_seen = 2 * n_steps < self.len();
        is_seen && (0..STATES_OF_TURN).filter(is_alike).count() >= ALIKE
    }
}

/// The cubic through values at −1, 0, 1 and 2.
fn cubic([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    a * (-t * (t - 1.0) * (t - 2.0) / 6.0)
        + b * ((t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0)
        + c * (-(t + 1.0) * t * (t - 2.0) / 2.0)
        + d * ((t + 1.0) * t * (t - 1.0) / 6.0)
}

/// Where that cubic crosses zero between 0 and 1, by bisection.
fn crossing(values: [f64; 4]) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if cubic(values, middle) < 0.0 { low = middle } else { high = middle }
    }
    high
}
