//! Signals: answered within a second whatever is being done, with all that was computed kept.

use super::*;

/// Far more than a second, for a machine that has other work, and far less than what is broken off.
const SOON: Duration = Duration::from_secs(8);

/// A ring as an edge list.
fn ring(n_nodes: usize) -> String {
    (0..n_nodes).map(|i| format!("{i} {}\n", (i + 1) % n_nodes)).collect()
}

/// Names of the states that replicas have left.
fn states(place: &Workplace) -> Vec<String> {
    let names = place.names(UNFINISHED);
    names.into_iter().filter(|name| name.starts_with("snapshot-")).collect()
}

/// Flips a bit in the middle of a file, or cuts it short.
fn damage(file: &std::path::Path, flip: bool) {
    let mut bytes = std::fs::read(file).expect("the file can be read");
    let middle = bytes.len() / 2;
    if flip {
        bytes[middle] ^= 1;
    } else {
        bytes.truncate(bytes.len() - 1);
    }
    std::fs::write(file, bytes).expect("the file can be written");
}

/// Seconds from a signal to the end of a run, asserted to be few, and the end.
fn stop(run: Child, signal: &str, has_come: impl Fn() -> bool) -> End {
    let sent = std::cell::Cell::new(None);
    let end = send_when(run, signal, || {
        let comes = has_come();
        if comes {
            sent.set(Some(Instant::now()));
        }
        comes
    });
    let took = sent.get().expect("the run was stopped").elapsed();
    assert!(took < SOON, "{signal} took {took:?}");
    end
}

#[test]
fn a_sweep_of_hours_leaves_its_states_and_goes_on_from_them() {
    let hours = forty().set("sweep.transient", "1e8");
    let place = with(&hours);
    let run = start(&place, &["run", "tiny.toml", "--threads", "1"]);
    let begun = std::cell::Cell::new(None);
    let end = stop(run, "TERM", || {
        // The curve and the spectrum are there, and the sweep runs.
        if is_sweeping(&place) && begun.get().is_none() {
            begun.set(Some(Instant::now()));
        }
        begun.get().is_some_and(|begun: Instant| begun.elapsed() > Duration::from_millis(500))
    });
    assert_eq!(end.status.unwrap().code(), Some(143), "{}", end.stderr);
    let words =
        "stopped by SIGTERM: tiny keeps the states of 16 replicas, the curve and the spectrum: run";
    assert!(end.stderr.contains(words), "{}", end.stderr);
    let first = states(&place);
    assert!(!first.is_empty() && first.iter().all(|name| !name.ends_with(".new")), "{first:?}");
    let content = |name: &String| {
        std::fs::read(place.path(&format!("{UNFINISHED}/{name}"))).expect("it can be read")
    };
    let before = content(&first[0]);
    // It goes on from there: the state at the next stop is another.
    let run = start(&place, &["run", "tiny.toml", "--threads", "1"]);
    let started = Instant::now();
    let end = stop(run, "INT", || started.elapsed() > Duration::from_secs(1));
    assert_eq!(end.status.unwrap().code(), Some(130), "{}", end.stderr);
    assert_eq!(states(&place), first);
    assert_ne!(content(&first[0]), before);
}

#[test]
fn replicas_that_were_stopped_on_their_way_go_on_to_the_same_bits_or_begin_anew() {
    let undisturbed = undisturbed();
    let place = with(&forty());
    for (round, signal) in ["TERM", "INT", "HUP", "TERM"].into_iter().enumerate() {
        let threads = ["1", "2", "3", "2"][round];
        let run = start(&place, &["run", "tiny.toml", "--threads", threads]);
        let sent = Instant::now();
        let pause = Duration::from_millis(150 + 50 * round as u64);
        let end = send_when(run, signal, || is_sweeping(&place) && sent.elapsed() > pause);
        if end.status.is_none() {
            break;
        }
        for (number, name) in states(&place).iter().take(2).enumerate() {
            damage(&place.path(&format!("{UNFINISHED}/{name}")), number == 0);
        }
    }
    place.answer(&["run", "tiny.toml"]).with_status(0);
    check_same(&place, &undisturbed, "after four stops");
}

#[test]
fn a_dense_eigensolver_is_broken_off_at_once() {
    let dense = tiny()
        .without_table("sweep")
        .without_table("claims.integers")
        .and("[spectrum]\nmodes = \"all\"\nsolver = \"dense\"");
    let place = with(&dense);
    place.write("networks/six-node.edges", ring(3000));
    let run = start(&place, &["run", "tiny.toml"]);
    let end = stop(run, "TERM", || journal_length(&place) > 0);
    assert_eq!(end.status.unwrap().code(), Some(143), "{}", end.stderr);
    assert!(end.stderr.contains("tiny keeps the curve: run it again"), "{}", end.stderr);
    assert!(!place.path("results/tiny").exists());
}

#[test]
fn a_file_that_never_ends_is_broken_off_at_once() {
    let place = with(&tiny());
    let network = place.path("networks/six-node.edges");
    std::fs::remove_file(&network).unwrap();
    std::fs::write(&network, ring(3_000_000)).unwrap();
    let run = start(&place, &["run", "tiny.toml"]);
    let started = Instant::now();
    let end = stop(run, "INT", || started.elapsed() > Duration::from_millis(300));
    assert_eq!(end.status.unwrap().code(), Some(130), "{}", end.stderr);
    assert!(end.stderr.contains("stopped by SIGINT"), "{}", end.stderr);
}

#[test]
fn a_signal_that_was_ignored_from_the_start_stays_ignored() {
    let place = with(&tiny());
    let ignoring = format!(
        "trap '' HUP; {} run tiny.toml & pid=$!; kill -HUP $pid; sleep 0.05; kill -HUP $pid; wait $pid",
        assert_cmd::cargo::cargo_bin!("eigensync").display()
    );
    let status = Command::new("sh")
        .args(["-c", &ignoring])
        .current_dir(place.path("."))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .expect("there is a shell");
    assert_eq!(status.code(), Some(0));
    assert!(place.path("results/tiny/summary.json").exists());
}
