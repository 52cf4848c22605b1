//! Radau IIA collocation with five stages, of order nine:
//!
//! ```text
//! X_i = x + h Σ_j a_ij f(X_j)      x(t + h) = X_5
//! ```
//!
//! A fast direction is damped at any step, as the equations damp it, so that one mesh in time serves every
//! σ; and what is linear in x is so exactly in a step, which makes a step of the tangents the derivative
//! of a step of the orbit.
//!
//! Source: E. Hairer & G. Wanner, Solving Ordinary Differential Equations II (1996), Sec. IV.5. The nodes are
//! the zeros of P_5 − P_4, Legendre polynomials on (0, 1); the weights integrate polynomials exactly.

use std::sync::LazyLock;

use super::solve::solve;
use crate::NodeDynamics;
use crate::integrators::rk4;
use crate::jacobians::Jacobians;

/// Stages of a step.
pub(super) const STAGES: usize = 5;

/// Where in a step the stages are.
const NODES: [f64; STAGES] = [
    0.057_104_196_114_517_68,
    0.276_843_013_638_123_8,
    0.583_590_432_368_916_8,
    0.860_240_135_656_219_4,
    1.0,
];

/// a_ij.
static WEIGHTS: LazyLock<[[f64; STAGES]; STAGES]> = LazyLock::new(weights);

/// Rounds of Newton's iteration, which doubles the digits each time, and where it ends.
const MOST_ROUNDS: usize = 12;
const CONVERGED: f64 = 1e-13;

/// A step of an orbit.
pub(super) struct OrbitStep {
    /// States of the stages, component by component, the last of them that at its end.
    pub stages: Vec<f64>,
    /// DF there, each row by row.
    pub jacobians: Vec<f64>,
}

impl OrbitStep {
    /// From x, with states in units of `scale`. None where no solution is found.
    pub fn from(dynamics: &dyn NodeDynamics, x: &[f64], h: f64, scale: &[f64]) -> Option<Self> {
        let n = x.len();
        let mut stages = guess(dynamics, x, h);
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ROUNDS {
            let at = Jacobians::of_flow(dynamics, &stages);
            let mut residual = vec![0.0; STAGES * n];
            for i in 0..STAGES {
                for c in 0..n {
                    let slope: f64 = (0..STAGES).map(|j| WEIGHTS[i][j] * at.flow[j * n + c]).sum();
                    residual[i * n + c] = x[c] + h * slope - stages[i * n + c];
                }
            }
            solve(&mut collocated(&at.matrices, n, h), &mut residual, STAGES * n)?;
            stages.iter_mut().zip(&residual).for_each(|(stage, change)| *stage += change);
            let changes = residual.iter().zip(scale.iter().cycle());
            let change = changes.map(|(change, scale)| change.abs() / scale).fold(0.0, f64::max);
            // Rounding ends what Newton's iteration can do.
            if change <= CONVERGED || (change < 1e-9 && change >= 0.5 * last) {
                let jacobians = Jacobians::of_flow(dynamics, &stages).matrices;
                return Some(Self { stages, jacobians });
            }
            if !change.is_finite() {
                return None;
            }
            last = change;
        }
        None
    }

    /// The state at its end.
    pub fn end(&self) -> &[f64] {
        let n = self.stages.len() / STAGES;
        &self.stages[(STAGES - 1) * n..]
    }
}

/// What a step makes of tangents that follow δ̇ = A(t) δ, with A at the stages, each row by row: a matrix of
/// the same size, row by row. None where there is none.
pub(super) fn propagator(a: &[f64], n: usize, h: f64) -> Option<Vec<f64>> {
    let mut stages = vec![0.0; STAGES * n * n];
    for stage in 0..STAGES {
        (0..n).for_each(|c| stages[(stage * n + c) * n + c] = 1.0);
    }
    solve(&mut collocated(a, n, h), &mut stages, STAGES * n)?;
    Some(stages[(STAGES - 1) * n * n..].to_vec())
}

/// 1 − h (a_ij A_j), row by row.
fn collocated(a: &[f64], n: usize, h: f64) -> Vec<f64> {
    let size = STAGES * n;
    let mut matrix = vec![0.0; size * size];
    for i in 0..STAGES {
        for j in 0..STAGES {
            let weight = h * WEIGHTS[i][j];
            for row in 0..n {
                for c in 0..n {
                    matrix[(i * n + row) * size + j * n + c] = -weight * a[(j * n + row) * n + c];
                }
            }
        }
    }
    (0..size).for_each(|k| matrix[k * size + k] += 1.0);
    matrix
}

/// States near those of the stages, by RK4 from one to the next.
fn guess(dynamics: &dyn NodeDynamics, x: &[f64], h: f64) -> Vec<f64> {
    let (mut state, mut before) = (x.to_vec(), 0.0);
    let mut stages = Vec::with_capacity(STAGES * x.len());
    for node in NODES {
        rk4::advance(dynamics, &mut state, (node - before) * h);
        before = node;
        stages.extend(&state);
    }
    stages
}

/// Σ_j a_ij c_j^(k−1) = c_i^k / k for k up to the number of stages.
fn weights() -> [[f64; STAGES]; STAGES] {
    std::array::from_fn(|i| {
        let power = |c: f64, k: usize| (0..k).fold(1.0, |product, _| product * c);
        let mut powers: Vec<f64> = (0..STAGES).flat_map(|k| NODES.map(|c| power(c, k))).collect();
        let mut row: Vec<f64> =
            (0..STAGES).map(|k| power(NODES[i], k + 1) / (k + 1) as f64).collect();
        solve(&mut powers, &mut row, STAGES).expect("the nodes differ");
        std::array::from_fn(|j| row[j])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lorenz, Model};

    #[test]
    fn the_last_row_integrates_polynomials_up_to_the_eighth_power() {
        for power in 0..9 {
            let sum: f64 = (0..STAGES).map(|j| WEIGHTS[STAGES - 1][j] * NODES[j].powi(power)).sum();
            assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-15, "{power}: {sum}");
        }
    }

    #[test]
    fn a_decay_is_followed_to_the_ninth_order_and_a_fast_one_leaves_nothing() {
        let of = |z: f64| propagator(&[z; STAGES], 1, 1.0).unwrap()[0];
        assert!((of(-1.0) - (-1f64).exp()).abs() < 1e-9, "{}", of(-1.0));
        let error = |z: f64| (of(z) - z.exp()).abs();
        // The error of a growth and that of a decay bend the law to either side.
        let ratio = |z: f64| error(z) / error(0.5 * z);
        let ratio = (ratio(-0.8) * ratio(0.8)).sqrt();
        assert!((900.0..1150.0).contains(&ratio), "halving divides the local error by {ratio}");
        assert!(of(-1e6).abs() < 1e-5 && of(-1e12).abs() < 1e-11);
    }

    #[test]
    fn a_step_of_tangents_is_the_derivative_of_a_step_of_the_orbit() {
        let model = Model::Lorenz(Lorenz::default());
        let (x, h, scale) = ([3.0, -2.0, 20.0], 0.03, [1.0; 3]);
        let step = |x: &[f64]| OrbitStep::from(&model, x, h, &scale).unwrap();
        let derivative = propagator(&step(&x).jacobians, 3, h).unwrap();
        for axis in 0..3 {
            let moved = |by: f64| {
                let mut x = x;
                x[axis] += by;
                step(&x).end().to_vec()
            };
            let (above, below) = (moved(1e-4), moved(-1e-4));
            for row in 0..3 {
                let difference = (above[row] - below[row]) / 2e-4;
                assert!((derivative[row * 3 + axis] - difference).abs() < 1e-7);
            }
        }
    }
}
