//! Critical couplings: ε_k = σ_edge / |λ_k|, where mode k changes its stability.
//!
//! Source: Fan, Wang & Wang (2023), Sec. II, for the one edge σ_c of an unbounded stable set.

use crate::{StableRegion, Zero};

/// A coupling strength at which a transverse mode changes its stability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CriticalCoupling {
    /// Mode k, 1-based as in λ_k: 2 is the first transverse one.
    pub mode: usize,
    /// Its eigenvalue λ_k.
    pub lambda: f64,
    /// ε_k; infinite when λ_k = 0, which no coupling stabilises.
    pub epsilon: f64,
    /// Standard error of ε_k, from that of the zero of Λ.
    pub standard_error: f64,
    /// Whether the mode is damped just above ε_k (else just below).
    pub stable_above: bool,
    /// Whether the zero is known as well as was asked for: [`Zero::refined`].
    pub refined: bool,
}

/// Critical couplings of all transverse modes, mode by mode, and within a mode by ascending σ.
///
/// `eigenvalues` are λ_1 = 0 ≥ λ_2 ≥ …; the first is skipped. Eigenvalues above −`tolerance` count
/// as zero: such a mode belongs to another component of the network and never synchronises.
pub fn critical_couplings(
    stable: &StableRegion,
    eigenvalues: &[f64],
    tolerance: f64,
) -> Vec<CriticalCoupling> {
    let transverse = eigenvalues.iter().enumerate().skip(1);
    transverse
        .flat_map(|(k, &lambda)| {
            stable.zeros().map(move |zero| {
                let Zero { sigma, standard_error, falling, refined, .. } = zero;
                let per_sigma = if lambda < -tolerance { 1.0 / -lambda } else { f64::INFINITY };
                CriticalCoupling {
                    mode: k + 1,
                    lambda,
                    epsilon: sigma * per_sigma,
                    standard_error: standard_error * per_sigma,
                    stable_above: falling,
                    refined,
                }
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{End, Interval};

    #[test]
    fn couplings_are_the_edges_over_the_eigenvalues() {
        let zero = Zero { standard_error: 0.02, ..Zero::exact(8.0, true) };
        let interval = Interval { from: End::Zero(zero), to: End::Looked { sigma: 12.0 } };
        let stable = StableRegion { intervals: vec![interval] };
        let found = critical_couplings(&stable, &[0.0, 0.0, -2.0, -4.0], 1e-9);
        let epsilons: Vec<_> = found.iter().map(|c| (c.mode, c.epsilon)).collect();
        assert_eq!(epsilons, [(2, f64::INFINITY), (3, 4.0), (4, 2.0)]);
        assert_eq!(found[1].standard_error, 0.01);
        assert!(found.iter().all(|c| c.stable_above));
    }
}
