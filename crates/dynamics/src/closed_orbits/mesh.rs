//! A limit cycle on a mesh in time: its initial state and period by Newton's iteration on the return after
//! a period, x(T) = x(0), with x(0) − x₀ orthogonal to the flow; each step is one of [`super::radau`].
//!
//! Source: R. Seydel, Practical Bifurcation and Stability Analysis (2010), Sec. 7.3 (single shooting).

use super::cyclic_product::log_spectral_radius;
use super::radau::{OrbitStep, propagator};
use super::solve::solve;
use crate::jacobians::Jacobians;
use crate::{Coupling, NodeDynamics};

/// A step is as long as its error, seen by halving it, allows: this, in units of the orbit's extent.
const LOCAL_ERROR: f64 = 1e-10;
/// A period has so many steps at the least.
const LEAST_STEPS: f64 = 48.0;
/// And at the most.
const MOST_STEPS: usize = 20_000;
/// Rounds of Newton's iteration, and the distance of x(T) from x(0) at which it ends.
const MOST_ROUNDS: usize = 14;
const CLOSED: f64 = 1e-11;

/// A limit cycle on a mesh.
pub(super) struct Mesh {
    /// x(0).
    pub start: Vec<f64>,
    /// T.
    pub period: f64,
    /// Steps as shares of the period.
    shares: Vec<f64>,
    /// States of the stages of all steps.
    pub states: Vec<f64>,
    /// DF and B Dh there, each row by row.
    df: Vec<f64>,
    dh: Vec<f64>,
    /// What a period makes of tangents at σ = 0, row by row.
    pub monodromy: Vec<f64>,
}

impl Mesh {
    /// The cycle near a state that nearly returns after a time, on a mesh that is as fine as the orbit
    /// wants. None where there is none.
    pub fn near(
        (dynamics, coupling): (&dyn NodeDynamics, &Coupling),
        (start, period): (&[f64], f64),
        scale: &[f64],
    ) -> Option<Self> {
        let shares = shares(dynamics, start, period, scale)?;
        Self::closing((dynamics, coupling), (start, period), shares, scale)
    }

    /// The same cycle with every step in two.
    pub fn halved(&self, node: (&dyn NodeDynamics, &Coupling), scale: &[f64]) -> Option<Self> {
        let shares = self.shares.iter().flat_map(|share| [0.5 * share; 2]).collect();
        Self::closing(node, (&self.start, self.period), shares, scale)
    }

    /// log of the largest multiplier of δ̇ = [DF − σ B Dh] δ, over the period. None where a step has no
    /// solution.
    pub fn exponent(&self, sigma: f64) -> Option<f64> {
        let n = self.start.len();
        let of_step = self.df.len() / self.shares.len();
        let mut factors = Vec::with_capacity(self.shares.len() * n * n);
        for (k, share) in self.shares.iter().enumerate() {
            let (df, dh) = (&self.df[k * of_step..][..of_step], &self.dh[k * of_step..][..of_step]);
            let a: Vec<f64> = df.iter().zip(dh).map(|(df, dh)| df - sigma * dh).collect();
            factors.extend(propagator(&a, n, share * self.period)?);
        }
        Some(log_spectral_radius(&factors, n) / self.period)
    }

    /// The largest |B Dh|.
    pub fn largest_coupling(&self) -> f64 {
        self.dh.iter().fold(0.0, |largest, x| largest.max(x.abs()))
    }

    fn closing(
        (dynamics, coupling): (&dyn NodeDynamics, &Coupling),
        (start, period): (&[f64], f64),
        shares: Vec<f64>,
        scale: &[f64],
    ) -> Option<Self> {
        let n = start.len();
        let (mut start, mut period) = (start.to_vec(), period);
        let (mut last, mut is_closed) = (f64::INFINITY, false);
        for _ in 0..MOST_ROUNDS {
            let turn = Turn::of(dynamics, (&start, period), &shares, scale)?;
            let end = turn.states[turn.states.len() - n..].to_vec();
            let off: Vec<f64> = end.iter().zip(&start).map(|(end, start)| start - end).collect();
            let distance =
                off.iter().zip(scale).map(|(off, scale)| off.abs() / scale).fold(0.0, f64::max);
            is_closed |= distance <= CLOSED;
            // Rounding ends what Newton's iteration can do.
            if is_closed && (distance >= 0.1 * last || distance < 1e-14) {
                let dh = Jacobians::of_coupling(dynamics, coupling, &turn.states);
                let Turn { states, df, monodromy } = turn;
                return Some(Self { start, period, shares, states, df, dh, monodromy });
            }
            if !(distance.is_finite() && distance < 10.0) {
                return None;
            }
            last = distance;
            let change = newton(dynamics, (&start, &end), &turn.monodromy, off, scale)?;
            start.iter_mut().zip(&change).for_each(|(x, change)| *x += change);
            period += change[n];
            if period <= 0.0 {
                return None;
            }
        }
        None
    }
}

/// The change of x(0) and T that Newton's iteration asks for, where x(0) − x(T) is `off`.
fn newton(
    dynamics: &dyn NodeDynamics,
    (start, end): (&[f64], &[f64]),
    monodromy: &[f64],
    off: Vec<f64>,
    scale: &[f64],
) -> Option<Vec<f64>> {
    let n = start.len();
    let flow = |state: &[f64]| Jacobians::of_flow(dynamics, state).flow;
    let (first, last) = (flow(start), flow(end));
    let mut matrix = vec![0.0; (n + 1) * (n + 1)];
    for row in 0..n {
        for c in 0..n {
            matrix[row * (n + 1) + c] = monodromy[row * n + c] - f64::from(u8::from(row == c));
        }
        matrix[row * (n + 1) + n] = last[row];
        matrix[n * (n + 1) + row] = first[row] / scale[row].powi(2);
    }
    let mut change = off;
    change.push(0.0);
    solve(&mut matrix, &mut change, n + 1)?;
    Some(change)
}

/// One turn of an orbit on a mesh.
struct Turn {
    states: Vec<f64>,
    df: Vec<f64>,
    monodromy: Vec<f64>,
}

impl Turn {
    fn of(
        dynamics: &dyn NodeDynamics,
        (start, period): (&[f64], f64),
        shares: &[f64],
        scale: &[f64],
    ) -> Option<Self> {
        let n = start.len();
        let identity = (0..n * n).map(|at| f64::from(u8::from(at / n == at % n)));
        let mut turn = Self { states: Vec::new(), df: Vec::new(), monodromy: identity.collect() };
        let mut x = start.to_vec();
        for share in shares {
            let h = share * period;
            let step = OrbitStep::from(dynamics, &x, h, scale)?;
            let p = propagator(&step.jacobians, n, h)?;
            let entry = |at: usize| -> f64 {
                (0..n).map(|k| p[at / n * n + k] * turn.monodromy[k * n + at % n]).sum()
            };
            turn.monodromy = (0..n * n).map(entry).collect();
            x = step.end().to_vec();
            turn.states.extend(step.stages);
            turn.df.extend(step.jacobians);
        }
        Some(turn)
    }
}

/// Steps along an orbit of some time, as shares of it.
fn shares(
    dynamics: &dyn NodeDynamics,
    start: &[f64],
    time: f64,
    scale: &[f64],
) -> Option<Vec<f64>> {
    let longest = time / LEAST_STEPS;
    let (mut x, mut at, mut h) = (start.to_vec(), 0.0, 0.1 * longest);
    let mut shares = Vec::new();
    while at < time * (1.0 - 1e-12) {
        if shares.len() >= MOST_STEPS {
            return None;
        }
        let h_now = h.min(time - at);
        let halves = |h: f64| {
            let middle = OrbitStep::from(dynamics, &x, h, scale)?;
            OrbitStep::from(dynamics, middle.end(), h, scale)
        };
        let both = OrbitStep::from(dynamics, &x, h_now, scale).zip(halves(0.5 * h_now));
        let Some((whole, halved)) = both else {
            h = 0.25 * h_now;
            if h < 1e-9 * time {
                return None;
            }
            continue;
        };
        let errors = whole.end().iter().zip(halved.end()).zip(scale);
        let error = errors.map(|((a, b), scale)| (a - b).abs() / scale).fold(0.0, f64::max);
        let next = h_now * (0.9 * (LOCAL_ERROR / error.max(1e-18)).powf(0.1)).clamp(0.2, 3.0);
        if error <= LOCAL_ERROR {
            x = halved.end().to_vec();
            at += h_now;
            shares.push(h_now / time);
        } else if h_now < 1e-9 * time {
            return None;
        }
        h = next.min(longest);
    }
    let sum: f64 = shares.iter().sum();
    Some(shares.into_iter().map(|share| share / sum).collect())
}
