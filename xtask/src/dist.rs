//! `cargo xtask dist`: what is handed to users who do not build: the program, its manual pages, the
//! completions of shells and the licences, in one archive.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{cargo, root, setup, status};

const SHELLS: [&str; 3] = ["bash", "zsh", "fish"];

/// Options of `cargo xtask dist`.
#[derive(clap::Args)]
pub struct Args {
    /// Take the program that was built without optimisation: a trial of the archive
    #[arg(long)]
    debug: bool,
}

/// Builds the program and packs `target/dist/eigensync-VERSION.tar.gz`.
pub fn run(args: &Args) -> Result<u8, String> {
    setup::ensure()?;
    let mut build = cargo();
    build.args(["build", "--package", "command"]);
    if !args.debug {
        build.arg("--release");
    }
    if status(&mut build)? != 0 {
        return Err("eigensync could not be built; cargo's own messages are above".into());
    }
    let profile = if args.debug { "debug" } else { "release" };
    let program = target().join(profile).join("eigensync");
    let name = format!("eigensync-{}", env!("CARGO_PKG_VERSION"));
    let dist = target().join("dist");
    let folder = dist.join(&name);
    let failed = |error: std::io::Error| format!("{} cannot be made: {error}", folder.display());
    match fs::remove_dir_all(&folder) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(failed(error)),
        _ => {}
    }
    fill(&folder, &program).map_err(failed)?;
    let mut pages = Command::new(&program);
    if status(pages.arg("man").arg(folder.join("man")))? != 0 {
        return Err("the manual pages could not be written".into());
    }
    let archive = dist.join(format!("{name}.tar.gz"));
    let mut tar = Command::new("tar");
    tar.arg("-czf").arg(&archive).arg("-C").arg(&dist).arg(&name);
    if status(&mut tar)? != 0 {
        return Err(format!("{} could not be packed", archive.display()));
    }
    println!("{}", archive.display());
    Ok(0)
}

/// Everything but the manual pages.
fn fill(folder: &Path, program: &Path) -> std::io::Result<()> {
    for inner in ["man", "completions"] {
        fs::create_dir_all(folder.join(inner))?;
    }
    fs::copy(program, folder.join("eigensync"))?;
    for file in ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"] {
        let from = root().join(file);
        if from.exists() {
            fs::copy(from, folder.join(file))?;
        }
    }
    for shell in SHELLS {
        let script = Command::new(program).args(["completions", shell]).output()?;
        if !script.status.success() {
            return Err(std::io::Error::other(format!("no completions for {shell}")));
        }
        fs::write(folder.join("completions").join(format!("eigensync.{shell}")), script.stdout)?;
    }
    Ok(())
}

/// Where cargo builds.
fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}
