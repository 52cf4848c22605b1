//! What a run has computed so far, kept so that it is computed once: finished replicas, the curve, the
//! spectrum, each appended to the file `journal` in the hidden folder of the run as it ends.
//!
//! Every piece goes by a key of all that it depends on (`key`), so that the next run, of the same file
//! or of one that was edited, takes over exactly what it would compute again, to the same bits. What
//! cannot be kept, as where a disk is full, costs time at the next run and nothing at this one.
//!
//! `record` is the form of the records, `log` the file, `snapshots` the states of what still runs, and `trajectory` those on the way that a user
//! asks for.

mod cache;
mod held;
mod journal;
mod key;
mod kind;
mod log;
mod record;
mod snapshots;
mod trajectory;
mod worth;

pub use cache::Cache;
pub use held::Held;
pub use journal::{Journal, is_its};
pub use key::Key;
pub use kind::Kind;
pub use trajectory::Trajectory;
pub use worth::is_worth_keeping;
