//! Input that means harm, or might as well: sizes that no machine holds, files that never end, text that
//! commands the terminal.

use std::io::Write;
use std::time::Duration;

use crate::support::{Toml, Workplace, tiny};
use crate::{check_answer, check_refused};

/// The tiny experiment without its sweep and claims, on a network of other make.
fn on_network(table: &str) -> Toml {
    let file = "[network.file]\npath = \"networks/six-node.edges\"";
    tiny().without_table("sweep").without_table("claims.integers").replace(file, table)
}

#[test]
fn a_group_beyond_the_network_is_refused_before_it_is_made() {
    for last in ["7", "100000000000", "9223372036854775807"] {
        let groups = format!("[groups.ranges]\nA = [1, {last}]");
        let expected = format!("names nodes 1 to {last}, but the network has 6");
        check_refused(&tiny().and(&groups), &["`groups.ranges.A`", &expected]);
    }
}

#[test]
fn generators_are_asked_for_their_size_before_they_begin() {
    let communities = |keys: &str| on_network(&format!("[network.communities]\n{keys}"));
    check_refused(
        &communities("sizes = [100000000]\np_within = 0.0\np_between = 0.0"),
        &["`network.communities` asks for 1.00e8 nodes", "20.0 GB", "smaller communities"],
    );
    check_refused(
        &communities(
            "sizes = [9223372036854775807, 9223372036854775807]\np_within = 0\np_between = 0",
        ),
        &["`network.communities` asks for 1.84e19 nodes"],
    );
    check_refused(
        &communities("sizes = [100000, 100000]\np_within = 0.5\np_between = 0.1"),
        &["asks for 6.00e9 links", "smaller probabilities"],
    );
    check_refused(
        &on_network(
            "[network.hierarchical]\npath = \"networks/six-node.edges\"\nsize = 50000\n\
             p_within = 1.0\np_between_per_weight = 0.0",
        ),
        &["`network.hierarchical` asks for 7.50e9 links"],
    );
}

#[test]
fn an_archive_of_a_kilobyte_takes_no_gigabytes() {
    let place = Workplace::new();
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default();
    for (name, line, n_lines) in
        [("weights.txt", "0 1\n", 2), ("centres.txt", "a 0 0 0\n", 3_000_000)]
    {
        zip.start_file(name, options).unwrap();
        zip.write_all(line.repeat(n_lines).as_bytes()).unwrap();
    }
    let bytes = zip.finish().unwrap().into_inner();
    assert!(bytes.len() < 100_000, "{} bytes", bytes.len());
    place.write("bomb.zip", bytes);
    let table = "[network.file]\npath = \"bomb.zip\"\nformat = \"tvb\"";
    place.write("tiny.toml", on_network(table).0);
    let expected = ["centres.txt has more than 23170 centres"];
    check_answer(&place, place.answer(&["check", "tiny.toml"]), "bomb.zip", &expected);
}

#[test]
fn lists_in_place_of_tables_are_refused() {
    let no = |table: &str| tiny().without_table(table);
    check_refused(
        &no("oscillator.lorenz").and("[oscillator]\nlorenz = [1.0]"),
        &["`oscillator.lorenz` is a list, but must be a table: [oscillator.lorenz]", "tiny.toml:"],
    );
    check_refused(
        &no("coupling").set("coupling", "[\"laplacian\", \"x\", \"y\"]"),
        &["`coupling` is"],
    );
    check_refused(&no("sweep").set("sweep", "[[1, 2]]"), &["`sweep` is a list"]);
    check_refused(&no("claims.integers").set("claims", "[]"), &["`claims` is a list"]);
    check_refused(
        &tiny().and("[claims.more]\nof = \"msf.sigma_c\"\nwhere = [1.0]\nequals = 8"),
        &["`claims.more.where` is a list"],
    );
    check_refused(
        &no("network.file").and("[network]\nfile = [\"a.edges\"]"),
        &["`network.file` is"],
    );
}

#[cfg(unix)]
#[test]
fn files_that_never_begin_or_never_end_are_refused_at_once() {
    let place = Workplace::new();
    assert!(
        std::process::Command::new("mkfifo").arg(place.path("pipe")).status().unwrap().success()
    );
    place.write("of_pipe.toml", tiny().set("network.file.path", "\"pipe\"").0);
    place.write("of_zero.toml", tiny().set("network.file.path", "\"/dev/zero\"").0);
    place.write("groups.toml", tiny().and("[groups.file]\npath = \"/dev/urandom\"").0);
    let quickly = |file: &str, expected: &str| {
        let mut command = place.eigensync(&["check", file]);
        let output = command.timeout(Duration::from_secs(5)).output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains(expected), "{stderr}");
    };
    quickly("pipe", "pipe: is a FIFO, expected a regular file");
    quickly("/dev/zero", "/dev/zero: is a device, expected a regular file");
    quickly("of_pipe.toml", "names pipe, which is a FIFO; expected a regular file");
    quickly("of_zero.toml", "names /dev/zero, which is a device");
    quickly("groups.toml", "names /dev/urandom, which is a device");
}

#[cfg(unix)]
#[test]
fn a_full_disk_under_a_stream_is_an_error_and_no_panic() {
    let place = Workplace::new();
    let status = |arguments: &str| {
        let program = assert_cmd::cargo::cargo_bin!("eigensync").display().to_string();
        let mut shell = std::process::Command::new("sh");
        shell.current_dir(place.path("")).args(["-c", &format!("{program} {arguments}")]);
        shell.output().unwrap().status.code()
    };
    for command in
        ["check tiny.toml", "list .", "--help", "--version", "run --help", "run tiny.toml"]
    {
        assert_eq!(status(&format!("{command} > /dev/full")), Some(2), "{command}");
    }
    for command in ["run tiny.toml", "run tiny.toml --threads 1"] {
        assert_eq!(status(&format!("{command} > /dev/null 2> /dev/full")), Some(0), "{command}");
    }
    assert_eq!(status("run nothing.toml 2> /dev/full"), Some(2));
    assert_eq!(status("runn 2> /dev/full"), Some(2));
}

#[test]
fn more_threads_than_are_of_use_are_not_started() {
    let place = Workplace::new();
    let answer = place.answer(&["run", "tiny.toml", "--threads", "65535"]).with_status(0);
    assert!(answer.stderr.contains("warning: `--threads 65535`: "), "{}", answer.stderr);
}

#[test]
fn no_text_of_a_file_commands_the_terminal() {
    let place = Workplace::new();
    place.write("tiny.toml", tiny().set("title", r#""\u001b[2J\u009b31m\u202ered""#).0);
    for arguments in [&["check", "tiny.toml"], &["list", "."]] {
        let answer = place.answer(arguments).with_status(0);
        assert!(answer.stdout.contains(r"\u{1b}[2J\u{9b}31m\u{202e}red"), "{}", answer.stdout);
    }
}

#[test]
fn a_key_of_a_million_characters_is_answered_with_a_message_that_is_read() {
    let place = Workplace::new();
    place.write("tiny.toml", tiny().set(&format!("sweep.{}", "k".repeat(1_000_000)), "1").0);
    let answer = place.answer(&["check", "tiny.toml"]).with_status(2);
    assert!(answer.stderr.contains("unknown key `sweep.kkk"), "{}", answer.stderr);
    assert!(answer.stderr.contains("hint: known here: epsilon, seeds"), "{}", answer.stderr);
    assert!(answer.stderr.len() < 1000, "{} bytes", answer.stderr.len());
}

#[test]
fn a_sparse_file_longer_than_memory_is_refused_before_it_is_read() {
    let place = Workplace::new();
    let file = std::fs::File::create(place.path("networks/six-node.edges")).unwrap();
    // Forty terabytes of holes; where the file system has no room for them there is nothing to test.
    if file.set_len(40 << 40).is_err() && file.set_len(8 << 40).is_err() {
        println!("no sparse file can be made here");
        return;
    }
    let mut command = place.eigensync(&["check", "tiny.toml"]);
    let output = command.timeout(Duration::from_secs(5)).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.contains("`network.file.path` names a file of"), "{stderr}");
}

#[test]
fn check_tells_the_time_of_a_large_network_that_is_one_cluster_without_taking_it() {
    let place = Workplace::new();
    let links: String = (0..200_000).map(|i| format!("{i} {}\n", i + 1)).collect();
    place.write("networks/six-node.edges", links);
    let experiment = tiny().without("sweep.error_to").without("sweep.clusters");
    place.write(
        "tiny.toml",
        experiment.and("[spectrum]\nmodes = 4").without_table("claims.integers").0,
    );
    let mut command = place.eigensync(&["check", "tiny.toml"]);
    // Three seconds where nothing else runs.
    let output = command.timeout(Duration::from_secs(60)).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}");
    // Each sample compares 2·10¹⁰ pairs: days, as the estimate must say.
    let seconds = said.rsplit_once("about ").unwrap().1.split(' ').next().unwrap();
    assert!(seconds.parse::<f64>().unwrap() > 1e4, "{said}");
    assert!(said.contains("5 values of epsilon, 1 to 5; 2 seeds, 10 runs"), "{said}");
}
