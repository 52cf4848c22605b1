//! Whole runs through the command: exit status, the files of the results folder, sameness of results,
//! comparison with golden outputs, and networks that make trouble.

mod atlas;
mod cascade;
mod comparison;
mod curve;
mod documents;
mod drawn;
mod ending;
mod faults;
mod figures;
mod honest;
mod hostile;
mod judged;
mod odd_networks;
mod own;
mod place;
mod predict;
mod results;
mod series;
mod stability;
#[path = "../support/mod.rs"]
mod support;
mod trouble;

use support::{Answer, Toml, Workplace};

/// Runs an experiment in a fresh folder.
#[track_caller]
fn run(experiment: &Toml, network: &str, status: i32) -> (Workplace, Answer) {
    let place = Workplace::new();
    place.write("tiny.toml", &experiment.0);
    place.write("networks/six-node.edges", network);
    let answer = place.answer(&["run", "tiny.toml"]).with_status(status);
    (place, answer)
}
