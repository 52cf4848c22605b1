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
mod drawing;
mod figures;
mod findings;
mod list;
mod load;
mod output;
mod overview;
mod place;
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
mod warning;

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;

use crate::output::tell;

/// The command, from the arguments of the process to its exit status.
pub fn main() -> ExitCode {
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

/// Whether a text is an experiment file, or what is wrong with it in the words that a user sees.
/// Nothing that it names is looked for.
pub fn check_syntax(text: &str) -> Result<(), String> {
    let parsed = load::parse(text, Path::new("experiment.toml"));
    parsed.map(drop).map_err(|problem| problem.to_string())
}
