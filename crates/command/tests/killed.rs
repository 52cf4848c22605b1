//! Runs that are killed: nothing that looks finished is left, an older whole result stays as it was,
//! and running again works and cleans up.

mod support;

use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use support::{Workplace, tiny};

/// The files of a whole results folder.
const WHOLE: [&str; support::TINY_FILES] = [
    "cascade.csv",
    "cascade.nwk",
    "clusters.csv",
    "eigenvectors.csv",
    "figure.pdf",
    "figure.png",
    "figure.svg",
    "membership.csv",
    "msf.csv",
    "report.txt",
    "spectrum.csv",
    "summary.json",
    "sweep.csv",
];

/// How long a run may take to get to the moment at which it is killed.
const PATIENCE: Duration = Duration::from_secs(60);

fn start(place: &Workplace) -> Child {
    Command::new(assert_cmd::cargo::cargo_bin!("eigensync"))
        .args(["run", "tiny.toml"])
        .current_dir(place.path("."))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command can be started")
}

/// Kills a run at once when a moment has come; false if the run was over before.
fn kill_when(mut run: Child, has_come: impl Fn() -> bool) -> bool {
    let started = Instant::now();
    while !has_come() {
        assert!(started.elapsed() < PATIENCE, "the moment does not come");
        if run.try_wait().expect("the run can be watched").is_some() {
            return false;
        }
        std::thread::yield_now();
    }
    // On Unix this is SIGKILL, which no program can answer.
    run.kill().expect("the run can be killed");
    run.wait().expect("the run can be waited for").code().is_none()
}

/// The folder in which a run is put together, hidden beside the results.
const UNFINISHED: &str = "results/.tiny.unfinished";

/// Whether a file is in the folder in the making.
fn is_writing(place: &Workplace, file: &str) -> bool {
    place.path(&format!("{UNFINISHED}/files/{file}")).exists()
}

fn check_rerun(place: &Workplace) {
    place.answer(&["run", "tiny.toml"]).with_status(0);
    assert_eq!(place.names("results"), ["tiny"]);
    assert_eq!(place.names("results/tiny"), WHOLE);
}

#[test]
fn a_run_killed_while_it_computes_leaves_nothing() {
    let long = tiny().set("sweep.transient", "1e7").0;
    for milliseconds in [0, 3, 30, 300] {
        let place = Workplace::new();
        place.write("tiny.toml", &long);
        let started = Instant::now();
        let moment = Duration::from_millis(milliseconds);
        assert!(kill_when(start(&place), || started.elapsed() >= moment), "the run was over");
        assert_eq!(place.names("results/tiny"), [""; 0]);
        assert!(!place.path("results/tiny").exists());
        place.write("tiny.toml", tiny().0);
        check_rerun(&place);
    }
}

#[test]
fn a_run_killed_while_it_writes_leaves_nothing_that_looks_finished() {
    let mut interrupted = 0;
    for file in
        ["", "spectrum.csv", "msf.csv", "sweep.csv", "figure.png", "figure.svg", "summary.json"]
    {
        let place = Workplace::new();
        let has_come = || is_writing(&place, file) || place.path("results/tiny").exists();
        kill_when(start(&place), has_come);
        if place.path("results/tiny").exists() {
            // The run was faster: then its folder is whole.
            assert_eq!(place.names("results/tiny"), WHOLE, "killed at {file}");
        } else {
            interrupted += 1;
            assert!(place.path(UNFINISHED).exists(), "killed at {file}");
        }
        check_rerun(&place);
    }
    // The picture alone takes a tenth of a second, in which at least the first files are caught.
    assert!(interrupted >= 3, "only {interrupted} of 7 runs were caught while writing");
}

#[test]
fn an_older_result_stays_whole_when_a_new_run_is_killed() {
    let place = Workplace::new();
    check_rerun(&place);
    let mut interrupted = 0;
    for file in ["", "spectrum.csv", "sweep.csv"] {
        let older = place.read("results/tiny/summary.json");
        kill_when(start(&place), || is_writing(&place, file));
        assert_eq!(place.names("results/tiny"), WHOLE, "killed at {file}");
        // A run that was faster has put its own whole folder there.
        interrupted += usize::from(place.read("results/tiny/summary.json") == older);
    }
    assert!(interrupted > 0, "no run was caught while writing");
    check_rerun(&place);
}

#[test]
fn unfinished_folders_of_other_experiments_are_left_alone() {
    let place = Workplace::new();
    place.write("results/.tiny.unfinished-Ab12Cd/msf.csv", "");
    place.write("results/.tinier.unfinished-Ab12Cd/msf.csv", "");
    place.write("results/.tinier.unfinished/lock", "");
    place.write("results/.tinier.unfinished/journal", "hours of work");
    place.write("results/.git/lock", "");
    place.answer(&["run", "tiny.toml"]).with_status(0);
    let others = [".git", ".tinier.unfinished", ".tinier.unfinished-Ab12Cd"];
    assert_eq!(place.names("results"), [&others[..], &["tiny"]].concat());
    assert_eq!(place.read("results/.tinier.unfinished/journal"), "hours of work");
}

#[test]
fn what_a_dead_run_of_another_experiment_left_without_work_in_it_is_cleared_away() {
    let place = Workplace::new();
    place.write("results/.other.unfinished/lock", "");
    place.write("results/.other.unfinished/files/msf.csv", "half of it");
    place.answer(&["run", "tiny.toml"]).with_status(0);
    assert_eq!(place.names("results"), ["tiny"]);
}
