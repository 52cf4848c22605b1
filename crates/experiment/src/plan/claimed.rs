//! The claims of an experiment, checked before anything is computed.

use claims::{Claim, Fault};
use eigensync::Study;
use user::{Problem, Result};

use super::checker::Checker;

impl Checker<'_> {
    /// What each claim needs beside its quantity must be there, and must name what exists.
    pub(super) fn claims(&self, study: &Study) -> Result<Vec<Claim>> {
        let claims = self.experiment.claims.iter();
        claims
            .map(|(name, spec)| {
                claims::check(name, spec, study, &self.experiment.source)
                    .map_err(|fault| self.faulty(name, fault))
            })
            .collect()
    }

    fn faulty(&self, name: &str, Fault { key, message, hint }: Fault) -> Problem {
        let problem = self.problem(&format!("claims.{name}{key}"), message);
        match hint {
            Some(hint) => problem.hint(hint),
            None => problem,
        }
    }
}
