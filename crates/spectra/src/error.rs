//! Why a spectrum could not be computed.

use thiserror::Error;

/// What went wrong on the way to a spectrum.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SpectraError {
    /// Whoever is told of progress wanted to stop.
    #[error("the search for modes was stopped before its end")]
    Cancelled,
    /// No modes were asked for.
    #[error("0 modes were asked for; a spectrum has at least one")]
    NoModes,
    /// More modes were asked for than there are.
    #[error("{requested} modes were asked for, but a network of {n_nodes} nodes has {n_nodes}")]
    TooManyModes {
        /// Modes asked for.
        requested: usize,
        /// Number of nodes N.
        n_nodes: usize,
    },
    /// No eigenvalue exceeds the cutoff.
    #[error("no eigenvalue lies above {cutoff}: the largest one of a coupling matrix is 0")]
    NothingAbove {
        /// The cutoff asked for.
        cutoff: f64,
    },
    /// More eigenvalues exceed the cutoff than may be returned.
    #[error(
        "at least {found} eigenvalues lie above {cutoff}, and at most {max_modes} modes may be \
         returned"
    )]
    TooManyAbove {
        /// The cutoff asked for.
        cutoff: f64,
        /// Eigenvalues above it, as far as known.
        found: usize,
        /// The most modes allowed.
        max_modes: usize,
    },
    /// No sparse factorisation of the matrix fits into the budget of shift-invert.
    #[error(
        "shift-invert needs a sparse factorisation, but that of this matrix of {n_nodes} nodes \
         would have more than {most} nonzeros or cost more than {most_operations:e} operations"
    )]
    FactorTooLarge {
        /// Number of nodes N.
        n_nodes: usize,
        /// The most nonzeros of a factor.
        most: usize,
        /// The most multiplications of a factorisation.
        most_operations: f64,
    },
    /// A factorisation broke down.
    #[error("the sparse factorisation of {shift} − S found a pivot that is not positive")]
    NotPositiveDefinite {
        /// The shift μ.
        shift: f64,
    },
    /// A solver was asked for in a build without it.
    #[error(
        "the solver \"{solver}\" was asked for, but this build is without it; build with the feature \
         `{solver}` of `spectra`, or leave the choice of the solver free"
    )]
    NotBuilt {
        /// Its name.
        solver: &'static str,
    },
    /// All modes were asked of a solver that cannot find the last one.
    #[error(
        "{requested} modes of a network of {n_nodes} nodes were asked of \"{solver}\", which finds at \
         most {}; use the dense solver for all", n_nodes - 1
    )]
    AllButOne {
        /// Its name.
        solver: &'static str,
        /// Modes asked for.
        requested: usize,
        /// Number of nodes N.
        n_nodes: usize,
    },
    /// More nodes or modes than ARPACK's 32-bit integers can count.
    #[error(
        "a basis of {n_basis} vectors over {n_nodes} nodes is beyond the 32-bit integers of ARPACK"
    )]
    TooLargeForArpack {
        /// Number of nodes N.
        n_nodes: usize,
        /// Size of the Krylov basis.
        n_basis: usize,
    },
    /// A tolerance that is out of reach or meaningless.
    #[error("the tolerance is {tolerance:e}, but must lie between {strictest:e} and {loosest:e}")]
    BadTolerance {
        /// The tolerance asked for.
        tolerance: f64,
        /// The smallest allowed.
        strictest: f64,
        /// The largest allowed.
        loosest: f64,
    },
    /// The matrix is not similar to a symmetric one by any scale of its nodes: eigenvalues may be
    /// complex, which no solver here finds.
    #[error(
        "the coupling matrix is neither symmetric nor similar to a symmetric matrix: row {row}, column \
         {column} has {value} and row {column}, column {row} has {transposed} (from 0), which no scale \
         of the nodes balances; its eigenvalues may be complex, and only real spectra are computed"
    )]
    NotSymmetric {
        /// Row of an entry w_ij, from 0.
        row: usize,
        /// Its column.
        column: usize,
        /// w_ij.
        value: f64,
        /// w_ji.
        transposed: f64,
    },
    /// A negative link: eigenvalue 0 need not be the largest then, which every solver here builds on.
    #[error(
        "row {row}, column {column} (from 0) of the coupling matrix is {value}; spectra are computed \
         for links that are not negative"
    )]
    NegativeLink {
        /// Row of the entry, from 0.
        row: usize,
        /// Its column.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// An entry of the coupling matrix overflowed.
    #[error("row {node} of the coupling matrix contains {value}")]
    NotFinite {
        /// Row of the entry, from 0.
        node: usize,
        /// The entry.
        value: f64,
    },
    /// The work allowed ended before all modes had converged.
    #[error(
        "{converged} of {requested} modes converged to a relative residual of {tolerance:e} in \
         {products} matrix–vector products"
    )]
    NotConverged {
        /// Modes that had converged.
        converged: usize,
        /// Modes asked for.
        requested: usize,
        /// Relative residual asked for.
        tolerance: f64,
        /// Products spent.
        products: usize,
    },
    /// As many modes converged as were asked for, but some of them may not be the leading ones.
    #[error(
        "all {requested} modes converged, but {products} matrix–vector products did not suffice \
         to show that no copy of a multiple eigenvalue is missing"
    )]
    CompletenessUnproven {
        /// Modes asked for.
        requested: usize,
        /// Products spent.
        products: usize,
    },
    /// The last eigenspace goes on beyond the modes that may be added to complete it.
    #[error(
        "mode {requested} lies in an eigenspace (λ = {eigenvalue}) that goes on beyond mode \
         {found}, and at most {max_extra} modes may be added to complete it"
    )]
    EigenspaceTooLarge {
        /// Modes asked for.
        requested: usize,
        /// Eigenvalue of the last of them.
        eigenvalue: f64,
        /// Modes found down to the part of that eigenspace that is known.
        found: usize,
        /// Modes allowed beyond those asked for.
        max_extra: usize,
    },
    /// The dense solver gave up.
    #[error("the dense eigensolver did not converge on a matrix of {n_rows} rows")]
    DenseNotConverged {
        /// Number of rows.
        n_rows: usize,
    },
    /// An ARPACK routine reported an error of its own.
    #[error("ARPACK's {routine} failed with info = {info}")]
    ArpackFailed {
        /// `dsaupd` or `dseupd`.
        routine: &'static str,
        /// Its `info` code, as in ARPACK's documentation.
        info: i32,
    },
}
