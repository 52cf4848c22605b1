//! `eigensync`: experiment files in, results folders out.
//!
//! The stages of a run stand in this order: `load` reads what the file says (`spec`), `plan` makes
//! of it what will be done, `findings` does it, `claims` judges it, `results` writes it (`record`,
//! `drawing`), `compare` holds it against the golden outputs. Only this crate knows paths, clocks
//! and terminals; it knows no numerical method.

mod agreement;
mod check;
mod claims;
mod cli;
mod compare;
mod drawing;
mod figures;
mod findings;
mod load;
mod output;
mod overview;
mod plan;
mod predict;
mod problem;
mod progress;
mod provenance;
mod record;
mod results;
mod simulated;
mod spec;
mod table;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    match cli::run(cli::Cli::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::from(2)
        }
    }
}
