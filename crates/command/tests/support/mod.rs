//! What the tests of the `eigensync` command share: a folder with a tiny experiment that holds, ways
//! to edit it, and the command run in it as a user runs it.

#![allow(dead_code, reason = "every test file uses its own part of this")]

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

/// Six Lorenz oscillators on the network of Fan, Wang & Wang (2023), Fig. 1(a): a quarter of a second.
const TINY: &str = r#"title  = "Six Lorenz oscillators, in a hurry"
source = "the paper"
seed   = 1

[network.file]
path = "networks/six-node.edges"

[oscillator.lorenz]
alpha = 10.0
r     = 35.0
b     = 2.6666666666666665

[coupling]
matrix = "laplacian"
from   = "x"
to     = "y"

[msf]
sigma          = { from = 0.0, to = 12.0, points = 7 }
step           = 0.01
transient      = 10.0
average        = 100.0
relative_error = 0.05

[sweep]
epsilon            = { from = 1.0, to = 5.0, points = 5 }
seeds              = 2
step               = 0.01
transient          = 40.0
average            = 40.0
error_to           = "2"
clusters           = [[1, 2, 6], [3, 4, 5]]
synchronised_below = 0.1

[claims.integers]
of      = "eigenvalues"
equals  = [0, -2, -3, -4, -5, -6]
abs_tol = 1e-9
"#;

/// The network of the tiny experiment.
pub const SIX_NODES: &str = include_str!("../../../../experiments/networks/six-node.edges");

/// The text of an experiment file under edit.
pub struct Toml(pub String);

/// How many files the results folder of the tiny experiment has.
pub const TINY_FILES: usize = 13;

/// The tiny experiment as it stands.
pub fn tiny() -> Toml {
    Toml(TINY.to_owned())
}

impl Toml {
    /// Gives a key, named with its table, another value, or adds it.
    pub fn set(self, key: &str, value: &str) -> Self {
        let name = key.rsplit('.').next().unwrap_or(key);
        let (mut lines, position) = self.without_lines(key);
        lines.insert(position, format!("{name} = {value}"));
        Self(lines.join("\n") + "\n")
    }

    /// Takes a key away.
    pub fn without(self, key: &str) -> Self {
        let before = self.0.lines().count();
        let (lines, _) = self.without_lines(key);
        assert_eq!(lines.len() + 1, before, "{key} stands in the experiment once");
        Self(lines.join("\n") + "\n")
    }

    /// Takes a whole table away.
    pub fn without_table(self, table: &str) -> Self {
        let header = format!("[{table}]\n");
        let start = self.0.find(&header).expect("the experiment has the table");
        let rest = &self.0[start + header.len()..];
        let end = rest.find("\n[").map_or(rest.len(), |end| end + 1);
        Self(format!("{}{}", &self.0[..start], &rest[end..]))
    }

    /// Replaces a text that stands in it.
    pub fn replace(self, from: &str, to: &str) -> Self {
        assert!(self.0.contains(from), "the experiment contains {from}");
        Self(self.0.replace(from, to))
    }

    /// Adds lines at the end.
    pub fn and(self, lines: &str) -> Self {
        Self(format!("{}\n{lines}\n", self.0))
    }

    /// The lines but for those of a key, and where that key belongs.
    fn without_lines(&self, key: &str) -> (Vec<String>, usize) {
        let (table, name) = key.rsplit_once('.').unwrap_or(("", key));
        let (mut lines, mut current, mut position) = (Vec::new(), String::new(), None);
        for line in self.0.lines() {
            if current == table && position.is_none() {
                position = Some(lines.len());
            }
            if line.starts_with('[') {
                current = line.trim_matches(['[', ']']).to_owned();
            }
            let is_key = line.split('=').next().is_some_and(|left| left.trim() == name);
            if current == table && is_key && line.contains('=') {
                position = Some(lines.len());
            } else {
                lines.push(line.to_owned());
            }
        }
        (lines, position.unwrap_or_else(|| panic!("the experiment has no table [{table}]")))
    }
}

/// A folder that a user works in, gone when the test ends.
pub struct Workplace {
    folder: TempDir,
}

impl Workplace {
    /// A folder with the tiny experiment, `tiny.toml`, and its network.
    pub fn new() -> Self {
        let place = Self { folder: TempDir::new().expect("a temporary folder can be made") };
        place.write("tiny.toml", &tiny().0);
        place.write("networks/six-node.edges", SIX_NODES);
        place
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        let parent = path.parent().expect("a file has a folder");
        fs::create_dir_all(parent).expect("a folder can be made");
        fs::write(path, content).expect("a file can be written");
    }

    pub fn read(&self, name: &str) -> String {
        let path = self.path(name);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// The text of a file that may be none.
    pub fn read_lossy(&self, name: &str) -> String {
        String::from_utf8_lossy(&fs::read(self.path(name)).unwrap_or_default()).into_owned()
    }

    pub fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).expect("a summary is JSON")
    }

    /// The command in this folder.
    pub fn eigensync(&self, arguments: &[&str]) -> Command {
        let mut command = assert_cmd::cargo::cargo_bin_cmd!("eigensync");
        // What other tests have computed is no matter of this one.
        command.current_dir(self.folder.path()).args(arguments).env("EIGENSYNC_CACHE", "");
        command
    }

    /// Runs the command and gives its answer.
    pub fn answer(&self, arguments: &[&str]) -> Answer {
        let output = self.eigensync(arguments).output().expect("the command can be started");
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the command prints text");
        Answer {
            status: output.status.code(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    /// Names in a folder, sorted, hidden ones among them; none if there is no such folder.
    pub fn names(&self, folder: &str) -> Vec<String> {
        names(&self.path(folder))
    }
}

/// Names in a folder, sorted; none if there is no such folder.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> =
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// What the command said.
pub struct Answer {
    pub status: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Answer {
    /// Asserts the exit status, and shows everything said where it is another.
    #[track_caller]
    pub fn with_status(self, expected: i32) -> Self {
        let Self { status, stdout, stderr } = &self;
        assert_eq!(*status, Some(expected), "\nstdout:\n{stdout}\nstderr:\n{stderr}");
        self
    }
}
