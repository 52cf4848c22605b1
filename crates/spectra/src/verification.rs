//! How it is known that a spectrum is whole above its last eigenvalue.

/// How it was made sure that no eigenvalue above those returned is missing.
///
/// "Above" means above the last eigenvalue of the spectrum, copies of it included, or above the
/// cutoff where one was asked for.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Verification {
    /// All eigenvalues were computed.
    Dense,
    /// A sparse factorisation S − c·1 = L D Lᵀ just below the last eigenvalue returned, or at the
    /// cutoff, has as many positive pivots as there are modes (Sylvester's law of inertia); its
    /// rounding errors, bounded after the fact, move no eigenvalue across c.
    Inertia {
        /// Eigenvalues above c, all of them returned.
        count: usize,
    },
    /// Random vectors, filtered on the complement of the modes, showed nothing above.
    Probed {
        /// How many vectors.
        probes: usize,
        /// 1 less a bound on the probability that these vectors miss an eigenvalue that is there.
        confidence: f64,
    },
}
