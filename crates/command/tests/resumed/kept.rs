//! What is taken over, and what is not.

use super::*;

/// A place whose run was killed when the first batch of the sweep had ended.
fn interrupted() -> Workplace {
    let place = with(&forty());
    let run = start(&place, &["run", "tiny.toml", "--threads", "1"]);
    let end = send_when(run, "KILL", || journal_length(&place) > 8_000);
    assert!(end.status.is_some(), "the run was over");
    assert!(!place.path("results/tiny").exists());
    place
}

fn run(place: &Workplace, arguments: &[&str]) -> String {
    place.answer(&[&["run", "tiny.toml"], arguments].concat()).with_status(0).stderr
}

/// What a run says that can write no file of more blocks than so many, and so ends with status 2. A limit
/// on the size of files stands for a full disk: writing fails in the same way.
#[track_caller]
fn refused_by_the_disk(place: &Workplace, blocks: u32) -> String {
    let limited = format!(
        "trap '' XFSZ; ulimit -f {blocks}; exec {} run tiny.toml --threads 1",
        assert_cmd::cargo::cargo_bin!("eigensync").display()
    );
    let output = Command::new("sh")
        .args(["-c", &limited])
        .current_dir(place.path("."))
        .output()
        .expect("there is a shell");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    said
}

#[test]
fn finished_replicas_the_curve_and_the_spectrum_are_taken_over_and_said() {
    let place = interrupted();
    let said = run(&place, &[]);
    let taken = taken_over(&place);
    let replicas = taken["replicas"].as_u64().unwrap();
    assert!((1..40).contains(&replicas), "{taken}");
    let expected = format!(
        "tiny: took over {replicas} of 40 replicas, the curve and the spectrum from the run"
    );
    assert!(said.contains(&expected), "{said}");
    assert!(said.contains("--fresh"), "{said}");
    // The results are in place, so that a run after it begins anew.
    assert!(!run(&place, &[]).contains("took over"));
}

#[test]
fn an_edited_title_keeps_everything_and_an_edited_step_no_replica() {
    let place = interrupted();
    place.write("tiny.toml", forty().set("title", "\"Another\"").0);
    run(&place, &[]);
    assert!(taken_over(&place)["replicas"].as_u64().unwrap() > 0);

    for (key, value) in [
        ("sweep.step", "0.005"),
        ("sweep.average", "80.0"),
        ("sweep.clusters", "[[1, 2], [3, 4, 5]]"),
        ("oscillator.lorenz.r", "36.0"),
        ("coupling.matrix", "\"normalized\""),
    ] {
        let place = interrupted();
        let edited =
            forty().without_table("claims.integers").set(key, value).set("sweep.transient", "1.0");
        place.write("tiny.toml", &edited.0);
        run(&place, &[]);
        let taken = taken_over(&place);
        assert_eq!(taken["replicas"], 0, "{key}: {taken}");
        let same_node = !key.starts_with("oscillator");
        assert_eq!(taken["curve"], same_node, "{key}: {taken}");
        assert_eq!(taken["spectrum"], key != "coupling.matrix", "{key}: {taken}");
    }
}

#[test]
fn couplings_that_are_added_are_all_that_is_computed() {
    let place = interrupted();
    let undisturbed = undisturbed();
    // The grid of the experiment and a point outside it.
    place.write("tiny.toml", forty().set("sweep.epsilon", "[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]").0);
    run(&place, &[]);
    assert!(taken_over(&place)["replicas"].as_u64().unwrap() > 0);
    let rows = |csv: &str| csv.lines().map(str::to_owned).collect::<Vec<_>>();
    let sweep = undisturbed.iter().find(|(name, _)| name == "sweep.csv").unwrap();
    let before = rows(std::str::from_utf8(&sweep.1).unwrap());
    assert_eq!(rows(&place.read("results/tiny/sweep.csv"))[..before.len()], before);
}

#[test]
fn fresh_takes_over_nothing() {
    let place = interrupted();
    let said = run(&place, &["--fresh"]);
    assert!(!said.contains("took over"), "{said}");
    assert_eq!(taken_over(&place)["replicas"], 0);
    assert_eq!(taken_over(&place)["curve"], false);
}

#[test]
fn a_damaged_journal_costs_what_was_damaged_and_nothing_else() {
    let undisturbed = undisturbed();
    let place = interrupted();
    let journal = format!("{UNFINISHED}/journal");
    let whole = std::fs::read(place.path(&journal)).unwrap();
    let length = whole.len();
    // Cut short, bits flipped here and there, overwritten, and no journal at all.
    let flipped = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 4;
        bytes
    };
    let damaged = [
        whole[..length - 1].to_vec(),
        whole[..length / 2].to_vec(),
        flipped(3),
        flipped(length / 3),
        [&whole[..length / 2], &[0; 400], &whole[length / 2 + 400..]].concat(),
        b"dear diary".to_vec(),
    ];
    for (case, bytes) in damaged.iter().enumerate() {
        let place = with(&forty());
        place.write(&journal, bytes);
        place.write(&format!("{UNFINISHED}/lock"), "");
        let said = run(&place, &[]);
        assert!(said.contains("the journal is damaged") || said.contains("are cut off"), "{said}");
        check_same(&place, &undisturbed, &format!("case {case}"));
    }
}

#[test]
fn what_was_computed_before_a_later_stage_failed_is_kept_and_used() {
    // Four components need more than two modes.
    let two_modes = tiny()
        .without("sweep.clusters")
        .without("sweep.error_to")
        .without_table("claims.integers")
        .and("[spectrum]\nmodes = 2");
    let place = with(&two_modes);
    place.write("networks/six-node.edges", "1 2\n3 4\n5\n6\n");
    let said = place.answer(&["run", "tiny.toml"]).with_status(2).stderr;
    assert!(said.contains("tiny keeps the curve and the spectrum: run it again"), "{said}");
    place.write("tiny.toml", two_modes.set("spectrum.modes", "6").0);
    run(&place, &[]);
    assert_eq!(taken_over(&place)["curve"], true);
    assert_eq!(place.names("results"), ["tiny"]);
}

#[test]
fn a_disk_that_fills_costs_neither_what_was_kept_nor_an_older_result() {
    let undisturbed = undisturbed();
    let place = with(&forty());
    let said = refused_by_the_disk(&place, 10);
    assert!(said.contains("cannot be kept for a later run"), "{said}");
    assert!(said.contains("run it again with the same options"), "{said}");
    assert!(!place.path("results/tiny").exists());
    run(&place, &[]);
    assert!(taken_over(&place)["replicas"].as_u64().unwrap() > 0);
    check_same(&place, &undisturbed, "after a full disk");
}

#[test]
fn a_coupling_that_cannot_be_integrated_is_an_outcome_of_its_runs() {
    let stiff = tiny()
        .set("coupling.to", "\"x\"")
        .set("sweep.epsilon", "[5.0, 10.0, 1e7]")
        .set("sweep.method", "\"dopri5\"")
        .set("sweep.transient", "5.0")
        .set("sweep.average", "5.0");
    let place = with(&stiff);
    let said = run(&place, &[]);
    let expected = "at epsilon = 1e7 the integrator gave up with seeds 1, 2";
    assert!(said.contains(expected), "{said}");
    let summary = place.json("results/tiny/summary.json");
    let outcome = |at: usize| summary["simulations"][at]["outcome"].clone();
    assert_eq!([outcome(0), outcome(1), outcome(2)], ["completed", "completed", "failed"]);
    let warnings = summary["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|w| w["message"].as_str().unwrap().starts_with(expected)));
    let sweep = place.read("results/tiny/sweep.csv");
    assert!(sweep.contains("\n10000000.0,2,failed at 0.000"), "{sweep}");
    assert!(sweep.contains(": the equations are too stiff for an explicit method,"), "{sweep}");
}

#[test]
fn states_on_the_way_go_on_where_a_run_was_killed_to_the_same_bits() {
    let with_series = || {
        let keys = "\n[sweep.series]\nnodes = [1, 4]\nseeds = 8\nfrom = 0\nevery = 2\n";
        forty().and(keys)
    };
    let whole = with(&with_series());
    run(&whole, &["--threads", "1"]);
    for signal in ["KILL", "TERM"] {
        let place = with(&with_series());
        let killed = start(&place, &["run", "tiny.toml", "--threads", "1"]);
        let end = send_when(killed, signal, || journal_length(&place) > 8_000);
        assert!(end.status.is_some_and(|status| !status.success()), "the run was over");
        run(&place, &[]);
        assert!(taken_over(&place)["replicas"].as_u64().unwrap() > 0);
        let series = whole.names("results/tiny");
        let series = series.iter().filter(|name| name.starts_with("series_"));
        assert_eq!(series.clone().count(), 40);
        for name in series {
            let [expected, resumed] =
                [&whole, &place].map(|place| place.read(&format!("results/tiny/{name}")));
            assert!(expected == resumed, "{signal}: {name} differs");
        }
    }
}

#[test]
fn series_that_are_asked_for_later_have_their_replicas_run_again() {
    let place = interrupted();
    let keys = "\n[sweep.series]\nnodes = [1]\nepsilon = [1.0]\n";
    place.write("tiny.toml", forty().and(keys).0);
    run(&place, &[]);
    assert!(place.path("results/tiny/series_epsilon_1_seed_1.csv").exists());
}

#[test]
fn states_that_cannot_be_written_stop_the_run_and_are_simulated_again() {
    let keys = "\n[sweep.series]\nnodes = [1, 2, 3, 4]\nfrom = 0\n";
    let whole = with(&forty().and(keys));
    run(&whole, &[]);
    let place = with(&forty().and(keys));
    // Room for the journal, and not for ten thousand states of a replica.
    let said = refused_by_the_disk(&place, 400);
    assert!(said.contains("tiny.toml: the states on the way cannot be written"), "{said}");
    assert!(said.contains("ask for fewer states in [sweep.series]"), "{said}");
    run(&place, &[]);
    for name in whole.names("results/tiny") {
        if name.starts_with("series_") {
            let [expected, resumed] =
                [&whole, &place].map(|place| place.read(&format!("results/tiny/{name}")));
            assert!(expected == resumed, "{name} differs");
        }
    }
}
