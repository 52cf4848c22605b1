//! The solvers of S, one folder or file each, and the list of them.
//!
//! A solver is its file, with a constant [`Method`] that says all there is to know of it, and its line in
//! the list here, from which the choice among solvers, files and records take it.

pub(crate) mod arpack;
pub(crate) mod chebyshev_davidson;
pub(crate) mod dense;
pub(crate) mod method;
pub(crate) mod shift_invert_lanczos;

use serde::{Deserialize, Serialize};

use crate::solvers::method::{Method, Solve};

/// The solvers as an enumeration.
macro_rules! solvers {
    ($($(#[doc = $text:literal])+ $name:ident => $method:path),+ $(,)?) => {
        /// A way to compute spectra.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        pub enum Solver {
            $($(#[doc = $text])+ $name),+
        }

        impl Solver {
            /// All of them, whether this build has them or not.
            pub const ALL: &[Self] = &[$(Self::$name),+];

            pub(crate) const fn method(self) -> &'static Method {
                match self {
                    $(Self::$name => &$method),+
                }
            }
        }
    };
}

solvers! {
    /// All modes by a dense symmetric solver: N² memory, N³ time.
    Dense => dense::METHOD,
    /// Leading modes, at most N − 1 of them, by ARPACK's implicitly restarted Lanczos method; only where
    /// the crate was built with its feature `arpack`.
    Arpack => arpack::METHOD,
    /// Leading modes by long Lanczos sequences and blocks that pass a Chebyshev filter, for any network.
    Chebyshev => chebyshev_davidson::METHOD,
    /// Leading modes by the same block method with directions (μ − S)⁻¹ u from a sparse factorisation;
    /// refused where the factor would be too large.
    ShiftInvert => shift_invert_lanczos::METHOD,
}

impl Solver {
    /// The solver that files call so, if there is one.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|solver| solver.name() == name)
    }

    /// What it is called in files.
    pub const fn name(self) -> &'static str {
        self.method().name
    }

    /// Whether this build has the solver: ARPACK's is a feature of the crate.
    pub const fn is_built(self) -> bool {
        self.method().solve.is_some()
    }

    /// Whether it finds all modes of a network where they are asked for.
    pub const fn finds_all(self) -> bool {
        self.method().finds_all
    }

    /// Whether it computes all modes from full matrices, whatever is asked for: N² memory, N³ time.
    pub const fn is_dense(self) -> bool {
        matches!(self.method().solve, Some(Solve::Dense(_)))
    }
}

#[cfg(test)]
mod tests {
    use super::Solver;

    #[test]
    fn a_solver_is_told_by_its_name_which_the_documentation_has() {
        let keys = include_str!("../../../../docs/experiments.md");
        for &solver in Solver::ALL {
            assert_eq!(Solver::named(solver.name()), Some(solver));
            assert!(keys.contains(&format!("`\"{}\"`", solver.name())), "{}", solver.name());
        }
        assert_eq!(Solver::named("auto"), None);
    }
}
