//! Whether a state is on an orbit that closes, and whether an orbit stays there.

use super::orbit::{ClosedOrbit, Kind};
use crate::NodeDynamics;
use crate::jacobians::Jacobians;

/// A state is on a limit cycle within this distance, in extents of the cycle: more than the step of an
/// integrator does to an orbit, and less than what there is between two orbits.
const ON_CYCLE: f64 = 1e-3;
/// And at rest, or on a cycle of a map, within this, relative to 1 and the largest component.
const AT_STATE: f64 = 1e-6;

impl ClosedOrbit {
    /// Whether a state is on it.
    pub(super) fn is_near(&self, dynamics: &dyn NodeDynamics, state: &[f64]) -> bool {
        match &self.kind {
            Kind::Equilibrium { state: rest, .. } => is_at(rest, state),
            Kind::MapCycle { states, .. } => {
                states.chunks(state.len()).any(|one| is_at(one, state))
            }
            Kind::LimitCycle(cycle) => {
                distance(dynamics, &cycle.mesh.states, state, &self.scale) <= ON_CYCLE
            }
        }
    }
}

fn is_at(rest: &[f64], state: &[f64]) -> bool {
    let size = rest.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
    rest.iter().zip(state).all(|(rest, x)| (x - rest).abs() <= AT_STATE * size)
}

/// Distance of a state from the orbit through some states, which is followed from the nearest of them to the
/// second order in time, ẋ = F and ẍ = DF F.
fn distance(dynamics: &dyn NodeDynamics, states: &[f64], state: &[f64], scale: &[f64]) -> f64 {
    let n = scale.len();
    let off =
        |point: &[f64]| -> Vec<f64> { (0..n).map(|c| (state[c] - point[c]) / scale[c]).collect() };
    let square = |off: &[f64]| off.iter().map(|x| x * x).sum::<f64>();
    let nearest = states.chunks(n).min_by(|a, b| square(&off(a)).total_cmp(&square(&off(b))));
    let Some(nearest) = nearest else { return f64::INFINITY };
    let at = Jacobians::of_flow(dynamics, nearest);
    let scaled = |c: usize, value: f64| value / scale[c];
    let flow: Vec<f64> = (0..n).map(|c| scaled(c, at.flow[c])).collect();
    let bend = |c: usize| (0..n).map(|k| at.matrices[c * n + k] * at.flow[k]).sum();
    let bend: Vec<f64> = (0..n).map(|c| scaled(c, bend(c))).collect();
    let off = off(nearest);
    let time = off.iter().zip(&flow).map(|(x, f)| x * f).sum::<f64>() / square(&flow);
    let left = |c: usize| off[c] - time * flow[c] - 0.5 * time * time * bend[c];
    square(&(0..n).map(left).collect::<Vec<_>>()).sqrt()
}
