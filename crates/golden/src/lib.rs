//! A results folder against the golden outputs: which quantity, expected, obtained, allowed.
//!
//! Deterministic quantities compare tightly, statistical ones within `BANDS` standard errors. The
//! kernel's arithmetic is the same everywhere, so any difference at all is worth a line; the band
//! decides whether it is a failure.
//!
//! The band is made of the golden standard error; the obtained one widens it only as far as it is no
//! more than `GROWTH` times as large. A number that moved and whose own error is beyond that, or is
//! more than `HUGE` of it, is no number to compare: it is a failure that says so, however wide its
//! band would be. Correlations have bands of their seeds, and a least width.

mod both;
mod compare;
mod comparison;
mod rules;
mod walk;

pub use compare::{compare, golden_summary};
pub use comparison::Comparison;
pub use walk::compare_summaries;

#[cfg(test)]
mod tests;
