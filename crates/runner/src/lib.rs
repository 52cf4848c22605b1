//! `eigensync`: experiment files in, results folders out.
//!
//! The stages of a run stand in this order: `load` reads what the file says (`spec`), `plan` makes
//! of it what will be done, `findings` does it, `claims` judges it, `results` writes it (`record`,
//! `drawing`), `compare` holds it against the golden outputs. Only this crate knows paths, clocks
//! and terminals; it knows no numerical method.

mod cascade_files;
mod check;
mod claims;
mod cli;
mod compare;
mod computed;
mod drawing;
mod files;
mod findings;
mod hashes;
mod journal;
mod list;
mod load;
mod machine;
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
mod signals;
mod spec;
mod table;
mod trial;
mod warning;

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;

use crate::output::{say, tell};

/// The command, from the arguments of the process to its exit status.
pub fn main() -> ExitCode {
    // A panic is a fault of ours; said like all else, so that it cannot fail for want of a terminal.
    std::panic::set_hook(Box::new(|panic| tell!("error: a fault of eigensync: {panic}")));
    let run = |cli| signals::watch().and_then(|()| cli::run(cli));
    let status = match cli::Cli::try_parse() {
        Ok(cli) => match run(cli) {
            Ok(true) => 0,
            Ok(false) => 1,
            Err(problem) => {
                tell!("error: {problem}");
                2
            }
        },
        Err(answer) => told(&answer),
    };
    if !output::arrived() {
        tell!("error: standard output cannot be written to, and what was said on it is lost");
        return ExitCode::from(2);
    }
    ExitCode::from(status)
}

/// Help, version, or what is wrong with the command line, and the exit status.
fn told(answer: &clap::Error) -> u8 {
    let text = answer.render().to_string();
    if answer.use_stderr() {
        tell!("{}", text.trim_end());
    } else {
        say!("{}", text.trim_end());
    }
    u8::try_from(answer.exit_code()).unwrap_or(2)
}

/// Whether a text is an experiment file, or what is wrong with it in the words that a user sees.
/// Nothing that it names is looked for.
pub fn check_syntax(text: &str) -> Result<(), String> {
    let parsed = load::parse(text, Path::new("experiment.toml"));
    parsed.map(drop).map_err(|problem| problem.to_string())
}
