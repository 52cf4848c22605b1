//! What an experiment found: the study of its plan, with finished work taken from the journal.

use dynamics::DynamicsError;
use eigensync::numbers::plain;
use eigensync::{Error, Findings, Warning, curve_by, find_by};
use msf::{MasterStability, MsfError};

use crate::Work;
use crate::check;
use crate::computed::{Curves, Failure, Kept};
use crate::warning::kept;
use experiment::Plan;
use user::{Problem, Result};

/// Runs a plan: MSF, spectrum, prediction, simulation.
///
/// # Errors
/// What keeps it from being done, with the file and the way out.
pub fn find(work: &Work<'_>, curves: &mut Curves) -> Result<Findings> {
    let plan = work.plan;
    let before = [check::doubts(plan), plan.doubts.clone()].concat();
    let computing = Kept::new(work, curves);
    let mut findings =
        find_by(&plan.study, &before, &computing).map_err(|error| failed(plan, &error))?;
    if plan.study.sweep.is_none() {
        work.journal.tell_taken();
    }
    findings.warnings = findings.warnings.iter().map(kept).collect();
    Ok(findings)
}

/// Λ(σ) of a plan alone, with what must be known beside it.
///
/// # Errors
/// As [`find`].
pub fn curve(work: &Work<'_>) -> Result<(MasterStability, Vec<Warning>)> {
    let plan = work.plan;
    let mut curves = Curves::default();
    let computing = Kept::new(work, &mut curves);
    let (msf, warnings) =
        curve_by(&plan.study, &plan.doubts, &computing).map_err(|error| failed(plan, &error))?;
    work.journal.tell_taken();
    Ok((msf, warnings))
}

/// What kept a study from being finished, with the file and the way out.
fn failed(plan: &Plan, failure: &Failure) -> Problem {
    let error = match failure {
        Failure::Study(error) => error,
        Failure::States(error) => {
            let hint =
                "make room, or ask for fewer states in [sweep.series]; what was finished is kept";
            return Problem::from_error("the states on the way cannot be written", error)
                .in_file(&plan.file)
                .hint(hint);
        }
    };
    let problem = Problem::new(error.to_string()).in_file(&plan.file);
    match error {
        Error::Curve(MsfError::Dynamics(DynamicsError::Overflow { sigma })) => {
            let message = format!(
                "reaches {}, where perturbations grow beyond all numbers between two renormalisations",
                plain(*sigma)
            );
            let hint = "end the grid earlier, or shorten `msf.renormalise` and `msf.step`";
            Problem::with_key(&plan.file, "msf.sigma", message).hint(hint)
        }
        Error::Curve(MsfError::Dynamics(DynamicsError::Escaped { .. })) => problem.hint(format!(
            "either the parameters of [oscillator.{}] leave it no bounded attractor, or orbits begin outside \
             of its basin, or `msf.step` is too long for it, or `escape_radius` too small",
            plan.node.oscillator.name()
        )),
        Error::OnlyZeroModes { .. } => problem.hint(format!(
            "the network has {} components, and each brings an eigenvalue 0: ask for more modes \
             than that, or prepare the network by `largest_component`",
            plan.study.n_components
        )),
        _ => problem,
    }
}
