//! Where results go: what is a user's stays, what is somebody else's is refused before any work, and
//! only results of the same experiment are replaced.

use std::fs;
use std::fs::Permissions;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::{SIX_NODES, TINY_FILES, Toml, Workplace, tiny};

const LORENZ: [&str; 5] = ["--oscillator", "lorenz", "--coupling", "x:y", "--quick"];

/// Runs an experiment that would take hours, which is refused at once, with all these words.
#[track_caller]
fn refused(place: &Workplace, arguments: &[&str], expected: &[&str]) {
    place.write("tiny.toml", tiny().set("sweep.transient", "1e9").0);
    let answer = place.answer(arguments).with_status(2);
    for expected in expected.iter().chain(&["hint: "]) {
        assert!(answer.stderr.contains(expected), "{expected} in:\n{}", answer.stderr);
    }
    assert!(!place.names("results").iter().any(|name| name.ends_with(".unfinished")));
}

/// Runs the tiny experiment, or another text under its name.
#[track_caller]
pub fn run(place: &Workplace, experiment: &Toml, options: &[&str]) -> String {
    place.write("tiny.toml", &experiment.0);
    place.answer(&[&["run", "tiny.toml"], options].concat()).with_status(0).stderr
}

#[test]
fn a_folder_that_is_not_ours_is_never_deleted() {
    let place = Workplace::new();
    place.write("thesis.edges", SIX_NODES);
    place.write("thesis/chapters/one.tex", "years of work");
    let answer = place
        .answer(&[&["predict", "thesis.edges", "--results", "."], &LORENZ[..]].concat())
        .with_status(2);
    assert!(answer.stderr.contains("no summary.json of eigensync"), "{}", answer.stderr);
    assert_eq!(place.read("thesis/chapters/one.tex"), "years of work");
    assert_eq!(place.names("."), ["networks", "thesis", "thesis.edges", "tiny.toml"]);
}

#[test]
fn whatever_is_no_result_of_this_experiment_is_refused_before_the_run() {
    let place = Workplace::new();
    let run = ["run", "tiny.toml"];
    place.write("results/tiny", "a file");
    refused(&place, &run, &["results/tiny: is a file"]);
    assert_eq!(place.read("results/tiny"), "a file");
    fs::remove_file(place.path("results/tiny")).unwrap();
    for (to, exists) in [("nowhere", false), ("networks", true)] {
        symlink(place.path(to), place.path("results/tiny")).unwrap();
        refused(&place, &run, &["results/tiny: is a link to", to]);
        assert_eq!(place.path("results/tiny").exists(), exists);
        fs::remove_file(place.path("results/tiny")).unwrap();
    }
    for summary in ["", "{}", "[1]", r#"{"id": "tiny", "shortened": 1.0, "experiment": {}}"#] {
        place.write("results/tiny/summary.json", summary);
        refused(&place, &run, &["results/tiny: has no summary.json of eigensync"]);
        assert_eq!(place.read("results/tiny/summary.json"), summary);
    }
    place.write("results/.tiny.unfinished/my.txt", "mine");
    fs::remove_dir_all(place.path("results/tiny")).unwrap();
    let answer = place.answer(&run).with_status(2);
    assert!(answer.stderr.contains("not made by eigensync"), "{}", answer.stderr);
    assert_eq!(place.read("results/.tiny.unfinished/my.txt"), "mine");
}

#[test]
fn a_copy_of_the_results_of_another_experiment_is_refused() {
    let place = Workplace::new();
    run(&place, &tiny(), &[]);
    fs::rename(place.path("results/tiny"), place.path("results/other")).unwrap();
    place.write("other.toml", tiny().0);
    refused(&place, &["run", "other.toml"], &["holds results of another experiment, `tiny`"]);
    assert!(place.path("results/other/summary.json").exists());
}

#[test]
fn names_that_mean_another_place_or_none_are_refused_before_the_run() {
    let place = Workplace::new();
    let long = format!("{}.toml", "x".repeat(245));
    let names = [("...toml", "a dot"), (".toml", "a dot"), ("x.quick.toml", "quick runs")];
    for (name, expected) in names.into_iter().chain([(&long[..], "a shorter name")]) {
        place.write(name, tiny().set("sweep.transient", "1e9").0);
        let answer = place.answer(&["run", name]).with_status(2);
        assert!(answer.stderr.contains(expected), "{expected} in:\n{}", answer.stderr);
    }
    assert_eq!(place.names("results"), [""; 0]);
}

#[test]
fn what_a_user_put_into_the_results_stays_in_place_when_they_are_replaced() {
    let place = Workplace::new();
    run(&place, &tiny(), &[]);
    place.write("results/tiny/notes.txt", "mine");
    place.write("results/tiny/drafts/deep/one.tex", "years of work");
    symlink("nowhere", place.path("results/tiny/link")).unwrap();
    let edited = place.read("results/tiny/sweep.csv") + "a row of mine\n";
    place.write("results/tiny/sweep.csv", &edited);
    for _ in 0..2 {
        let said = run(&place, &tiny(), &[]);
        assert_eq!(place.read("results/tiny/notes.txt"), "mine");
        assert_eq!(place.read("results/tiny/drafts/deep/one.tex"), "years of work");
        assert_eq!(
            fs::read_link(place.path("results/tiny/link")).unwrap().to_str(),
            Some("nowhere")
        );
        assert_eq!(place.read("results/tiny/sweep.kept.csv"), edited);
        assert!(!place.read("results/tiny/sweep.csv").contains("mine"));
        assert_eq!(place.names("results"), ["tiny"], "{said}");
    }
    assert_eq!(place.names("results/tiny").len(), TINY_FILES + 4);
}

#[test]
fn an_edit_that_is_kept_under_another_name_is_said() {
    let place = Workplace::new();
    run(&place, &tiny(), &[]);
    place.write("results/tiny/msf.csv", "edited");
    let said = run(&place, &tiny(), &[]);
    assert!(said.contains("msf.csv was edited") && said.contains("msf.kept.csv"), "{said}");
    assert!(!run(&place, &tiny(), &[]).contains("kept"));
}

#[test]
fn a_second_run_of_the_same_experiment_says_at_once_who_is_at_work() {
    let place = Workplace::new();
    place.write("tiny.toml", tiny().set("sweep.transient", "1e9").0);
    let mut first = Command::new(assert_cmd::cargo::cargo_bin!("eigensync"))
        .args(["run", "tiny.toml"])
        .current_dir(place.path("."))
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let started = Instant::now();
    let holder = || fs::read_to_string(place.path("results/.tiny.unfinished/lock"));
    while !holder().is_ok_and(|text| text.contains("process")) {
        assert!(started.elapsed() < Duration::from_secs(60), "the first run does not start");
    }
    let answer = place.answer(&["run", "tiny.toml"]).with_status(2);
    first.kill().unwrap();
    first.wait().unwrap();
    let holder = format!("process {}", first.id());
    for expected in ["another run of the same experiment", &holder, "--results"] {
        assert!(answer.stderr.contains(expected), "{expected} in:\n{}", answer.stderr);
    }
    // The lock goes with the process that held it.
    run(&place, &tiny(), &[]);
    assert_eq!(place.names("results"), ["tiny"]);
}

#[test]
fn a_quick_run_never_replaces_a_full_one() {
    let place = Workplace::new();
    let long = || tiny().set("sweep.average", "100").set("msf.average", "200");
    run(&place, &long(), &["--quick"]);
    let shortened = |name: &str| {
        place.json(&format!("results/{name}/summary.json"))["shortened"].as_f64().unwrap()
    };
    assert_eq!(shortened("tiny"), 10.0);
    run(&place, &long(), &[]);
    assert_eq!(shortened("tiny"), 1.0);
    for _ in 0..2 {
        let said = run(&place, &long(), &["--quick"]);
        assert!(said.contains("results/tiny.quick"), "{said}");
        assert_eq!((shortened("tiny"), shortened("tiny.quick")), (1.0, 10.0));
    }
    assert_eq!(place.names("results"), ["tiny", "tiny.quick"]);
}

#[test]
fn a_quick_run_is_compared_where_it_was_written() {
    let place = Workplace::new();
    run(&place, &tiny(), &[]);
    fs::create_dir_all(place.path("experiments/golden/tiny")).unwrap();
    let golden = place
        .read("results/tiny/summary.json")
        .replace("\"shortened\": 1.0", "\"shortened\": 10.0");
    place.write("experiments/golden/tiny/summary.json", golden);
    let long = tiny().set("sweep.average", "100").set("msf.average", "200");
    place.write("tiny.toml", &long.0);
    let answer = place.answer(&["run", "tiny.toml", "--quick"]);
    assert!(!answer.stdout.contains("shortened"), "{}", answer.stdout);
}

#[test]
fn results_of_another_network_or_command_of_the_same_name_are_refused() {
    let place = Workplace::new();
    place.write("net.edges", SIX_NODES);
    place.write("net.txt", SIX_NODES);
    place.write("elsewhere/net.edges", SIX_NODES);
    let predict = |network: &str| place.answer(&[&["predict", network], &LORENZ[..]].concat());
    predict("net.edges").with_status(0);
    let before = place.read("results/net/summary.json");
    for other in ["net.txt", "elsewhere/net.edges"] {
        let said = predict(other).with_status(2).stderr;
        assert!(said.contains("holds the results of `eigensync predict"), "{said}");
        assert!(said.contains("net.edges`") && said.contains("--results FOLDER"), "{said}");
    }
    place.write("net.toml", tiny().0);
    let said = place.answer(&["run", "net.toml"]).with_status(2).stderr;
    assert!(said.contains("holds the results of `eigensync predict"), "{said}");
    assert_eq!(place.read("results/net/summary.json"), before);
    predict("net.edges").with_status(0);
    // A network that was moved is the same one.
    fs::rename(place.path("net.edges"), place.path("elsewhere/net.edges")).unwrap();
    predict("elsewhere/net.edges").with_status(0);
}

#[test]
fn a_prediction_can_be_run_from_where_its_results_lie_and_names_no_absolute_path() {
    let place = Workplace::new();
    place.write("data/six.edges", SIX_NODES);
    let network = place.path("data/six.edges").canonicalize().unwrap();
    let network = network.to_str().unwrap();
    let arguments = [&["predict", network, "--results", "out/results"], &LORENZ[..]].concat();
    place.answer(&arguments).with_status(0);
    let root = place.path(".").canonicalize().unwrap();
    for file in place.names("out/results/six") {
        let content = fs::read(place.path(&format!("out/results/six/{file}"))).unwrap();
        let text = String::from_utf8_lossy(&content);
        assert!(!text.contains(root.to_str().unwrap()), "{file} names {}", root.display());
    }
    // The whole tree may be moved.
    let place_2 = Workplace::new();
    for name in ["out", "data"] {
        fs::rename(place.path(name), place_2.path(name)).unwrap();
    }
    let again = ["run", "out/results/six/experiment.toml", "--quick"];
    place_2.answer(&again).with_status(0);
    let of = |path: &str| place_2.json(path)["critical_couplings"].clone();
    assert_eq!(of("out/results/six/summary.json"), of("results/experiment/summary.json"));
}

#[test]
fn whole_folders_that_0_1_0_left_hidden_are_put_in_place_before_anything_else() {
    let place = Workplace::new();
    run(&place, &tiny(), &[]);
    place.write("results/tiny/notes.txt", "mine");
    // Its summaries listed no files.
    let mut summary = place.json("results/tiny/summary.json");
    let provenance = summary["provenance"].as_object_mut().unwrap();
    assert!(provenance.remove("files").is_some() && provenance.remove("origin").is_some());
    let older = summary.to_string();
    place.write("results/tiny/summary.json", &older);
    let aside = place.path("results/.tiny.unfinished-Ab12Cd-replaced");
    fs::rename(place.path("results/tiny"), aside).unwrap();
    place.write("results/.tiny.unfinished-Ef34Gh/msf.csv", "half of it");
    // This run fails after its place was reserved.
    let fails = tiny().set("oscillator.lorenz.r", "1e6").without_table("sweep");
    place.write("tiny.toml", fails.0);
    place.answer(&["run", "tiny.toml"]).with_status(2);
    assert_eq!(place.read("results/tiny/summary.json"), older);
    assert_eq!(place.names("results"), ["tiny"]);
    run(&place, &tiny(), &[]);
    assert_eq!(place.read("results/tiny/notes.txt"), "mine");
}

/// Runs the tiny experiment as a user who owns the folder but is not root; none if that is not
/// possible here.
pub fn run_as_a_user(place: &Workplace) -> Option<(Option<i32>, String)> {
    let program = assert_cmd::cargo::cargo_bin!("eigensync").to_str().unwrap();
    let root = fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0);
    let mut command = Command::new(if root { "setpriv" } else { program });
    if root {
        command.args(["--reuid=65534", "--clear-groups", program]);
    }
    let output = command.args(["run", "tiny.toml"]).current_dir(place.path(".")).output().ok()?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    // A program that lies where nobody else may go cannot be tried.
    (!said.starts_with("setpriv: ")).then_some((output.status.code(), said))
}

#[test]
fn a_folder_in_the_results_that_could_not_come_along_is_refused_before_the_run() {
    let place = Workplace::new();
    run(&place, &tiny(), &[]);
    place.write("results/tiny/drafts/one.tex", "years of work");
    let folder = place.path(".");
    let owned = Command::new("chown").args(["-R", "65534"]).arg(&folder).status();
    fs::set_permissions(place.path("results/tiny/drafts"), Permissions::from_mode(0o555)).unwrap();
    let Some((status, said)) = run_as_a_user(&place).filter(|_| owned.is_ok()) else {
        println!("skipped: no program can be run as another user here");
        return;
    };
    assert!(said.contains("results/tiny/drafts: could not come along"), "{said}");
    assert_eq!(status, Some(2), "{said}");
    assert_eq!(place.read("results/tiny/drafts/one.tex"), "years of work");
    assert_eq!(place.names("results"), ["tiny"]);
    fs::set_permissions(place.path("results/tiny/drafts"), Permissions::from_mode(0o755)).unwrap();
    let (status, said) = run_as_a_user(&place).unwrap();
    assert_eq!(status, Some(0), "{said}");
    assert_eq!(place.read("results/tiny/drafts/one.tex"), "years of work");
}

#[test]
fn a_run_that_is_started_in_its_own_results_puts_new_ones_in_place() {
    let place = Workplace::new();
    run(&place, &tiny(), &[]);
    place.write("results/tiny/notes.txt", "mine");
    let mut command = place.eigensync(&["run", "../../tiny.toml", "--results", ".."]);
    let output = command.current_dir(place.path("results/tiny")).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(place.names("results"), ["tiny"]);
    assert_eq!(place.read("results/tiny/notes.txt"), "mine");
}

#[test]
fn a_run_that_could_not_clear_up_does_not_bar_the_next_one() {
    let place = Workplace::new();
    for left in ["trial/new/file", "trial/old/file", "journal", "files/msf.csv"] {
        place.write(&format!("results/.tiny.unfinished/{left}"), "");
        run(&place, &tiny(), &[]);
        assert_eq!(place.names("results"), ["tiny"], "{left}");
    }
}

#[test]
fn what_a_user_put_beside_unfinished_work_stays() {
    let place = Workplace::new();
    place.write("results/.tiny.unfinished/lock", "");
    place.write("results/.tiny.unfinished/mine/one.tex", "years of work");
    let said = run(&place, &tiny(), &[]);
    assert!(said.contains("mine stays in the folder of an unfinished run"), "{said}");
    assert_eq!(place.read("results/.tiny.unfinished/mine/one.tex"), "years of work");
    run(&place, &tiny(), &[]);
    assert_eq!(place.read("results/.tiny.unfinished/mine/one.tex"), "years of work");
}

#[test]
fn a_journal_that_leads_elsewhere_is_refused_and_not_written_to() {
    let place = Workplace::new();
    place.write("precious", "years of work");
    place.write("results/.tiny.unfinished/lock", "");
    let journal = place.path("results/.tiny.unfinished/journal");
    symlink(place.path("precious"), &journal).unwrap();
    place.answer(&["run", "tiny.toml"]).with_status(2);
    fs::remove_file(&journal).unwrap();
    fs::create_dir_all(journal.parent().unwrap()).unwrap();
    place.write("results/.tiny.unfinished/lock", "");
    fs::hard_link(place.path("precious"), &journal).unwrap();
    place.answer(&["run", "tiny.toml"]).with_status(2);
    assert_eq!(place.read("precious"), "years of work");
    run(&place, &tiny(), &["--fresh"]);
    assert_eq!(place.read("precious"), "years of work");
}

#[test]
fn new_results_have_the_mode_of_those_that_they_replace() {
    let place = Workplace::new();
    run(&place, &tiny(), &[]);
    fs::set_permissions(place.path("results/tiny"), Permissions::from_mode(0o700)).unwrap();
    run(&place, &tiny(), &[]);
    let mode = fs::metadata(place.path("results/tiny")).unwrap().permissions().mode();
    assert_eq!(mode & 0o7777, 0o700);
}
