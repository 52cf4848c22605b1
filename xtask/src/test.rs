//! `cargo xtask test`: every test of the workspace, after the set-up check.

use crate::{cargo, setup, status};

/// Options of `cargo xtask test`.
#[derive(clap::Args)]
pub struct Args {
    /// Also run the long tests (minutes; sets EIGENSYNC_LONG_TESTS=1)
    #[arg(long)]
    long: bool,
    /// Passed on to `cargo test`, such as a part of a test's name
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    rest: Vec<String>,
}

/// Runs `cargo test` on the whole workspace and gives its exit status.
pub fn run(args: &Args) -> Result<u8, String> {
    setup::ensure()?;
    let mut command = cargo();
    command.args(["test", "--workspace", "--quiet"]).args(&args.rest);
    if args.long {
        command.env("EIGENSYNC_LONG_TESTS", "1");
    }
    status(&mut command)
}
