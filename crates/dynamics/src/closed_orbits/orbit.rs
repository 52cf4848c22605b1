//! An orbit that closes, and Λ(σ) on it without an average:
//!
//! ```text
//! equilibrium     F(s) = 0                Λ = max Re eig(DF − σ B Dh)
//! limit cycle     s(t + T) = s(t)         Λ = log(largest |Floquet multiplier|) / T
//! cycle of a map  s(k + n) = s(k)         Λ = log(largest |eig Π (DF − σ B Dh)|) / n
//! ```
//!
//! Multipliers of limit cycles come from a mesh in time and from the same with every step in two, and so on
//! until these agree; by how much the last two differ is the error stated.

use std::sync::{Arc, OnceLock};

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::cyclic_product::log_spectral_radius;
use super::mesh::Mesh;
use crate::small_eigenvalues::eigenvalues;
use crate::{Coupling, Estimate, NodeDynamics};

/// Exponents from two meshes agree when they differ by no more, relative to 1 or themselves.
const AGREE: f64 = 1e-10;
/// How often meshes are halved.
const LEVELS: usize = 6;
/// Rounding, relative to 1 or an exponent.
const ROUNDING: f64 = 1e-13;
/// The first-order term of Λ at σ = 0 is taken from |σ B Dh| T of this size.
const NEAR_ZERO: f64 = 1e-3;

/// How an orbit closes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Closes {
    /// It stays where it is.
    AtOnce,
    /// A limit cycle.
    AfterPeriod {
        /// Its period, in model time units.
        period: f64,
    },
    /// A cycle of a map.
    AfterIterations {
        /// Its length.
        n: usize,
    },
}

/// An attracting orbit that closes.
pub struct ClosedOrbit {
    pub(super) kind: Kind,
    /// In which distances are measured, component by component.
    pub(super) scale: Vec<f64>,
}

pub(super) enum Kind {
    /// An equilibrium with DF and B Dh, each row by row.
    Equilibrium {
        state: Vec<f64>,
        df: Vec<f64>,
        dh: Vec<f64>,
    },
    LimitCycle(Box<Cycle>),
    /// States of a map, and DF and B Dh there.
    MapCycle {
        states: Vec<f64>,
        df: Vec<f64>,
        dh: Vec<f64>,
    },
}

/// A limit cycle on finer and finer meshes.
pub(super) struct Cycle {
    dynamics: Arc<dyn NodeDynamics>,
    coupling: Coupling,
    pub mesh: Mesh,
    finer: [OnceLock<Option<Mesh>>; LEVELS],
}

impl ClosedOrbit {
    /// How it closes.
    pub fn closes(&self) -> Closes {
        match &self.kind {
            Kind::Equilibrium { .. } => Closes::AtOnce,
            Kind::LimitCycle(cycle) => Closes::AfterPeriod { period: cycle.mesh.period },
            Kind::MapCycle { states, .. } => {
                Closes::AfterIterations { n: states.len() / self.scale.len() }
            }
        }
    }

    /// Λ at each σ, with the error of its computation, which is infinite where there is none.
    ///
    /// Runs on the current rayon pool.
    pub fn exponents(&self, sigmas: &[f64]) -> Vec<Estimate> {
        sigmas.par_iter().with_max_len(1).map(|&sigma| self.exponent(sigma)).collect()
    }

    /// dΛ/dσ at σ = 0 of a limit cycle, where Λ(0) = 0; none for others.
    pub fn first_order(&self) -> Option<Estimate> {
        let Kind::LimitCycle(cycle) = &self.kind else { return None };
        let size = cycle.mesh.largest_coupling();
        if size == 0.0 {
            return Some(Estimate { mean: 0.0, standard_error: 0.0 });
        }
        let sigma = NEAR_ZERO / (size * cycle.mesh.period.max(1.0));
        let slope = |sigma: f64| {
            let [above, below] = [sigma, -sigma].map(|sigma| cycle.exponent(sigma));
            let error = above.standard_error.max(below.standard_error) / sigma;
            ((above.mean - below.mean) / (2.0 * sigma), error)
        };
        let ((wide, _), (mean, error)) = (slope(sigma), slope(0.5 * sigma));
        Some(Estimate { mean, standard_error: error + (mean - wide).abs() })
    }

    fn exponent(&self, sigma: f64) -> Estimate {
        let n = self.scale.len();
        let exactly = |mean: f64| {
            let standard_error = ROUNDING * (1.0 + mean.abs());
            Estimate { mean, standard_error }
        };
        match &self.kind {
            Kind::Equilibrium { df, dh, .. } => {
                let a = DMatrix::from_row_slice(n, n, &damped(df, dh, sigma));
                let rates = eigenvalues(a).into_iter().flatten().map(|rate| rate.re);
                rates.reduce(f64::max).map_or(UNKNOWN, exactly)
            }
            Kind::LimitCycle(_) if sigma == 0.0 => Estimate::default(),
            Kind::LimitCycle(cycle) => cycle.exponent(sigma),
            Kind::MapCycle { states, df, dh } => {
                let log = log_spectral_radius(&damped(df, dh, sigma), n);
                exactly(log / (states.len() / n) as f64)
            }
        }
    }
}

const UNKNOWN: Estimate = Estimate { mean: 0.0, standard_error: f64::INFINITY };

/// DF − σ B Dh.
fn damped(df: &[f64], dh: &[f64], sigma: f64) -> Vec<f64> {
    df.iter().zip(dh).map(|(df, dh)| df - sigma * dh).collect()
}

impl Cycle {
    pub fn new(dynamics: Arc<dyn NodeDynamics>, coupling: Coupling, mesh: Mesh) -> Self {
        Self { dynamics, coupling, mesh, finer: Default::default() }
    }

    /// From the first two meshes that agree, or the last two.
    fn exponent(&self, sigma: f64) -> Estimate {
        let scale = extent(&self.mesh.states, self.mesh.start.len());
        let (mut mesh, mut best) = (&self.mesh, UNKNOWN);
        let mut coarse = mesh.exponent(sigma);
        for finer in &self.finer {
            let node = (self.dynamics.as_ref(), &self.coupling);
            let Some(halved) = finer.get_or_init(|| mesh.halved(node, &scale)) else { break };
            let fine = halved.exponent(sigma);
            if let (Some(coarse), Some(mean)) = (coarse, fine) {
                let standard_error = (coarse - mean).abs().max(ROUNDING * (1.0 + mean.abs()));
                best = Estimate { mean, standard_error };
                if standard_error <= AGREE * (1.0 + mean.abs()) {
                    break;
                }
            }
            (mesh, coarse) = (halved, fine);
        }
        best
    }
}

/// By how much each component of some states varies, and no less than a millionth of the largest.
pub(super) fn extent(states: &[f64], n: usize) -> Vec<f64> {
    let of = |c: usize| {
        let values = || states.iter().skip(c).step_by(n).copied();
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let extents: Vec<f64> = (0..n).map(of).collect();
    let largest = extents.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    extents.into_iter().map(|extent| extent.max(1e-6 * largest)).collect()
}
