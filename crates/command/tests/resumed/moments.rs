//! Stopped at moments of every stage.

use super::*;

/// Stops a run by each signal in turn, at moments that follow one another, and finishes it each time.
/// Says how many runs were caught.
fn check_moments(moments: impl Iterator<Item = Moment>) -> usize {
    let undisturbed = undisturbed();
    let mut caught = 0;
    for (moment, signal) in moments.zip(["KILL", "TERM", "INT", "HUP"].into_iter().cycle()) {
        let how = format!("{signal} at {moment:?}");
        let place = with(&tiny());
        place.answer(&["run", "tiny.toml"]).with_status(0);
        let older = place.read("results/tiny/summary.json");
        place.write("tiny.toml", forty().0);
        let started = Instant::now();
        let run = start(&place, &["run", "tiny.toml", "--threads", "1"]);
        let end = send_when(run, signal, || moment.has_come(&place, started));
        let kept = journal_length(&place);
        let (curve, replicas) = in_journal(&place);
        // The older results are in place, or the new ones are.
        let is_done = place.read("results/tiny/summary.json") != older;
        if is_done {
            assert!(numbers(&place) == undisturbed, "{how}");
        }
        if let Some(status) = end.status {
            caught += 1;
            let expected = match signal {
                "KILL" => None,
                "TERM" => Some(143),
                "INT" => Some(130),
                _ => Some(129),
            };
            // One that has just put its results in place may end as if nothing had happened, and one
            // that has just been started is ended by the system.
            let is_early = status.code().is_none() && kept == 0;
            assert!(
                status.code() == expected || is_early || is_done,
                "{how}: {status}\n{}",
                end.stderr
            );
            if signal != "KILL" && status.code() == expected {
                assert!(end.stderr.contains("stopped by SIG"), "{how}: {}", end.stderr);
            }
        }
        place.answer(&["run", "tiny.toml", "--threads", "2"]).with_status(0);
        check_same(&place, &undisturbed, &how);
        // Whatever was finished is not computed again.
        let taken = taken_over(&place);
        assert_eq!(
            (&taken["curve"], &taken["replicas"]),
            (&json!(curve), &json!(replicas)),
            "{how}"
        );
    }
    caught
}

#[derive(Debug)]
enum Moment {
    After(Duration),
    /// The journal is so long.
    Journal(u64),
    /// This file of the results has been begun.
    Writing(&'static str),
}

impl Moment {
    fn has_come(&self, place: &Workplace, started: Instant) -> bool {
        match self {
            Self::After(time) => started.elapsed() >= *time,
            Self::Journal(bytes) => journal_length(place) >= *bytes,
            Self::Writing(file) => place.path(&format!("{UNFINISHED}/files/{file}")).exists(),
        }
    }
}

#[test]
fn a_run_stopped_at_any_moment_goes_on_to_the_same_results() {
    let moments = [
        Moment::After(Duration::ZERO),
        Moment::Journal(1),
        Moment::Journal(4_000),
        Moment::Journal(12_000),
        Moment::Journal(20_000),
        Moment::Writing("spectrum.csv"),
        Moment::Writing("summary.json"),
    ];
    assert!(check_moments(moments.into_iter()) >= 4, "too few runs were caught");
}

/// A hundred moments of a run of about a minute.
#[test]
fn a_hundred_kills_lose_nothing() {
    if std::env::var_os("EIGENSYNC_LONG_TESTS").is_none() {
        eprintln!("skipped: it waits for EIGENSYNC_LONG_TESTS");
        return;
    }
    let moments = (0..100).map(|k| Moment::After(Duration::from_millis(20 * k)));
    assert!(check_moments(moments) >= 50, "too few runs were caught");
}

#[test]
fn a_run_killed_again_and_again_comes_to_its_end() {
    let undisturbed = undisturbed();
    let place = with(&forty());
    for round in 0.. {
        assert!(round < 60, "it does not come to its end");
        let before = journal_length(&place);
        let run = start(&place, &["run", "tiny.toml", "--threads", "1"]);
        // Each time as soon as something more is finished.
        if send_when(run, "KILL", || journal_length(&place) > before).status.is_none() {
            assert!(round >= 2, "it was caught only {round} times");
            break;
        }
    }
    check_same(&place, &undisturbed, "after many kills");
}
