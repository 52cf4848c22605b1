//! What is asked for.

/// Up to this many nodes [`SolverChoice::Auto`] is dense when more than a twentieth of all modes, or
/// all above a cutoff, are asked for: 2 s and 32 MB a matrix at this size.
pub const DENSE_NODES: usize = 2000;
/// Up to this many nodes it is ARPACK that finds a few modes of a network without small separators.
pub const ARPACK_NODES: usize = 5000;

/// How many modes, counted from the largest eigenvalue down.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub enum Modes {
    /// All N.
    All,
    /// At least this many; more where the last eigenspace would be cut.
    Leading(usize),
    /// All with λ_k > cutoff, a negative number, and at most [`Request::max_modes`]. An eigenvalue
    /// within [`crate::Spectrum::tolerance`] of the cutoff counts as equal to it, and so is left out
    /// unless it belongs to an eigenspace that begins above.
    Above(f64),
}

/// Which solver may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub enum SolverChoice {
    /// Dense for few nodes (see [`DENSE_NODES`]) or when more than half of all modes are asked for;
    /// otherwise shift-invert where a sparse factorisation is cheap; elsewhere ARPACK up to
    /// [`ARPACK_NODES`], and Chebyshev filters beyond.
    Auto,
    /// The dense solver: N² memory, N³ time.
    Dense,
    /// ARPACK: at most N − 1 modes; only where the crate was built with its feature `arpack`.
    Arpack,
    /// Long Lanczos sequences, and blocks with Chebyshev filters, for any network.
    Chebyshev,
    /// The block method on a factorised μ − S; refused where the factor would be too large.
    ShiftInvert,
}

impl SolverChoice {
    /// Whether this build has the solver: ARPACK's is a feature of the crate.
    pub const fn is_built(self) -> bool {
        !matches!(self, Self::Arpack) || cfg!(feature = "arpack")
    }
}

/// A request for the leading modes of a coupling matrix.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Request {
    /// How many modes.
    pub modes: Modes,
    /// By which solver.
    pub solver: SolverChoice,
    /// Largest residual ‖S u − λ u‖ of a converged mode, relative to max_i |w_ii|; from 1e-13 to
    /// 1e-3. The dense solver is as accurate as it is, whatever the tolerance.
    pub tolerance: f64,
    /// Most matrix–vector products an iterative solver may spend; ARPACK gives up when the next
    /// restart might need more. A Rayleigh–Ritz step on what ARPACK found comes on top, with one
    /// product a mode.
    pub max_products: usize,
    /// Most modes an iterative solver may add beyond [`Modes::Leading`] to complete the last
    /// eigenspace.
    pub max_extra: usize,
    /// Most modes that [`Modes::Above`] may return.
    pub max_modes: usize,
    /// Seed of the random vectors.
    pub seed: u64,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            modes: Modes::All,
            solver: SolverChoice::Auto,
            tolerance: 1e-12,
            max_products: 200_000,
            max_extra: 100,
            max_modes: 1000,
            seed: 1,
        }
    }
}
