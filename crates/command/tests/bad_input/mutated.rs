//! Files changed at random, by the hundred: whatever they ask for, the command answers within seconds and
//! in bounded memory, with results or with one message that names the file.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use eigensync::graph::formats::{FORMATS, Format};

use crate::support::{Workplace, tiny};

/// Memory that a run may take, in kilobytes of address space.
const MOST_MEMORY: u64 = 2_000_000;
/// Longest time for an answer, half of which is for other work that the machine may have.
const LONGEST: Duration = Duration::from_secs(20);

/// A small generator of our own: the seed of a failure is enough to see it again.
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 33) as usize % n.max(1)
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}

const VALUES: [&str; 30] = [
    "0",
    "-0",
    "-1",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "nan",
    "inf",
    "-inf",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551616",
    "100000000000",
    "1e9",
    "3",
    "0.3",
    "true",
    "[]",
    "[[]]",
    "[0]",
    "[1, 1]",
    "{}",
    "\"\"",
    "\"x\"",
    "\"\\u001b[2J\\u202e\"",
    "1979-05-27",
    "{ from = 0, to = 1e300, points = 4294967295 }",
    "{ of_largest = nan }",
    "{ unstable_at = 1e-300 }",
];

const LINES: [&str; 22] = [
    "[groups.ranges]\nA = [1, 3]\nB = [4, 9223372036854775807]",
    "[spectrum]\nmodes = 3",
    "[spectrum]\nmodes = { unstable_at = 1e-9 }",
    "[spectrum]\nsolver = \"arpack\"\nmodes = 2",
    "[spectrum]\nsolver = \"chebyshev\"",
    "[figure]\nkind = \"matrices\"",
    "[figure]\nkind = \"matrices\"\neigenvectors = [6, 1]",
    "[figure]\nkind = \"none\"",
    "[figure]\nlayout = [[0, 0], [1, 0], [2, 0], [3, 0], [4, 0], [5, 1e300]]",
    "[figure]\nerror_scale = \"log\"\nmark_modes = []",
    "[prediction]\nthreshold = 1e-9",
    "[prediction]\nthreshold = 3.0",
    "[regions]\ndistance_within = 1\ndistance_between = 1\nerror_within = 1\nerror_between = 1",
    "[claims.more]\nof = \"simulated.onset\"\nwhere.clusters = [[1, 2]]\nequals = 2",
    "[claims.other]\nof = \"msf.sigma_c\"\nat_most = 1e300",
    "[oscillator.rossler]",
    "sweep = [1, 2, 3]",
    "prepare = [\"largest_component\", { threshold = 1e308 }]",
    "prepare = [{ nodes = [[1, 100000000000]] }]",
    "[network.communities]\nsizes = [100000000]\np_within = 0.0\np_between = 0.0",
    "method = \"dopri5\"\ntolerance = 1e-12",
    "method = \"dop853\"\nstep = 1.0",
];

/// A text with a few things changed.
fn changed(text: &str, random: &mut Random) -> Vec<u8> {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for _ in 0..=random.below(3) {
        let at = random.below(lines.len());
        let number = lines[at].find(|c: char| c.is_ascii_digit());
        match (random.below(9), lines[at].split_once('='), number) {
            (0, ..) => drop(lines.remove(at)),
            (1, ..) => lines.insert(at, lines[at].clone()),
            (2, ..) => lines.insert(at, random.of(&LINES).to_owned()),
            (3, ..) => lines.push(random.of(&LINES).to_owned()),
            (4 | 5, _, Some(digit)) => {
                lines[at].insert_str(digit, random.of(&["9", "00", "-", ".", "1e", "99999999"]));
            }
            (_, Some((key, _)), _) => {
                let key = key.trim_end().to_owned();
                lines[at] = format!("{key} = {}", random.of(&VALUES));
            }
            (_, None, _) => {
                let other = random.below(lines.len());
                lines.swap(at, other);
            }
        }
        if lines.is_empty() {
            break;
        }
    }
    damaged((lines.join("\n") + "\n").into_bytes(), random)
}

/// Bytes of which, once in a while, some are others or the end is missing.
fn damaged(mut bytes: Vec<u8>, random: &mut Random) -> Vec<u8> {
    match random.below(6) {
        0 => bytes.truncate(random.below(bytes.len())),
        1 => {
            let n_bytes = bytes.len();
            for _ in 0..=random.below(3) {
                bytes[random.below(n_bytes)] = random.below(256) as u8;
            }
        }
        _ => {}
    }
    bytes
}

/// Runs the command under the limits; gives whether it succeeded.
#[track_caller]
fn answers(place: &Workplace, arguments: &str, file: &str, seed: u64) -> bool {
    let program = assert_cmd::cargo::cargo_bin!("eigensync").display().to_string();
    let mut shell = assert_cmd::Command::new("sh");
    let command = format!("ulimit -v {MOST_MEMORY}; exec {program} {arguments}");
    let output = shell.current_dir(place.path("")).args(["-c", &command]).timeout(LONGEST).output();
    let output = output.unwrap_or_else(|error| panic!("{file} of seed {seed}: {error}"));
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    let shown = || format!("{file} of seed {seed}:\n{said}\n{}", place.read_lossy(file));
    let status = output.status.code();
    assert!(matches!(status, Some(0..=2)), "{status:?} {}", shown());
    assert!(!said.contains("a fault of eigensync"), "{}", shown());
    let commands = |c: char| c.is_control() && c != '\n' && c != '\t';
    assert!(!said.contains(commands) && said.len() < 100_000, "{}", shown());
    if status == Some(2) {
        let error = String::from_utf8_lossy(&output.stderr);
        let message = error.lines().find_map(|line| line.strip_prefix("error: "));
        let message = message.unwrap_or_else(|| panic!("no message {}", shown()));
        let names = ["m.toml", "network.", "networks/"];
        assert!(names.iter().any(|name| message.contains(name)), "{message} {}", shown());
    }
    if place.path("results/m/summary.json").exists() {
        let summary = place.read("results/m/summary.json");
        for word in ["NaN", "inf,", "inf\n", "null,\n      null"] {
            assert!(!summary.contains(word) || word.contains("null"), "{word} {}", shown());
        }
    }
    status == Some(0)
}

/// How many files to try: more where time does not matter.
fn count(few: u64, many: u64) -> u64 {
    if std::env::var_os("EIGENSYNC_LONG_TESTS").is_some() {
        many
    } else {
        println!("{few} files; EIGENSYNC_LONG_TESTS tries {many}");
        few
    }
}

#[test]
fn experiment_files_changed_at_random_are_answered() {
    let place = Workplace::new();
    // A second or so, if the times stay as they are.
    let base = tiny().set("sweep.transient", "4").set("sweep.average", "4").0;
    for seed in 0..count(60, 2000) {
        let text = changed(&base, &mut Random::new(seed + 1));
        place.write("m.toml", text);
        if answers(&place, "check m.toml", "m.toml", seed) && costs_little(&place) {
            answers(&place, "run m.toml", "m.toml", seed);
        }
    }
}

/// Whether `check` foresees a run of a few seconds.
fn costs_little(place: &Workplace) -> bool {
    let told = place.answer(&["check", "m.toml"]).stdout;
    let seconds =
        told.rsplit_once("about ").and_then(|(_, rest)| rest.split(' ').next()?.parse().ok());
    seconds.is_some_and(|seconds: f64| seconds <= 2.0)
}

#[test]
fn network_files_changed_at_random_are_answered() {
    let place = Workplace::new();
    place.write("m.toml", "");
    let formats: Vec<_> = FORMATS.iter().map(|format| (format, fixtures(format))).collect();
    for seed in 0..count(60, 1000) {
        let mut random = Random::new(seed + 77);
        let (format, files) = &formats[seed as usize % formats.len()];
        let base = &files[random.below(files.len())];
        let content = match std::str::from_utf8(base) {
            Ok(text) => changed_network(text, &mut random),
            Err(_) => damaged(base.clone(), &mut random),
        };
        let file = format!("network.{}", format.ending());
        place.write(&file, content);
        let table = format!("path = \"{file}\"\nformat = \"{}\"", format.name);
        let experiment = tiny().replace("path = \"networks/six-node.edges\"", &table);
        let experiment = experiment.without("sweep.error_to").without("sweep.clusters");
        place.write("m.toml", experiment.without_table("claims.integers").0);
        answers(&place, "check m.toml", &file, seed);
    }
}

fn changed_network(text: &str, random: &mut Random) -> Vec<u8> {
    const NUMBERS: [&str; 12] = [
        "4294967296",
        "999999",
        "1e308",
        "-1",
        "0",
        "nan",
        "inf",
        "1e-300",
        "\"",
        ",",
        "18446744073709551616",
        "\u{1b}[2J",
    ];
    let mut text = text.to_owned();
    for _ in 0..=random.below(3) {
        let digits: Vec<usize> =
            text.char_indices().filter(|(_, c)| c.is_ascii_digit()).map(|(at, _)| at).collect();
        let Some(&at) = digits.get(random.below(digits.len())) else { break };
        let number = random.of(&NUMBERS);
        if random.below(2) == 0 {
            text.replace_range(at..=at, number);
        } else {
            text.insert_str(at, number);
        }
    }
    damaged(text.into_bytes(), random)
}

/// The files of a format that its readers are tested with.
fn fixtures(format: &Format) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../graph/tests/fixtures");
    let entries = fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == format.ending()));
    paths.sort();
    assert!(!paths.is_empty(), "no file of {} among the fixtures", format.name);
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}
