//! The project's own tasks, one file each: `cargo xtask` lists them.
//!
//! Depends on no numerical crate, so that it starts at once on a new machine and can install what
//! the others need before they are built.

mod bench;
mod compare;
mod data;
mod dist;
mod reproduce;
mod setup;
mod test;
mod trust;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// eigensync's tasks. Each first checks that the machine has what the build needs.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Rerun the experiments, judge their claims and compare them with the golden outputs
    Reproduce(reproduce::Args),
    /// Compare the results folder with the golden outputs, without running anything
    Compare(compare::Args),
    /// Bring the connectomes that may not be redistributed into data/
    Data(data::Args),
    /// Pack the program with its manual pages and completions
    Dist(dist::Args),
    /// Run every test of the workspace
    Test(test::Args),
    /// Run the benchmarks and record them with the machine; --peers also measures other tools
    Bench(bench::Args),
    /// Disturb the command at random and see whether it keeps its promises
    Trust(trust::Args),
}

fn main() -> ExitCode {
    let outcome = match Cli::parse().task {
        Task::Reproduce(args) => reproduce::run(&args),
        Task::Compare(args) => compare::run(&args),
        Task::Data(args) => data::run(&args),
        Task::Dist(args) => dist::run(&args),
        Task::Test(args) => test::run(&args),
        Task::Bench(args) => bench::run(&args),
        Task::Trust(args) => trust::run(&args),
    };
    match outcome {
        Ok(code) => ExitCode::from(code),
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

/// Exit status when a task could not run at all; 1 means that it ran and something did not hold.
const COULD_NOT_RUN: u8 = 2;

/// A `cargo` command in the root of the workspace, with the cargo that runs us.
fn cargo() -> std::process::Command {
    let mut command = std::process::Command::new(env!("CARGO"));
    command.current_dir(root());
    // OpenBLAS threads change the low digits of a spectrum and make nothing here faster.
    command.env("OPENBLAS_NUM_THREADS", "1");
    command
}

/// Runs a command to its end and gives its exit status.
fn status(command: &mut std::process::Command) -> Result<u8, String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let status = command.status().map_err(|error| format!("cannot start {program}: {error}"))?;
    Ok(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(COULD_NOT_RUN))
}

/// The root of the workspace: the folder above this package.
fn root() -> &'static std::path::Path {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the workspace")
}
