//! Modes beyond those claimed that make the randomised test cheaper.

use crate::completeness::claim::Claim;

/// By how much δ exceeds the least that it may be.
const STRICTLY: f64 = 1.01;

/// The largest residual of a guard, as a share of its distance to the limit.
const CONVERGED: f64 = 0.4;

/// Approximate eigenvectors below the modes that probes need not see: the gap that decides how long
/// probing takes is then that to the eigenvalues behind them.
///
/// Let G be modes and guards, Θ their Ritz values, R = S G − G Θ, which is orthogonal to G, and B the
/// rest of S, (1 − G Gᵀ) S (1 − G Gᵀ). If all eigenvalues of B lie below Λ − δ, S − Λ has as many
/// that are not negative as its Schur complement Θ − Λ + Rᵀ (Λ − B)⁻¹ R (Haynsworth, Linear Algebra
/// Appl. 1, 73 (1968)), whose last term is at most Rᵀ R / δ. On the guards, with Ritz values θ and
/// residuals r, it is negative where Σ ‖r‖² / (Λ − θ) < δ, the trace of a product that must have a norm
/// below 1. Then S has no more eigenvalues from Λ on than there are modes.
pub(crate) struct Guards {
    pub count: usize,
    /// δ.
    pub perturbation: f64,
    /// The largest eigenvalue expected behind the guards.
    pub next: f64,
}

impl Guards {
    /// None at all.
    pub fn none(claim: &Claim) -> Self {
        Self { count: 0, perturbation: 0.0, next: claim.next }
    }

    /// As many as leave the widest gap, of those that have converged well enough.
    pub fn new(claim: &Claim, limit: f64) -> Self {
        let mut best = Self::none(claim);
        let mut sum = 0.0;
        for (k, &(theta, residual)) in claim.beyond.iter().enumerate() {
            if residual > CONVERGED * (limit - theta) {
                break;
            }
            sum += residual * residual / (limit - theta);
            // A Ritz value that has hardly converged says little of what lies behind it.
            let behind = |&(next, residual): &(f64, f64)| f64::min(next + residual, theta);
            let next = claim.beyond.get(k + 1).map_or(theta, behind);
            let guards = Self { count: k + 1, perturbation: STRICTLY * sum, next };
            if guards.gap(limit) > best.gap(limit) {
                best = guards;
            }
        }
        best
    }

    fn gap(&self, limit: f64) -> f64 {
        limit - self.perturbation - self.next
    }
}
