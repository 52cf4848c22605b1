//! `cargo xtask compare`: the results folder against the golden outputs.

use crate::{cargo, setup, status};

/// Options of `cargo xtask compare`.
#[derive(clap::Args)]
pub struct Args {
    /// Only these experiments (the names of their files without `.toml`)
    ids: Vec<String>,
}

/// Runs `eigensync compare` and gives its exit status.
pub fn run(args: &Args) -> Result<u8, String> {
    setup::ensure()?;
    status(
        cargo()
            .args(["run", "--release", "--quiet", "--package", "command", "--", "compare"])
            .args(&args.ids),
    )
}
