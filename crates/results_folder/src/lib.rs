//! The place of an experiment's results, `results/ID`: whose it is, where a run puts its work
//! together, and how that gets into its place.
//!
//! A run works in the hidden folder `results/.ID.unfinished`, which it locks before it computes
//! anything. Files are written into `files` in it; when all are there and flushed, `files` is renamed
//! `whole`, exchanged in one step with what is in place, and the old results are cleared away. So a
//! run that is killed, at whatever moment, leaves whole results in place, and what it has left is
//! healed by the next: `whole` is put in place or cleared away, `files` are written anew.
//!
//! Only results of the same experiment are ever replaced (`standing`). What a user put beside them,
//! or edited, comes along (`carry`).

mod carry;
mod exchange;
mod folder;
mod found;
mod leftovers;
mod lock;
mod manifest;
mod name;
mod place;
mod standing;

pub use folder::Folder;
pub use found::{Found, aside};
pub use name::id;
pub use place::Place;
pub use standing::{Head, Origin, Provenance, STANDARD_INPUT};
