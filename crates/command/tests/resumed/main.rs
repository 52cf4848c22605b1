//! Runs that are stopped and run again: nothing that was finished is computed twice, and results are
//! those of a run that nobody disturbed, to the last bit.

#[path = "../support/mod.rs"]
mod support;

mod atlas;
mod kept;
mod moments;
mod signals;

use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use support::{Toml, Workplace, tiny};

/// How long a run may take to get to the moment at which it is stopped.
const PATIENCE: Duration = Duration::from_secs(120);

/// Where the work of the tiny experiment lies while it runs.
const UNFINISHED: &str = "results/.tiny.unfinished";

/// Forty replicas of about a second together, which end in three batches on one thread.
fn forty() -> Toml {
    tiny().set("sweep.seeds", "8").set("sweep.transient", "1000.0")
}

/// A place with an experiment called `tiny`.
fn with(experiment: &Toml) -> Workplace {
    let place = Workplace::new();
    place.write("tiny.toml", &experiment.0);
    place
}

fn start(place: &Workplace, arguments: &[&str]) -> Child {
    Command::new(assert_cmd::cargo::cargo_bin!("eigensync"))
        .args(arguments)
        .current_dir(place.path("."))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command can be started")
}

/// A run that does not outlive the test.
struct Running(Option<Child>);

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(run) = &mut self.0 {
            let _ = run.kill();
            let _ = run.wait();
        }
    }
}

/// How a run that was sent a signal ended, and what it said.
struct End {
    /// None if it had ended before the signal.
    status: Option<ExitStatus>,
    stderr: String,
}

/// Sends a signal to a run when a moment has come.
fn send_when(run: Child, signal: &str, has_come: impl Fn() -> bool) -> End {
    let mut running = Running(Some(run));
    let started = Instant::now();
    let mut was_over = false;
    while !was_over && !has_come() {
        assert!(started.elapsed() < PATIENCE, "the moment does not come");
        let run = running.0.as_mut().expect("it is waited for once");
        was_over = run.try_wait().expect("the run can be watched").is_some();
        std::thread::sleep(Duration::from_micros(200));
    }
    let run = running.0.take().expect("it is waited for once");
    if !was_over {
        send(&run, signal);
    }
    let output = run.wait_with_output().expect("the run can be waited for");
    let stderr = String::from_utf8(output.stderr).expect("the command prints text");
    End { status: (!was_over).then_some(output.status), stderr }
}

fn send(run: &Child, signal: &str) {
    let sent = Command::new("kill").args([&format!("-{signal}"), &run.id().to_string()]).status();
    assert!(sent.expect("there is a command `kill`").success());
}

/// Bytes of the journal so far.
fn journal_length(place: &Workplace) -> u64 {
    let journal = place.path(&format!("{UNFINISHED}/journal"));
    std::fs::metadata(journal).map_or(0, |file| file.len())
}

/// Whether the journal holds the curve, and how many replicas: its whole records, read from the bytes
/// as `journal/record.rs` lays them out.
fn in_journal(place: &Workplace) -> (bool, usize) {
    const HEAD: usize = 8 + 1 + 32 + 8 + 8;
    let bytes = std::fs::read(place.path(&format!("{UNFINISHED}/journal"))).unwrap_or_default();
    let (mut rest, mut curve, mut replicas) = (&bytes[..], false, 0);
    while rest.len() >= HEAD {
        assert!(rest.starts_with(b"eigsync1"), "a kill tears the last record alone");
        let length = u64::from_le_bytes(rest[41..49].try_into().expect("eight bytes"));
        let whole = HEAD + usize::try_from(length).expect("a short record") + 16;
        if rest.len() < whole {
            break;
        }
        curve |= rest[8] == 3;
        replicas += usize::from(rest[8] == 5);
        rest = &rest[whole..];
    }
    (curve, replicas)
}

/// Whether the curve and the spectrum are kept, and the sweep runs.
fn is_sweeping(place: &Workplace) -> bool {
    journal_length(place) > 600
}

/// All that a results folder says, but for where it comes from.
fn numbers(place: &Workplace) -> Vec<(String, Vec<u8>)> {
    let mut summary: Value = place.json("results/tiny/summary.json");
    summary.as_object_mut().expect("a summary is an object").remove("provenance");
    let mut numbers = vec![("summary.json".to_owned(), summary.to_string().into_bytes())];
    for name in place.names("results/tiny") {
        if name != "summary.json" && name != "SHA256SUMS" {
            let path = place.path(&format!("results/tiny/{name}"));
            numbers.push((name, std::fs::read(path).expect("a result can be read")));
        }
    }
    numbers
}

/// Asserts that results are those of an undisturbed run, and that nothing else is there.
#[track_caller]
fn check_same(place: &Workplace, undisturbed: &[(String, Vec<u8>)], how: &str) {
    assert_eq!(place.names("results"), ["tiny"], "{how}");
    for ((name, found), (expected_name, expected)) in numbers(place).iter().zip(undisturbed) {
        assert_eq!(name, expected_name, "{how}");
        assert!(found == expected, "{name} is another, {how}");
    }
}

/// The results of the forty replicas, of a run that nobody disturbed.
fn undisturbed() -> Vec<(String, Vec<u8>)> {
    let place = with(&forty());
    place.answer(&["run", "tiny.toml"]).with_status(0);
    numbers(&place)
}

fn taken_over(place: &Workplace) -> Value {
    place.json("results/tiny/summary.json")["provenance"]["taken_over"].clone()
}
