//! Classical fourth-order Runge–Kutta with a fixed step h:
//!
//! ```text
//! k1 = f(x)   k2 = f(x + h/2 k1)   k3 = f(x + h/2 k2)   k4 = f(x + h k3)
//! x(t + h) = x + h/6 k1 + h/3 k2 + h/3 k3 + h/6 k4      (summed in this order)
//! ```
//!
//! Source: W. Kutta, Z. Math. Phys. 46, 435 (1901).

use crate::Scalar;
use crate::network::NetworkFlow;
use crate::oscillator::Oscillator;

/// Of each stage: its weight in the step, and how far it advances x for the next stage, both in h.
const STAGES: [(f64, f64); 4] =
    [(1.0 / 6.0, 0.5), (1.0 / 3.0, 0.5), (1.0 / 3.0, 1.0), (1.0 / 6.0, 0.0)];

/// One step of a single system of `D` equations.
#[inline(always)]
pub(crate) fn step<S: Scalar, const D: usize>(
    flow: impl Fn([S; D]) -> [S; D],
    state: [S; D],
    h: f64,
) -> [S; D] {
    let (mut sum, mut ahead) = (state, state);
    for (weight, advance) in STAGES {
        let slope = flow(ahead);
        for c in 0..D {
            sum[c] = sum[c] + slope[c] * (weight * h);
            ahead[c] = state[c] + slope[c] * (advance * h);
        }
    }
    sum
}

/// The state of a network, `[component][node]`, with what a step needs beside it.
pub(crate) struct NetworkRk4<S, const D: usize> {
    state: [Vec<S>; D],
    stage: [Vec<S>; D],
    ahead: [Vec<S>; D],
    sum: [Vec<S>; D],
}

impl<S: Scalar, const D: usize> NetworkRk4<S, D> {
    pub(crate) fn new(state: [Vec<S>; D]) -> Self {
        Self { stage: state.clone(), ahead: state.clone(), sum: state.clone(), state }
    }

    pub(crate) fn state(&self) -> [&[S]; D] {
        slices(&self.state)
    }

    pub(crate) fn state_mut(&mut self) -> &mut [Vec<S>; D] {
        &mut self.state
    }

    /// Advances every node by one step h, with a coupling strength for every lane.
    #[inline(always)]
    pub(crate) fn step<O: Oscillator<D>>(
        &mut self,
        flow: &NetworkFlow<'_, O, D>,
        epsilon: S,
        h: f64,
    ) {
        for (index, (weight, advance)) in STAGES.into_iter().enumerate() {
            let at = slices(if index == 0 { &self.state } else { &self.stage });
            for node in 0..flow.n_nodes() {
                let slope = flow.at(node, at, epsilon);
                for c in 0..D {
                    let sum = if index == 0 { self.state[c][node] } else { self.sum[c][node] };
                    self.sum[c][node] = sum + slope[c] * (weight * h);
                    self.ahead[c][node] = self.state[c][node] + slope[c] * (advance * h);
                }
            }
            std::mem::swap(&mut self.stage, &mut self.ahead);
        }
        std::mem::swap(&mut self.state, &mut self.sum);
    }
}

fn slices<S, const D: usize>(components: &[Vec<S>; D]) -> [&[S]; D] {
    std::array::from_fn(|c| &components[c][..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_of_the_linear_equation_is_the_taylor_polynomial_of_the_exponential() {
        let h = 0.1;
        let [x] = step(|[x]: [f64; 1]| [x], [1.0], h);
        let taylor = 1.0 + h + h * h / 2.0 + h * h * h / 6.0 + h.powi(4) / 24.0;
        assert!((x - taylor).abs() < 1e-15);
    }

    #[test]
    fn the_error_falls_with_the_fourth_power_of_the_step() {
        // ẍ = −x from x = 1: x(1) = cos 1.
        let error = |steps: u32| {
            let h = 1.0 / f64::from(steps);
            let end = (0..steps).fold([1.0, 0.0], |state, _| step(|[x, v]| [v, -x], state, h));
            (end[0] - 1f64.cos()).abs()
        };
        let ratio = error(10) / error(20);
        assert!((14.0..18.0).contains(&ratio), "halving the step divides the error by {ratio}");
    }
}
