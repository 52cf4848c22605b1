//! `cargo xtask reproduce`.

/// Options.
#[derive(clap::Args)]
pub struct Args {}

/// Runs.
pub fn run(_args: &Args) -> Result<u8, String> {
    crate::setup::ensure()?;
    Ok(0)
}
