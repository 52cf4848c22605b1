//! An atlas from its plan to its results folder: `curves` computes Λ(σ) of every pair, `published` holds
//! the stable windows against what others have found, `files` writes, and [`words`] say what will be done
//! and what was found.

mod curves;
mod files;
mod found;
mod published;
pub mod words;

use std::time::Instant;

use claims::Judged;
use experiment::AtlasPlan;
use journal::Journal;
use results_folder::Place;
use serde_json::Value;
use user::{Result, Stages};

use crate::Done;
use files::Written;
use found::Found;

/// Makes an atlas, and puts its results in their place.
///
/// # Errors
/// What kept it from being finished, with what is kept of it.
pub fn run(
    (plan, journal, stages): (&AtlasPlan, &Journal, &Stages),
    place: Place,
    golden: Option<&Value>,
) -> Result<Done> {
    let started = Instant::now();
    let planned = stages.total();
    let took = || planned + started.elapsed();
    let mut place = Some(place);
    let is_quick = plan.shortened > 1.0;
    let (curves, claims, written) = journal.until(|| {
        let curves = curves::find(plan, journal, stages)?;
        let of_pair = plan.pairs().zip(&curves);
        let claims: Vec<Judged> = of_pair
            .filter_map(|((system, pair), curve)| {
                published::judged((plan, system, pair), curve, is_quick)
            })
            .collect();
        let place = place.take().expect("results are written once");
        let found = Found { plan, curves: &curves, claims: &claims };
        let written = files::write(&found, (journal, stages), golden, &took, place)?;
        Ok((curves, claims, written))
    })?;
    let Written { place, comparison } = written;
    let said = words::classes(plan, &curves);
    Ok(Done { place, said, noted: None, claims, comparison, took: took() })
}
