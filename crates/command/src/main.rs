//! The command `eigensync`: experiment files in, results folders out.
//!
//! `cli` is the command line; `run`, `predict`, `curve` (`eigensync msf`) and `list` are commands,
//! `begun` is what those begin with that leave results, `closing` says how a run ended. `terminal` is told how the work goes on and shows it, `signals` end
//! it. Only this crate knows a terminal.

mod bar;
mod begun;
mod cli;
mod closing;
mod curve;
mod first_answer;
mod list;
mod options;
mod oscillators;
mod output;
mod predict;
mod run;
mod signals;
mod suite;
mod terminal;

use std::process::ExitCode;

use clap::Parser;

use crate::output::{complain, say};

/// The command, from the arguments of the process to its exit status.
fn main() -> ExitCode {
    // A panic is a fault of ours; said like all else, so that it cannot fail for want of a terminal.
    std::panic::set_hook(Box::new(|panic| complain!("error: a fault of eigensync: {panic}")));
    let run = |cli| signals::watch().and_then(|()| cli::run(cli));
    let status = match cli::Cli::try_parse() {
        Ok(cli) => match run(cli) {
            Ok(true) => 0,
            Ok(false) => 1,
            Err(problem) => {
                complain!("error: {problem}");
                2
            }
        },
        Err(answer) => told(&answer),
    };
    if !output::arrived() {
        complain!("error: standard output cannot be written to, and what was said on it is lost");
        return ExitCode::from(2);
    }
    ExitCode::from(status)
}

/// Help, version, or what is wrong with the command line, and the exit status.
fn told(answer: &clap::Error) -> u8 {
    let text = answer.render().to_string();
    if answer.use_stderr() {
        complain!("{}", text.trim_end());
    } else {
        say!("{}", text.trim_end());
    }
    u8::try_from(answer.exit_code()).unwrap_or(2)
}
