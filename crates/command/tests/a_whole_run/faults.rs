//! Kills and errors between system calls, put there by strace; skipped, and said so, without it.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::support::{TINY_FILES, Workplace};

/// Runs the tiny experiment with faults injected; its exit status, none if it was killed.
pub fn run_with(place: &Workplace, faults: &[&str]) -> Option<i32> {
    let mut command = Command::new("strace");
    command.current_dir(place.path(".")).args(["-f", "-qq", "-o", "/dev/null"]);
    let mut faults = faults.iter();
    while let Some(fault) = faults.next() {
        match (*fault, faults.clone().next()) {
            // Only of calls that name this path.
            ("-P", Some(path)) => {
                command.args(["-P", path]);
                faults.next();
            }
            _ => _ = command.args(["-e", &format!("inject={fault}")]),
        }
    }
    let eigensync = Path::new(assert_cmd::cargo::cargo_bin!("eigensync"));
    let output = command.arg(eigensync).args(["run", "tiny.toml", "--threads", "1"]).output();
    output.expect("strace can be started").status.code()
}

pub fn has_strace() -> bool {
    // It may be there and not be allowed to trace.
    let traced = Command::new("strace").args(["-qq", "-o", "/dev/null", "true"]).status();
    let has = traced.is_ok_and(|status| status.success());
    if !has {
        println!("skipped: strace is not here, or may not trace");
    }
    has
}

/// A place with older results, and a file of the user's beside them.
fn with_results() -> Workplace {
    let place = Workplace::new();
    place.answer(&["run", "tiny.toml"]).with_status(0);
    place.write("results/tiny/notes.txt", "mine");
    place
}

/// The results in place, all of one run.
#[track_caller]
fn check_whole(place: &Workplace) {
    let summary = place.json("results/tiny/summary.json");
    let Value::Object(files) = &summary["provenance"]["files"] else { panic!("no list of files") };
    let names = place.names("results/tiny");
    assert!(files.keys().all(|name| names.contains(name)), "{names:?}");
    assert_eq!(place.read("results/tiny/notes.txt"), "mine");
}

#[track_caller]
fn check_healed(place: &Workplace) {
    place.answer(&["run", "tiny.toml"]).with_status(0);
    check_whole(place);
    assert_eq!(place.names("results"), ["tiny"]);
    assert_eq!(place.names("results/tiny").len(), TINY_FILES + 1);
}

#[test]
fn a_kill_at_any_rename_or_removal_leaves_whole_results_in_place_and_heals() {
    if !has_strace() {
        return;
    }
    let place = with_results();
    let mut killed = 0;
    let calls = ["?rename,renameat2", "linkat", "?unlink,unlinkat,?rmdir"];
    for (call, moments) in calls.iter().zip([1..=3, 1..=1, 12..=24]) {
        for moment in moments.step_by(3).chain([2]) {
            let kill = format!("{call}:signal=SIGKILL:when={moment}");
            killed += usize::from(run_with(&place, &[&kill]).is_none());
            check_whole(&place);
        }
        check_healed(&place);
    }
    assert!(killed >= 5, "only {killed} runs were killed");
}

#[test]
fn without_an_exchange_in_one_step_nothing_is_lost_either() {
    if !has_strace() {
        return;
    }
    let place = with_results();
    let unknown = "renameat2:error=EINVAL";
    assert_eq!(run_with(&place, &[unknown]), Some(0));
    check_whole(&place);
    assert_eq!(place.names("results"), ["tiny"]);
    // Two of the trial, then that of the files, then two for the place.
    for moment in 3..=5 {
        let kill = format!("rename:signal=SIGKILL:when={moment}");
        assert_eq!(run_with(&place, &[unknown, &kill]), None, "killed at {moment}");
        check_healed(&place);
    }
    // An error at the last of them is undone at once.
    let older = place.read("results/tiny/summary.json");
    assert_eq!(run_with(&place, &[unknown, "rename:error=EIO:when=5"]), Some(2));
    check_whole(&place);
    assert_eq!(place.read("results/tiny/summary.json"), older);
    check_healed(&place);
}

#[test]
fn an_error_of_the_disk_is_found_before_the_run_or_leaves_older_results_in_place() {
    if !has_strace() {
        return;
    }
    let place = with_results();
    let older = place.read("results/tiny/summary.json");
    for fault in
        ["fsync:error=EIO:when=1", "fsync:error=ENOSPC:when=5", "renameat2:error=EIO:when=2"]
    {
        assert_eq!(run_with(&place, &[fault]), Some(2), "{fault}");
        check_whole(&place);
        assert_eq!(place.read("results/tiny/summary.json"), older, "{fault}");
    }
    check_healed(&place);
}
