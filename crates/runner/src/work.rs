//! What the work on one experiment stands on.

use experiment::Plan;
use journal::Journal;
use user::Stages;

/// A plan, where its finished pieces are kept, and who is told of its stages.
#[derive(Clone, Copy)]
pub struct Work<'a> {
    /// What is to be done.
    pub plan: &'a Plan,
    /// What an earlier run has done of it, and where this one leaves what it does.
    pub journal: &'a Journal,
    /// The stages so far, those of planning among them.
    pub stages: &'a Stages,
}

impl Work<'_> {
    /// What the coupling matrix is known by.
    pub fn matrix(&self) -> (&str, usize, u8) {
        let Plan { links_hash, study, matrix, .. } = self.plan;
        (links_hash, study.network.n_nodes(), *matrix as u8)
    }
}
