//! What the build needs beyond Rust and a C compiler, and how to get it.
//!
//! `spectra` calls ARPACK, found by pkg-config and bound by bindgen, which needs libclang together
//! with clang's own headers. What is missing is installed by the system's package manager where we
//! may; otherwise the one line to run is shown and the task stops.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// One thing the build needs: what it is for, how to see it, and Debian's packages that bring it.
struct Requirement {
    name: &'static str,
    present: fn() -> bool,
    debian: &'static [&'static str],
}

const REQUIREMENTS: [Requirement; 3] = [
    Requirement { name: "pkg-config", present: has_pkg_config, debian: &["pkg-config"] },
    Requirement {
        name: "ARPACK with BLAS and LAPACK",
        present: has_arpack,
        debian: &["libarpack2-dev", "libopenblas-dev"],
    },
    Requirement {
        name: "libclang with clang's headers",
        present: has_libclang,
        debian: &["libclang1-14", "libclang-common-14-dev"],
    },
];

/// Makes sure that the workspace can be built, installing what is missing.
///
/// # Errors
/// When something is missing and may not be installed from here: the message holds the one line to
/// run.
pub fn ensure() -> Result<(), String> {
    let missing = missing();
    if missing.is_empty() {
        return Ok(());
    }
    let names: Vec<_> = missing.iter().map(|requirement| requirement.name).collect();
    let packages: Vec<_> = missing.iter().flat_map(|r| r.debian).copied().collect();
    eprintln!("set-up: missing {}", names.join("; "));
    if !runs("apt-get", &["--version"]) {
        return Err(format!(
            "this system has no apt-get, so nothing was installed\n\nhint: install what Debian calls \
             {}, then run the same command again",
            packages.join(" ")
        ));
    }
    let prefix: &[&str] = if is_root() {
        &[]
    } else if runs("sudo", &["-n", "true"]) {
        &["sudo", "-n"]
    } else {
        return Err(format!(
            "installing needs root, and sudo asks for a password\n\nhint: run this line, then the \
             same command again\n    sudo apt-get install -y {}",
            packages.join(" ")
        ));
    };
    let install =
        [&["apt-get", "install", "-y", "--no-install-recommends"], &packages[..]].concat();
    // A fresh machine has no package lists, an old one has stale lists.
    for step in [&["apt-get", "update"][..], &install[..]] {
        let line = [prefix, step].concat();
        eprintln!("set-up: {}", line.join(" "));
        let done = Command::new(line[0])
            .args(&line[1..])
            .env("DEBIAN_FRONTEND", "noninteractive")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .status()
            .is_ok_and(|status| status.success());
        if !done {
            return Err(format!("`{}` failed; its own messages are above", line.join(" ")));
        }
    }
    match self::missing().first() {
        None => Ok(()),
        Some(still) => Err(format!("{} is still missing after the installation", still.name)),
    }
}

fn missing() -> Vec<&'static Requirement> {
    REQUIREMENTS.iter().filter(|requirement| !(requirement.present)()).collect()
}

fn has_pkg_config() -> bool {
    runs("pkg-config", &["--version"])
}

fn has_arpack() -> bool {
    runs("pkg-config", &["--exists", "arpack"])
}

/// bindgen loads libclang at run time and includes stdbool.h from clang's resource folder.
fn has_libclang() -> bool {
    if std::env::var_os("LIBCLANG_PATH").is_some() {
        return true;
    }
    let versions = fs::read_dir("/usr/lib").into_iter().flatten().flatten();
    versions.map(|entry| entry.path()).any(|llvm| {
        llvm.file_name().is_some_and(|name| name.to_string_lossy().starts_with("llvm-"))
            && holds(&llvm.join("lib"), "libclang")
            && fs::read_dir(llvm.join("lib/clang"))
                .into_iter()
                .flatten()
                .flatten()
                .any(|version| version.path().join("include/stdbool.h").exists())
    }) || (runs("clang", &["--version"]) && runs("llvm-config", &["--libdir"]))
}

/// Whether a folder holds a shared library (`NAME.so…` or `NAME-….so…`, not `NAME-cpp.so`).
fn holds(folder: &Path, library: &str) -> bool {
    fs::read_dir(folder).into_iter().flatten().flatten().any(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        name.starts_with(library)
            && !name.starts_with(&format!("{library}-cpp"))
            && name.contains(".so")
            && entry.path().exists()
    })
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

/// Whether a program is there and exits with 0.
fn runs(program: &str, args: &[&str]) -> bool {
    Command::new(program)
        .args(args)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}
