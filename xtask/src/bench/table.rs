//! The tables of docs/performance.md, made from `simulation.csv` and `all.csv` of a run, with its
//! notes: each that the run has something for.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use super::simulation::{Row, from_csv};
use super::{criterion, equal_error, growth, large, read, read_if_there, write};
use crate::root;

/// Where the table of simulations stands on the page.
const SIMULATION: [&str; 2] = [
    "<!-- Made by `cargo xtask bench --table`; changes here are lost. -->",
    "<!-- End of what `cargo xtask bench --table` makes. -->",
];
/// Where the table of growth stands.
const GROWTH: [&str; 2] = [
    "<!-- Growth, made by `cargo xtask bench --table`; changes here are lost. -->",
    "<!-- End of the growth that `cargo xtask bench --table` makes. -->",
];

/// Where the tables of leading modes and of clusters stand.
const LARGE: [&str; 2] = [
    "<!-- Modes and clusters, made by `cargo xtask bench --table`; changes here are lost. -->",
    "<!-- End of the modes and clusters that `cargo xtask bench --table` makes. -->",
];

/// Replaces the tables of docs/performance.md by those of a run, the newest unless one is given.
pub fn update(runs: &Path, run: Option<&Path>) -> Result<u8, String> {
    let run = match run {
        Some(run) => run.to_owned(),
        None => newest(runs)?,
    };
    let rows = from_csv(&read(&run.join("simulation.csv"))?)?;
    let benchmarks = criterion::from_csv(&read(&run.join("all.csv"))?)?;
    let notes = read_if_there(&run.join("notes.txt"))?.unwrap_or_default();
    let path = root().join("docs/performance.md");
    let name = run.file_name().unwrap_or_default().to_string_lossy();
    let with_notes = |table: String| {
        let mut text = format!("Run [{name}](../benches/runs/{name}/).\n\n{table}");
        if !notes.is_empty() {
            text.push_str("\nNotes of the run:\n\n");
        }
        text.extend(notes.lines().map(|note| format!("- {note}\n")));
        text
    };
    let mut page = read(&path)?;
    if !rows.is_empty() {
        let mut tables = markdown(&rows);
        if let Some(table) = at_equal_error(&rows, &run)? {
            write!(tables, "\n{table}").expect(GROWS);
        }
        page = replace(&page, SIMULATION, &with_notes(tables))?;
    }
    if let Some(table) = growth::markdown(&benchmarks) {
        page = replace(&page, GROWTH, &with_notes(table))?;
    }
    if let Some(tables) = modes_and_clusters(&run)? {
        page = replace(&page, LARGE, &with_notes(tables))?;
    }
    write(&path, &page)?;
    println!("{}: the tables of {}", path.display(), run.display());
    Ok(0)
}

/// The table of peers at equal error, none where the run has measured none.
pub fn at_equal_error(rows: &[Row], run: &Path) -> Result<Option<String>, String> {
    let files = ["peers.csv", "errors.csv"].map(|name| read_if_there(&run.join(name)));
    let [Some(peers), Some(errors)] = [files[0].clone()?, files[1].clone()?] else {
        return Ok(None);
    };
    equal_error::markdown(rows, &peers, &errors)
}

/// Tables of the operations on large networks, none where the run has measured none.
pub fn modes_and_clusters(run: &Path) -> Result<Option<String>, String> {
    let mut tables = Vec::new();
    for operation in &large::OPERATIONS {
        let rows = operation.rows(run)?;
        if !rows.is_empty() {
            tables.push(operation.markdown(&rows));
        }
    }
    Ok((!tables.is_empty()).then(|| tables.join("\n")))
}

/// The run that was measured last.
fn newest(runs: &Path) -> Result<PathBuf, String> {
    let measured =
        |path: &Path| fs::metadata(path.join("machine.json")).and_then(|file| file.modified());
    fs::read_dir(runs)
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|entry| Some((measured(&entry.path()).ok()?, entry.path())))
        .max()
        .map(|(_, path)| path)
        .ok_or_else(|| {
            format!(
                "{} holds no run\n\nhint: `cargo xtask bench --peers` makes one",
                runs.display()
            )
        })
}

/// The page with what stands between the two marks replaced.
fn replace(page: &str, [begin, end]: [&str; 2], table: &str) -> Result<String, String> {
    let cut =
        page.split_once(begin).and_then(|(before, rest)| Some((before, rest.split_once(end)?.1)));
    let (before, after) =
        cut.ok_or_else(|| format!("docs/performance.md lacks the marks\n    {begin}\n    {end}"))?;
    Ok(format!("{before}{begin}\n\n{table}\n{end}{after}"))
}

/// Two tables: all methods of a fixed step, then all that choose their own.
///
/// Implementations are rows, fixtures stand side by side; the fastest on the first fixture comes
/// first. Of each fixture: million node-steps a second, their share of the peak where the step is
/// fixed, and by what factor eigensync's largest ensemble is faster.
pub fn markdown(rows: &[Row]) -> String {
    let mut fixtures: Vec<&str> = rows.iter().map(|row| row.fixture.as_str()).collect();
    fixtures.sort_unstable();
    fixtures.dedup();
    let (adaptive, fixed): (Vec<&Row>, Vec<&Row>) = rows.iter().partition(|row| row.is_adaptive());
    let best: Vec<_> = fixtures.iter().map(|fixture| largest_ensemble(rows, fixture)).collect();
    let mut tables = table(&fixed, &fixtures, &best, true);
    if !adaptive.is_empty() {
        tables.push('\n');
        tables.push_str(&table(&adaptive, &fixtures, &best, false));
    }
    tables
}

fn table(rows: &[&Row], fixtures: &[&str], best: &[Option<&Row>], with_share: bool) -> String {
    let find = |fixture: &str, which| {
        rows.iter().find(|row| row.fixture == fixture && implementation(row) == which).copied()
    };
    let speed = |which| {
        let row = fixtures.iter().find_map(|fixture| find(fixture, which));
        row.map_or(0.0, |row| row.node_steps_per_s)
    };
    let mut implementations: Vec<_> = rows.iter().map(|row| implementation(row)).collect();
    implementations.sort_unstable();
    implementations.dedup();
    implementations.sort_by(|&a, &b| speed(b).total_cmp(&speed(a)));

    let (method, share) =
        if with_share { ("fixed step 0.01", " share of peak |") } else { ("its own steps", "") };
    let mut table = format!("| {method} | replicas at once |");
    for fixture in fixtures {
        let rate = "10⁶ node-steps/s";
        write!(table, " {fixture}: {rate} |{share} eigensync is faster by |").expect(GROWS);
    }
    let n_columns = 1 + fixtures.len() * if with_share { 3 } else { 2 };
    writeln!(table, "\n| --- |{}", " ---: |".repeat(n_columns)).expect(GROWS);
    for which in implementations {
        write!(table, "| {} | {} |", which.0, which.1).expect(GROWS);
        for (fixture, best) in fixtures.iter().zip(best) {
            table.push_str(&cells(find(fixture, which), *best, with_share));
        }
        table.push('\n');
    }
    table
}

fn implementation(row: &Row) -> (&str, u32) {
    (&row.implementation, row.lanes)
}

/// eigensync with as many replicas at once as were measured on a fixture.
fn largest_ensemble<'a>(rows: &'a [Row], fixture: &str) -> Option<&'a Row> {
    rows.iter()
        .filter(|row| row.fixture == fixture && row.implementation.starts_with("eigensync"))
        .max_by_key(|row| row.lanes)
}

/// The cells of a row for one fixture, empty where nothing was measured.
fn cells(row: Option<&Row>, eigensync: Option<&Row>, with_share: bool) -> String {
    let speed = row.map(|row| format!("{:.1}", row.node_steps_per_s / 1e6));
    let share =
        row.and_then(|row| row.share_of_peak).map(|share| format!("{:.1} %", 100.0 * share));
    let factor = row
        .zip(eigensync)
        .map(|(row, best)| format!("{:.1}", best.node_steps_per_s / row.node_steps_per_s));
    let [speed, share, factor] = [speed, share, factor].map(Option::unwrap_or_default);
    if with_share {
        format!(" {speed} | {share} | {factor} |")
    } else {
        format!(" {speed} | {factor} |")
    }
}

const GROWS: &str = "a string can always grow";

#[cfg(test)]
mod tests {
    use super::*;

    fn row(fixture: &str, implementation: &str, lanes: u32, node_steps_per_s: f64) -> Row {
        let [fixture, implementation] = [fixture, implementation].map(str::to_owned);
        Row { fixture, implementation, lanes, node_steps_per_s, share_of_peak: None }
    }

    #[test]
    fn factors_are_those_of_the_largest_ensemble_and_gaps_stay_empty() {
        let rows = [
            row("ring10", "eigensync 1", 1, 2e6),
            row("ring10", "eigensync 1", 16, 20e6),
            row("star20", "eigensync 1", 16, 10e6),
            row("ring10", "Tool 1", 1, 4e6),
            row("star20", "Tool 1 at tolerance 1e-6", 1, 40e6),
        ];
        let table = markdown(&rows);
        let lines: Vec<_> = table.lines().skip(2).collect();
        assert_eq!(lines[0], "| eigensync 1 | 16 | 20.0 |  | 1.0 | 10.0 |  | 1.0 |");
        assert_eq!(lines[1], "| Tool 1 | 1 | 4.0 |  | 5.0 |  |  |  |");
        assert_eq!(lines[2], "| eigensync 1 | 1 | 2.0 |  | 10.0 |  |  |  |");
        assert_eq!(lines[6], "| Tool 1 at tolerance 1e-6 | 1 |  |  | 40.0 | 0.2 |");
    }

    #[test]
    fn only_what_stands_between_the_marks_is_replaced() {
        let [begin, end] = GROWTH;
        let page = format!("before\n{begin}\nold\n{end}\nafter\n");
        let replaced = replace(&page, GROWTH, "new\n").unwrap();
        assert_eq!(replaced, format!("before\n{begin}\n\nnew\n\n{end}\nafter\n"));
        assert_eq!(replace(&replaced, GROWTH, "new\n").unwrap(), replaced);
        assert!(replace(&replaced, SIMULATION, "new\n").is_err());
    }
}
