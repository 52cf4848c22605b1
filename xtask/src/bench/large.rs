//! Operations on large networks, beside what other tools take for them: `leading_modes.csv` and
//! `clusters.csv`, each `fixture,implementation,seconds` and what was found.
//!
//! A benchmark OPERATION/FIXTURE/SIZE gives the row FIXTURE_SIZE. Its seconds are criterion's, what it
//! found is in the file that the benchmark writes into the folder `EIGENSYNC_FOUND`; the rows of the
//! peers come from `benches/peers/run.py`.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::criterion::{Benchmark, Program};
use super::{make_empty, read_if_there, write};
use crate::status;

/// An operation whose fixtures other programs can read.
pub struct Operation {
    /// Of its benchmarks, their program, and its table.
    pub name: &'static str,
    /// What is found, as columns.
    found: &'static str,
    /// How the names of its fixtures end.
    extension: &'static str,
    title: &'static str,
    /// Whether the processor is free to use, to eigensync and to peers; one core otherwise.
    pub on_all_cores: bool,
}

pub const OPERATIONS: [Operation; 2] = [
    Operation {
        name: "leading_modes",
        found: "products,residual",
        extension: "csr",
        title: "Leading modes, seconds",
        on_all_cores: true,
    },
    Operation {
        name: "clusters",
        found: "clusters",
        extension: "rows",
        title: "Clusters of given modes, seconds",
        on_all_cores: false,
    },
];

/// A line of an operation's table.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// With its size.
    pub fixture: String,
    pub implementation: String,
    pub seconds: f64,
    /// The further columns.
    pub found: String,
}

impl Operation {
    /// The fixtures that were measured, of at most so many nodes, by their files once written to
    /// this folder.
    pub fn write_fixtures(
        &self,
        measured: &[Benchmark],
        programs: &[Program],
        largest: usize,
        folder: &Path,
    ) -> Result<Vec<PathBuf>, String> {
        let sizes = measured.iter().filter_map(|benchmark| self.fixture(&benchmark.id));
        let small = sizes.filter(|(_, n_nodes)| *n_nodes <= largest);
        let mut names: Vec<String> = small.map(|(fixture, n)| format!("{fixture}_{n}")).collect();
        if names.is_empty() {
            return Ok(Vec::new());
        }
        let program = programs.iter().find(|program| program.name == self.name);
        let program = program.ok_or_else(|| format!("there is no benchmark `{}`", self.name))?;
        let folder = folder.join(self.name);
        make_empty(&folder)?;
        let mut command = std::process::Command::new(&program.executable);
        command.env("EIGENSYNC_FIXTURES", &folder).env("EIGENSYNC_LARGEST", largest.to_string());
        if status(&mut command)? != 0 {
            return Err(format!("the fixtures of {} could not be written", self.name));
        }
        // Two rules for clusters share a file.
        names.iter_mut().for_each(|name| {
            *name = name.replace("_exact_", "_").replace("_threshold_", "_");
        });
        names.sort();
        names.dedup();
        let file = |name: &String| folder.join(format!("{name}.{}", self.extension));
        Ok(names.iter().map(file).filter(|file| file.exists()).collect())
    }

    /// Adds eigensync's rows before those that the peers have left in this folder.
    pub fn complete(
        &self,
        measured: &[Benchmark],
        ours: &str,
        found: &Path,
        folder: &Path,
    ) -> Result<(), String> {
        let found = read_if_there(&found.join(self.file()))?.unwrap_or_default();
        let found: HashMap<&str, &str> =
            found.lines().filter_map(|line| line.split_once(',')).collect();
        let mut csv = format!("fixture,implementation,seconds,{}\n", self.found);
        let mut is_empty = true;
        let nothing = ",".repeat(self.found.matches(',').count());
        for benchmark in measured {
            let Some((fixture, n_nodes)) = self.fixture(&benchmark.id) else { continue };
            let found = found.get(&*benchmark.id).copied().unwrap_or(&nothing);
            writeln!(csv, "{fixture}_{n_nodes},{ours},{:.4e},{found}", benchmark.best)
                .expect("a string can always grow");
            is_empty = false;
        }
        if let Some(peers) = read_if_there(&folder.join(self.file()))? {
            csv.extend(peers.lines().skip(1).flat_map(|line| [line, "\n"]));
        }
        if is_empty { Ok(()) } else { write(&folder.join(self.file()), &csv) }
    }

    /// The rows of a run, none where the operation was not measured.
    pub fn rows(&self, run: &Path) -> Result<Vec<Row>, String> {
        let text = read_if_there(&run.join(self.file()))?.unwrap_or_default();
        let row = |line: &str| {
            let mut cells = line.splitn(4, ',');
            let mut cell = || cells.next().map(str::to_owned);
            let (fixture, implementation) = (cell()?, cell()?);
            let seconds = cell()?.parse().ok()?;
            Some(Row { fixture, implementation, seconds, found: cell()? })
        };
        text.lines()
            .skip(1)
            .map(|line| row(line).ok_or_else(|| format!("{}: {line}", self.file())))
            .collect()
    }

    /// A table of seconds: fixtures are rows, implementations columns, eigensync first.
    pub fn markdown(&self, rows: &[Row]) -> String {
        let distinct = |of: fn(&Row) -> &str| {
            let mut names: Vec<&str> = Vec::new();
            for row in rows {
                if !names.contains(&of(row)) {
                    names.push(of(row));
                }
            }
            names
        };
        let implementations = distinct(|row| &row.implementation);
        let mut table = format!("| {} | {} |\n", self.title, implementations.join(" | "));
        writeln!(table, "| --- |{}", " ---: |".repeat(implementations.len())).expect(GROWS);
        for fixture in distinct(|row| &row.fixture) {
            write!(table, "| {fixture} |").expect(GROWS);
            for implementation in &implementations {
                let is_it =
                    |row: &&Row| row.fixture == fixture && row.implementation == *implementation;
                let cell = rows.iter().find(is_it).map(|row| digits(row.seconds));
                write!(table, " {} |", cell.unwrap_or_default()).expect(GROWS);
            }
            table.push('\n');
        }
        table
    }

    fn file(&self) -> String {
        format!("{}.csv", self.name)
    }

    /// OPERATION/FIXTURE/SIZE taken apart, if it is this operation.
    fn fixture<'a>(&self, id: &'a str) -> Option<(&'a str, usize)> {
        let (fixture, size) = id.strip_prefix(self.name)?.strip_prefix('/')?.rsplit_once('/')?;
        Some((fixture, size.parse().ok()?))
    }
}

/// Three digits, without an exponent.
pub(super) fn digits(seconds: f64) -> String {
    let places = (2.0 - seconds.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{seconds:.places$}")
}

const GROWS: &str = "a string can always grow";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigensync_comes_first_and_what_it_found_beside_its_time() {
        let folder = std::env::temp_dir().join(format!("xtask-large-{}", std::process::id()));
        let found = folder.join("found");
        std::fs::create_dir_all(&found).unwrap();
        let peers = "fixture,implementation,seconds,clusters\nring_exact_10,Tool,0.5,3\n";
        std::fs::write(folder.join("clusters.csv"), peers).unwrap();
        std::fs::write(found.join("clusters.csv"), "clusters/ring_exact/10,3\n").unwrap();
        let timed = |id: &str, best| Benchmark {
            id: id.into(),
            mean: best,
            standard_error: 0.0,
            best,
            throughput: None,
        };
        let measured = [timed("clusters/ring_exact/10", 0.25), timed("peak/avx2", 1.0)];
        let clusters = &OPERATIONS[1];
        clusters.complete(&measured, "eigensync", &found, &folder).unwrap();
        let rows = clusters.rows(&folder).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!((rows.len(), &*rows[0].found, rows[1].seconds), (2, "3", 0.5));
        let table = clusters.markdown(&rows);
        assert!(table.ends_with(
            "| eigensync | Tool |\n| --- | ---: | ---: |\n| ring_exact_10 | 0.250 | 0.500 |\n"
        ));
    }

    #[test]
    fn times_have_three_digits() {
        assert_eq!(digits(0.000_037_24), "0.0000372");
        assert_eq!((digits(1.5), digits(123.4)), ("1.50".into(), "123".into()));
    }
}
