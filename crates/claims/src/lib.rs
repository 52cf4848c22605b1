//! Claims: what a source says, what was found, and the verdict.
//!
//! A claim is written as a [`ClaimSpec`] about one of the [`QUANTITIES`], [`check`](fn@check)ed against the study
//! into a [`Claim`] before anything is computed, and [`judge`](fn@judge)d by the findings into a [`Judged`]. All
//! that there is to a quantity stands in its entry of [`QUANTITIES`]: its name and meaning, what singles
//! out one instance of it, what it follows from, and how it is obtained.

mod answer;
mod at;
mod check;
mod claim;
mod found;
mod judge;
mod judged;
mod name;
mod number;
mod order;
mod quantities;
mod quantity;
mod spec;
mod trend;

pub use answer::Answer;
pub use at::At;
pub use check::{Fault, check};
pub use claim::{Claim, Stated};
pub use found::Found;
pub use judge::judge;
pub use judged::{Judged, Runs, Verdict};
pub use name::{Name, labelled};
pub use number::Number;
pub use quantities::{Of, QUANTITIES};
pub use quantity::{Clusters, ClustersAt, From, LostBetween, Obtained, Quantity, Use, Uses};
pub use spec::{ClaimSpec, OneOrMany, Where};
pub use trend::Trend;
