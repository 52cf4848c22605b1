//! What there is to a solver of S: its name, what it cannot do, and how it solves.

use graph::SymmetricForm;

use crate::completeness::Verifier;
use crate::error::SpectraError;
use crate::factorisation::symbolic::Symbolic;
use crate::found::Found;
use crate::matrix::product::Links;
use crate::plan::Plan;
use crate::progress::Progress;
use crate::vectors::random::Random;
use crate::verification::Verification;

/// A solver; each is a constant of its own file.
pub(crate) struct Method {
    /// What it is called in files, and the feature of the crate where it is one.
    pub name: &'static str,
    /// Whether it finds all N modes where they are asked for.
    pub finds_all: bool,
    /// The residual relative to max_i |w_ii| that rounding may leave for each node, whatever tolerance
    /// was asked for; 0 for a solver that goes on until the tolerance is met.
    pub rounding: f64,
    /// Whether it works on a factorisation, so that one is made even where it is dear.
    pub factorises: bool,
    /// How it solves; none where this build is without it.
    pub solve: Option<Solve>,
}

/// How a solver finds modes.
pub(crate) enum Solve {
    /// All eigenpairs of the full matrix: none can be missing. N² memory, N³ time.
    Dense(fn(&SymmetricForm<'_>, &Plan) -> Result<Found, SpectraError>),
    /// The leading modes alone, step by step, until it has made sure that none is missing.
    Iterative(fn(Task<'_>) -> Result<(Found, Verification), SpectraError>),
}

/// What an iterative solver works on.
pub(crate) struct Task<'a> {
    pub w: &'a SymmetricForm<'a>,
    pub plan: &'a Plan,
    pub links: &'a Links<'a>,
    /// The pattern of a factorisation, where one is cheap enough, or the solver asks for it and it fits
    /// the budget.
    pub symbolic: Option<&'a Symbolic<'a>>,
    /// With the bound of Gershgorin as its lowest eigenvalue, until somebody knows more.
    pub verifier: Verifier<'a>,
    pub random: Random,
    pub progress: Progress<'a>,
}
