//! Who watches a study: told of its stages, its progress and its warnings, and free to stop it.

use dynamics::{Record, Replica};

use crate::Warning;

/// Told of a study as it goes on. Every method does nothing by default.
pub trait Observer: Sync {
    /// A stage begins; it has about so many steps, where that is known.
    fn begins(&self, stage: &str, n_steps: Option<u64>) {
        let _ = (stage, n_steps);
    }

    /// Steps of this stage were done; from any thread.
    fn advanced(&self, n_steps: u64) {
        let _ = n_steps;
    }

    /// A warning came up.
    fn warned(&self, warning: &Warning) {
        let _ = warning;
    }

    /// The next states of a replica, where the sweep asks for a [`dynamics::Series`]: those of one
    /// replica in their order, from any thread.
    fn recorded(&self, replica: Replica, record: &Record<'_>) {
        let _ = (replica, record);
    }

    /// Whether to stop: asked at every step that is told, at every matrix–vector product of an
    /// iterative eigensolver, and between stages. The dense eigensolver is not stopped on the way, nor
    /// is a factorisation: of all modes the first takes a second at 1000 nodes and half a minute at
    /// 5000, and the second is half a minute at the most.
    fn wants_to_stop(&self) -> bool {
        false
    }
}

/// Nobody watches.
impl Observer for () {}
