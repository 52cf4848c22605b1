//! Places that are not as a run expects them: what cannot be read, moved or told apart, what is taken
//! away while it runs, and what a kill between two renames leaves.

use std::fs::{self, Permissions};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::faults::{has_strace, run_with};
use crate::place::{run, run_as_a_user};
use crate::support::{Answer, TINY_FILES, Workplace, tiny};

/// What is mounted, for as long as this lives.
struct Mounted(PathBuf);

impl Mounted {
    /// None where this is not allowed.
    fn at(place: PathBuf, arguments: &[&str]) -> Option<Self> {
        let mut command = Command::new("mount");
        let done = command.args(arguments).arg(&place).stderr(Stdio::null()).status();
        done.is_ok_and(|status| status.success()).then_some(Self(place))
    }
}

impl Drop for Mounted {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

#[track_caller]
fn refused(place: &Workplace, arguments: &[&str], expected: &[&str]) -> Answer {
    let answer = place.answer(arguments).with_status(2);
    for expected in expected {
        assert!(answer.stderr.contains(expected), "{expected} in:\n{}", answer.stderr);
    }
    answer
}

fn with_results() -> Workplace {
    let place = Workplace::new();
    run(&place, &tiny(), &[]);
    place
}

#[test]
fn a_file_of_ours_that_cannot_be_read_is_no_edit() {
    if !has_strace() {
        return;
    }
    let place = with_results();
    let whole = "results/.tiny.unfinished/whole/sweep.csv";
    let faults = ["openat:error=EIO", "-P", whole, "-P", "results/tiny/sweep.csv"];
    // The new results are in place, and the older ones wait for someone who can read them.
    assert_eq!(run_with(&place, &faults), Some(0));
    assert!(place.path(whole).exists());
    assert!(!place.names("results/tiny").iter().any(|name| name.contains("kept")));
    let said = run(&place, &tiny(), &[]);
    assert!(!said.contains("kept"), "{said}");
    assert_eq!(place.names("results"), ["tiny"]);
    assert_eq!(place.names("results/tiny").len(), TINY_FILES);
}

#[test]
fn a_file_of_ours_that_may_not_be_read_is_refused_before_the_run() {
    let place = with_results();
    let owned = Command::new("chown").args(["-R", "65534"]).arg(place.path(".")).status();
    let sweep = place.path("results/tiny/sweep.csv");
    fs::set_permissions(&sweep, Permissions::from_mode(0o000)).unwrap();
    let Some((status, said)) = run_as_a_user(&place).filter(|_| owned.is_ok()) else {
        println!("skipped: no program can be run as another user here");
        return;
    };
    assert!(said.contains("sweep.csv: cannot be told from an edited file"), "{said}");
    assert_eq!((status, place.names("results")), (Some(2), vec!["tiny".to_owned()]));
    // A file of the user's own is not read, and comes along.
    fs::set_permissions(&sweep, Permissions::from_mode(0o644)).unwrap();
    fs::rename(&sweep, place.path("results/tiny/mine.csv")).unwrap();
    place.write("results/tiny/drafts/sweep.csv", "years of work");
    Command::new("chown").args(["-R", "65534"]).arg(place.path("results")).status().unwrap();
    for mine in ["mine.csv", "drafts/sweep.csv"] {
        let path = place.path("results/tiny").join(mine);
        fs::set_permissions(path, Permissions::from_mode(0o000)).unwrap();
    }
    let (status, said) = run_as_a_user(&place).unwrap();
    assert_eq!(status, Some(0), "{said}");
    assert!(place.path("results/tiny/mine.csv").exists() && !said.contains("kept"), "{said}");
}

#[test]
fn a_folder_in_the_way_is_kept_once_under_one_name() {
    let place = with_results();
    fs::remove_file(place.path("results/tiny/msf.csv")).unwrap();
    place.write("results/tiny/msf.csv/deep/one.tex", "years of work");
    place.write("results/tiny/msf.csv/two.tex", "more");
    // Its name would be taken by the edited file, were that to come first.
    place.write("results/tiny/sweep.kept.csv", "mine");
    place.write("results/tiny/sweep.csv", "edited");
    for _ in 0..3 {
        run(&place, &tiny(), &[]);
        let kept: Vec<String> =
            place.names("results/tiny").into_iter().filter(|n| n.contains("kept")).collect();
        assert_eq!(kept, ["msf.kept.csv", "sweep.kept-2.csv", "sweep.kept.csv"]);
        assert_eq!(place.read("results/tiny/msf.kept.csv/deep/one.tex"), "years of work");
        assert_eq!(place.read("results/tiny/msf.kept.csv/two.tex"), "more");
        assert_eq!(place.read("results/tiny/sweep.kept.csv"), "mine");
        assert_eq!(place.read("results/tiny/sweep.kept-2.csv"), "edited");
        assert_eq!(place.names("results"), ["tiny"]);
    }
}

#[test]
fn a_folder_called_journal_is_not_ours_and_stays() {
    let place = Workplace::new();
    place.write("results/.tiny.unfinished/lock", "");
    place.write("results/.tiny.unfinished/journal/one.tex", "years of work");
    for arguments in [&["run", "tiny.toml"][..], &["run", "tiny.toml", "--fresh"]] {
        refused(&place, arguments, &["the journal cannot be opened", "move the folder away"]);
        assert_eq!(place.read("results/.tiny.unfinished/journal/one.tex"), "years of work");
    }
}

#[test]
fn a_lock_that_is_no_file_of_its_own_is_refused_and_not_written_to() {
    let place = Workplace::new();
    place.write("precious", "years of work");
    place.write("results/.tiny.unfinished/files/half", "");
    let (lock, precious) = (place.path("results/.tiny.unfinished/lock"), place.path("precious"));
    let fifo = |path: &Path| assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    let makes: [&dyn Fn(); 4] = [
        &|| symlink(&precious, &lock).unwrap(),
        &|| symlink("nowhere", &lock).unwrap(),
        &|| fs::hard_link(&precious, &lock).unwrap(),
        &|| fifo(&lock),
    ];
    for make in makes {
        make();
        refused(
            &place,
            &["run", "tiny.toml"],
            &["lock: is ", "no plain file of its own", "move it away"],
        );
        // Neither does it keep others waiting.
        assert!(place.answer(&["list", "."]).with_status(0).stdout.contains("tiny.toml"));
        assert_eq!(place.read("precious"), "years of work");
        fs::remove_file(&lock).unwrap();
    }
    run(&place, &tiny(), &[]);
    assert_eq!(place.names("results"), ["tiny"]);
}

#[test]
fn what_is_mounted_at_or_in_the_results_is_refused_before_the_run() {
    let place = with_results();
    place.write("results/tiny/drafts/sub/one.tex", "years of work");
    place.write("results/tiny/notes.txt", "mine");
    place.write("elsewhere/two.tex", "more");
    let elsewhere = place.path("elsewhere").display().to_string();
    let file = place.path("elsewhere/two.tex").display().to_string();
    let cases: [(&str, &[&str]); 5] = [
        ("results/tiny", &["-t", "tmpfs", "tmpfs"]),
        ("results/tiny", &["--bind", &elsewhere]),
        ("results/tiny/drafts/sub", &["-t", "tmpfs", "tmpfs"]),
        ("results/tiny/drafts", &["--bind", &elsewhere]),
        ("results/tiny/notes.txt", &["--bind", &file]),
    ];
    // It would take hours.
    place.write("tiny.toml", tiny().set("sweep.transient", "1e9").0);
    for (at, how) in cases {
        let Some(_mounted) = Mounted::at(place.path(at), how) else {
            println!("skipped: nothing can be mounted here");
            return;
        };
        refused(
            &place,
            &["run", "tiny.toml"],
            &[&format!("{at}: "), "a file system is mounted there"],
        );
    }
    assert_eq!(place.names("results"), ["tiny"]);
    run(&place, &tiny(), &[]);
    assert_eq!(place.read("results/tiny/drafts/sub/one.tex"), "years of work");
    assert_eq!(place.read("results/tiny/notes.txt"), "mine");
}

#[test]
fn results_that_are_taken_away_while_a_run_computes_are_made_again() {
    let place = with_results();
    place.write("tiny.toml", tiny().set("sweep.transient", "8000").0);
    let child = Command::new(assert_cmd::cargo::cargo_bin!("eigensync"))
        .args(["run", "tiny.toml"])
        .current_dir(place.path("."))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let started = Instant::now();
    while !place.path("results/.tiny.unfinished/journal").exists() {
        assert!(started.elapsed() < Duration::from_secs(60), "the moment does not come");
        std::thread::sleep(Duration::from_millis(1));
    }
    fs::remove_dir_all(place.path("results")).unwrap();
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert_eq!(place.names("results"), ["tiny"], "{said}");
    assert_eq!(place.names("results/tiny").len(), TINY_FILES, "{said}");
}

#[test]
fn older_results_that_a_kill_left_between_two_renames_are_listed_compared_and_put_back() {
    let place = with_results();
    place.write("results/tiny/notes.txt", "mine");
    fs::create_dir_all(place.path("golden/tiny")).unwrap();
    fs::copy(place.path("results/tiny/summary.json"), place.path("golden/tiny/summary.json"))
        .unwrap();
    for name in ["replaced", "whole"] {
        place.write("results/.tiny.unfinished/lock", "");
        let aside = place.path("results/.tiny.unfinished").join(name);
        fs::rename(place.path("results/tiny"), aside).unwrap();
        let listed = place.answer(&["list", "."]).with_status(0).stdout;
        let expected = format!("[whole results in results/.tiny.unfinished/{name}: run it again");
        assert!(listed.contains(&expected), "{listed}");
        let compared = place.answer(&["compare", "--golden", "golden"]).with_status(0);
        assert!(compared.stderr.contains(&format!("unfinished/{name}")), "{}", compared.stderr);
        // Even a run that fails puts them back.
        place.write("tiny.toml", tiny().set("oscillator.lorenz.r", "1e6").without_table("sweep").0);
        place.answer(&["run", "tiny.toml"]).with_status(2);
        assert_eq!(place.read("results/tiny/notes.txt"), "mine");
        assert_eq!(place.names("results"), ["tiny"]);
        run(&place, &tiny(), &[]);
        assert_eq!(place.read("results/tiny/notes.txt"), "mine");
    }
}

#[test]
fn a_stream_that_was_closed_is_as_one_that_nobody_reads() {
    // As git and cargo have it. Above all no file that the run opens is taken for the stream.
    let place = Workplace::new();
    let program = assert_cmd::cargo::cargo_bin!("eigensync").display().to_string();
    for script in ["run tiny.toml >&- 2>&-", "list . >&-", "run tiny.toml <&- >&- 2>&-"] {
        let mut command = Command::new("sh");
        command.args(["-c", &format!("{program} {script}")]).current_dir(place.path("."));
        assert_eq!(command.output().unwrap().status.code(), Some(0), "{script}");
    }
    place.json("results/tiny/summary.json");
    assert_eq!(place.names("results/tiny").len(), TINY_FILES);
}
