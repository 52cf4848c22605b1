//! From a plan to its results folder: [`findings`] has the library do what is planned ([`computed`] what
//! takes long, unless an earlier run has left it in the journal), [`claims`] judges, [`results`] writes
//! ([`record`] the numbers, `report` the words), and [`run`](fn@run) is all of it for one experiment. [`check`]
//! says beforehand what a plan will do and cost. [`atlas`] does the same for an atlas.
//!
//! Nothing here speaks to a terminal: whoever runs an experiment brings a [`user::Watch`].

pub mod atlas;
mod cascade_files;
pub mod check;
pub mod computed;
pub mod findings;
pub mod json;
mod membership;
mod orbits;
pub mod overview;
pub mod program;
pub mod provenance;
pub mod record;
mod report;
pub mod results;
mod run;
pub mod table;
mod trial;
pub mod warning;
mod work;

pub use report::REPORT;
pub use run::{Done, Plans, plans, run};
pub use work::Work;
