//! Classical fourth-order Runge–Kutta with a fixed step h:
//!
//! ```text
//! k1 = f(x)   k2 = f(x + h/2 k1)   k3 = f(x + h/2 k2)   k4 = f(x + h k3)
//! x(t + h) = x + h/6 k1 + h/3 k2 + h/3 k3 + h/6 k4      (summed in this order)
//! ```
//!
//! Source: W. Kutta, Z. Math. Phys. 46, 435 (1901).

use crate::tile::{MAX_COMPONENTS, slices, slices_mut};
use crate::{InstructionSet, NodeDynamics, Scalar};

/// Of each stage: its weight in the step, and how far it advances x for the next stage, both in h.
pub(crate) const STAGES: [(f64, f64); 4] =
    [(1.0 / 6.0, 0.5), (1.0 / 3.0, 0.5), (1.0 / 3.0, 1.0), (1.0 / 6.0, 0.0)];

/// The right-hand side f of a single system of `D` equations.
pub(crate) trait Flow<S, const D: usize> {
    /// f(x); to be inlined wherever it is used, see [`crate::instruction_set::Work`].
    fn at(&self, state: [S; D]) -> [S; D];
}

/// One step of a single system.
#[inline(always)]
pub(crate) fn step<S: Scalar, const D: usize>(
    flow: &impl Flow<S, D>,
    state: [S; D],
    h: f64,
) -> [S; D] {
    let (mut sum, mut ahead) = (state, state);
    for (weight, advance) in STAGES {
        let slope = flow.at(ahead);
        for c in 0..D {
            sum[c] = sum[c] + slope[c] * (weight * h);
            ahead[c] = state[c] + slope[c] * (advance * h);
        }
    }
    sum
}

/// One step of a single node whose equations are chosen at run time: the same operations.
pub(crate) fn advance(dynamics: &dyn NodeDynamics, state: &mut [f64], h: f64) {
    let n = state.len();
    let (mut sum, mut ahead) = ([0.0; MAX_COMPONENTS], [0.0; MAX_COMPONENTS]);
    let mut slope = [0.0; MAX_COMPONENTS];
    sum[..n].copy_from_slice(state);
    ahead[..n].copy_from_slice(state);
    for (weight, advance) in STAGES {
        let (at, mut to) = (slices(ahead.chunks(1)), slices_mut(slope.chunks_mut(1)));
        dynamics.flow(InstructionSet::Baseline, &at[..n], &mut to[..n]);
        for c in 0..n {
            sum[c] += slope[c] * (weight * h);
            ahead[c] = state[c] + slope[c] * (advance * h);
        }
    }
    state.copy_from_slice(&sum[..n]);
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Of<F>(F);

    impl<F: Fn([f64; D]) -> [f64; D], const D: usize> Flow<f64, D> for Of<F> {
        fn at(&self, state: [f64; D]) -> [f64; D] {
            (self.0)(state)
        }
    }

    #[test]
    fn a_step_of_the_linear_equation_is_the_taylor_polynomial_of_the_exponential() {
        let h = 0.1;
        let [x] = step(&Of(|[x]: [f64; 1]| [x]), [1.0], h);
        let taylor = 1.0 + h + h * h / 2.0 + h * h * h / 6.0 + h.powi(4) / 24.0;
        assert!((x - taylor).abs() < 1e-15);
    }

    #[test]
    fn the_error_falls_with_the_fourth_power_of_the_step() {
        // ẍ = −x from x = 1: x(1) = cos 1.
        let error = |steps: u32| {
            let h = 1.0 / f64::from(steps);
            let end = (0..steps)
                .fold([1.0, 0.0], |state, _| step(&Of(|[x, v]: [f64; 2]| [v, -x]), state, h));
            (end[0] - 1f64.cos()).abs()
        };
        let ratio = error(10) / error(20);
        assert!((14.0..18.0).contains(&ratio), "halving the step divides the error by {ratio}");
    }
}
