//! What surrounds a run fails: system calls, the disk, the streams; or another run is at work.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use super::program::Running;
use super::scene::{ID, Scene};
use super::{Trial, copy, remove};

/// A sweep of a fraction of a second.
const LENGTH: f64 = 100.0;
/// Tracing slows a run down.
const PATIENCE: Duration = Duration::from_secs(60);

/// System calls that fail or are the last of a run, and the first few hundred of each that may be.
const CALLS: [(&str, usize); 8] = [
    ("openat", 250),
    ("write", 150),
    ("fsync", 20),
    ("renameat2", 5),
    ("rename", 5),
    ("mkdir", 6),
    ("unlink,unlinkat,rmdir", 25),
    ("linkat", 2),
];
const EFFECTS: [&str; 4] = ["error=EIO", "error=ENOSPC", "error=EINVAL", "signal=SIGKILL"];

/// One system call of a run fails, or the run is killed at it.
pub fn system_calls(trial: &mut Trial) -> Result<(), String> {
    let traced = Command::new("strace").args(["-qq", "-o", "/dev/null", "true"]).status();
    if !traced.is_ok_and(|status| status.success()) {
        trial.skip("strace is not here, or may not trace");
        return Ok(());
    }
    let scene = Scene::new(&trial.program, &trial.folder, LENGTH)?;
    while trial.goes_on() {
        let folder = scene.fresh()?.to_owned();
        let (call, most) = *trial.random.of(&CALLS);
        let effect = *trial.random.of(&EFFECTS);
        let when = 1 + trial.random.below(most);
        let inject = format!("inject={call}:{effect}:when={when}");
        let trace = format!("trace={call}");
        let before = ["strace", "-f", "-qq", "-o", "/dev/null", "-e", &trace, "-e", &inject];
        let answer =
            trial.program.start(&folder, &before, &["run", "sweep.toml"])?.end(PATIENCE)?;
        let is_killed = effect.starts_with("signal") && !answer.too_long;
        // 127: the program could not be loaded.
        let civil = if is_killed { Ok(()) } else { answer.is_one_of(&[0, 2, 127]) };
        let outcome = civil
            .and_then(|()| scene.is_whole())
            .and_then(|()| scene.ends_well(&trial.program))
            .map_err(|why| format!("{inject}: {why}"));
        trial.count(outcome, &[&folder]);
    }
    Ok(())
}

/// The disk is full at some moment of a run, and has place again afterwards.
pub fn full_disk(trial: &mut Trial) -> Result<(), String> {
    let scene = Scene::new(&trial.program, &trial.folder, LENGTH)?;
    while trial.goes_on() {
        let folder = scene.fresh()?.to_owned();
        let results = scene.results();
        let aside = folder.join("aside");
        fs::rename(&results, &aside)
            .and_then(|()| fs::create_dir(&results))
            .map_err(|error| error.to_string())?;
        if !mount(&results, "size=16m") {
            trial.skip("a small file system cannot be mounted (only root may)");
            return Ok(());
        }
        let filled = copy(&aside, &results).and_then(|()| remove(&aside));
        let filled = filled.map_err(|error| error.to_string());
        let outcome = filled.and_then(|()| on_full_disk(trial, &scene, &folder));
        trial.count(outcome, &[&folder.join("sweep.toml")]);
        let _ = Command::new("umount").arg(&results).status();
    }
    Ok(())
}

fn on_full_disk(trial: &mut Trial, scene: &Scene, folder: &Path) -> Result<(), String> {
    let results = scene.results();
    let kilobytes = 4 * trial.random.below(250);
    // Whatever is free beyond this is taken.
    let filler = results.join("filler");
    let free = free_kilobytes(&results)?;
    let taken = vec![b' '; 1024 * free.saturating_sub(kilobytes)];
    fs::write(&filler, taken).map_err(|error| error.to_string())?;
    let answer = trial.program.run(folder, &["run", "sweep.toml"], PATIENCE)?;
    let outcome = answer.is_one_of(&[0, 2]).and_then(|()| scene.is_whole_but_for_a_figure());
    let _ = fs::remove_file(&filler);
    let told = |why| format!("{kilobytes} kB free: {why}");
    outcome.and_then(|()| scene.ends_well(&trial.program)).map_err(told)
}

fn mount(place: &Path, size: &str) -> bool {
    let mut command = Command::new("mount");
    command.args(["-t", "tmpfs", "-o", size, "tmpfs"]).arg(place).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

fn free_kilobytes(place: &Path) -> Result<usize, String> {
    let output = Command::new("df").args(["-k", "--output=avail"]).arg(place).output();
    let output = output.map_err(|error| format!("df cannot be started: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.lines().last().and_then(|line| line.trim().parse().ok()).ok_or("df says nothing".into())
}

/// Standard output, or standard error, or both are full.
pub fn full_streams(trial: &mut Trial) -> Result<(), String> {
    let scene = Scene::new(&trial.program, &trial.folder, LENGTH)?;
    let commands: [&[&str]; 4] =
        [&["run", "sweep.toml"], &["check", "sweep.toml"], &["list", "."], &["run", "none.toml"]];
    while trial.goes_on() {
        let folder = scene.fresh()?.to_owned();
        let arguments = *trial.random.of(&commands);
        let [out, err] = [trial.random.below(2), trial.random.below(2)];
        let full = || File::options().write(true).open("/dev/full").map_err(|e| e.to_string());
        let mut command = trial.program.command(&folder, &[], arguments);
        if out == 1 {
            command.stdout(full()?);
        }
        let said = if err == 1 { "/dev/full".into() } else { folder.with_extension("stderr") };
        let answer = Running::start(command, said)?.end(PATIENCE);
        let expected: &[i32] = if out == 1 { &[2] } else { &[0, 2] };
        let outcome = answer.and_then(|answer| answer.is_one_of(expected));
        let told = |why| format!("{arguments:?} with stdout {out}, stderr {err} full: {why}");
        trial.count(outcome.map_err(told), &[&folder]);
    }
    Ok(())
}

/// Two runs of one experiment: one of them does it, the other says so at once.
pub fn two_at_once(trial: &mut Trial) -> Result<(), String> {
    let scene = Scene::new(&trial.program, &trial.folder, LENGTH)?;
    while trial.goes_on() {
        let folder = scene.fresh()?.to_owned();
        let mut first = trial.program.start(&folder, &[], &["run", "sweep.toml"])?;
        first.lasts(scene.took.mul_f64(trial.random.fraction()))?;
        let command = trial.program.command(&folder, &[], &["run", "sweep.toml"]);
        let second = Running::start(command, folder.with_extension("second"))?.end(PATIENCE)?;
        let first = first.end(PATIENCE)?;
        let codes = [first.status.code(), second.status.code()];
        let outcome = match codes {
            // The second came after the first.
            [Some(0), Some(0)] => Ok(()),
            [Some(0), Some(2)] if second.stderr.contains("another run") => Ok(()),
            [Some(2), Some(0)] if first.stderr.contains("another run") => Ok(()),
            _ => Err(format!("exit status {codes:?}\n{}\n{}", first.stderr, second.stderr)),
        };
        let outcome = outcome.and_then(|()| match scene.results().join(ID).exists() {
            true => scene.ends_well(&trial.program),
            false => Err("no results in place".into()),
        });
        trial.count(outcome, &[&folder]);
    }
    Ok(())
}
