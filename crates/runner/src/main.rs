//! `eigensync`: experiment files in, results folders out.
//!
//! The stages of a run stand in this order: `load` reads what the file says (`spec`), `plan` makes
//! of it what will be done, `findings` does it, `claims` judges it, `results` writes it (`record`,
//! `drawing`), `compare` holds it against the golden outputs. Only this crate knows paths, clocks
//! and terminals; it knows no numerical method.

mod agreement;
mod cascade_files;
mod check;
mod claims;
mod cli;
mod compare;
mod doubts;
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
mod step_effect;
mod table;
mod warning;

use std::process::ExitCode;

use clap::Parser;

use crate::output::tell;

fn main() -> ExitCode {
    let status = match cli::run(cli::Cli::parse()) {
        Ok(true) => 0,
        Ok(false) => 1,
        Err(problem) => {
            tell!("error: {problem}");
            2
        }
    };
    if !output::arrived() {
        tell!("error: standard output cannot be written to, and what was said on it is lost");
        return ExitCode::from(2);
    }
    ExitCode::from(status)
}
