//! How much model time a second at equal error: each peer beside eigensync at the error that the peer has
//! after a unit of time, with as many replicas.
//!
//! Errors of eigensync's methods at some steps stand in `errors.csv`, speeds in `simulation.csv`. At a step in
//! between, or up to twice as long or as short, the error follows from the order p of the method, as hᵖ, and
//! the speed is in proportion to h; the faster method counts.

use std::fmt::Write;

use serde::Deserialize;

use super::simulation::Row;

/// How far from a step that was measured others are taken to follow its law.
const REACH: f64 = 2.0;
/// One replica, and as many as eigensync advances together.
const LANES: [u32; 2] = [1, 16];

/// A line of `errors.csv`: the largest error of x at time 1 by one of eigensync's methods.
#[derive(Debug, Deserialize)]
struct Measured {
    fixture: String,
    method: String,
    order: i32,
    step: f64,
    largest_error_at_1: f64,
}

/// A line of `peers.csv`.
#[derive(Debug, Deserialize)]
struct Peer {
    fixture: String,
    implementation: String,
    lanes: u32,
    node_steps_per_s: f64,
    largest_error_at_1: f64,
}

/// The table in Markdown; none without peers or without errors.
pub fn markdown(rows: &[Row], peers: &str, errors: &str) -> Result<Option<String>, String> {
    let errors: Vec<Measured> = lines(errors, "errors.csv")?;
    let peers: Vec<Peer> = lines(peers, "peers.csv")?;
    let mut fixtures: Vec<&str> = errors.iter().map(|measured| measured.fixture.as_str()).collect();
    fixtures.dedup();
    let mut names: Vec<&str> = peers.iter().map(|peer| peer.implementation.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    if names.is_empty() || fixtures.is_empty() {
        return Ok(None);
    }
    let mut table = String::from("| at equal error |");
    for fixture in &fixtures {
        write!(table, " {fixture}: error |").expect(GROWS);
        LANES.iter().for_each(|lanes| write!(table, " {lanes} at once |").expect(GROWS));
    }
    table.push_str("\n| --- |");
    fixtures.iter().for_each(|_| table.push_str(" ---: | ---: | ---: |"));
    table.push('\n');
    for name in names {
        write!(table, "| {name} |").expect(GROWS);
        for fixture in &fixtures {
            let of = |lanes: u32| {
                // What advances one replica at a time takes as long for each of sixteen.
                let same = |peer: &&Peer| peer.fixture == *fixture && peer.implementation == name;
                let with = |n: u32| peers.iter().filter(same).find(|peer| peer.lanes == n);
                with(lanes).or_else(|| with(1))
            };
            let error =
                of(16).map_or_else(String::new, |p| format!("{:.0e}", p.largest_error_at_1));
            write!(table, " {error} |").expect(GROWS);
            for lanes in LANES {
                let factor = of(lanes).and_then(|peer| {
                    let at = peer.largest_error_at_1;
                    Some(speed(rows, &errors, (fixture, lanes), at)? / peer.node_steps_per_s)
                });
                let factor = factor.map_or_else(String::new, |factor| format!("{factor:.1}"));
                write!(table, " {factor} |").expect(GROWS);
            }
        }
        table.push('\n');
    }
    Ok(Some(table))
}

const GROWS: &str = "a string can always grow";

/// Node-steps of 0.01 a second of eigensync at an error.
fn speed(
    rows: &[Row],
    errors: &[Measured],
    (fixture, lanes): (&str, u32),
    error: f64,
) -> Option<f64> {
    let by = |measured: &Measured| {
        let is_same = |row: &&Row| {
            (row.fixture.as_str(), row.lanes) == (fixture, lanes) && row.method() == measured.method
        };
        let row = rows.iter().find(is_same)?;
        // A step is a step, however long it is.
        let step = row.step();
        let ratio = (error / measured.largest_error_at_1).powf(1.0 / f64::from(measured.order));
        let reached = (1.0 / REACH..=REACH).contains(&ratio);
        reached.then(|| row.node_steps_per_s / step * measured.step * ratio)
    };
    let of_fixture = errors.iter().filter(|measured| measured.fixture == fixture);
    of_fixture.filter_map(by).reduce(f64::max)
}

fn lines<T: for<'a> Deserialize<'a>>(text: &str, name: &str) -> Result<Vec<T>, String> {
    csv::Reader::from_reader(text.as_bytes())
        .into_deserialize()
        .collect::<Result<_, _>>()
        .map_err(|error| format!("{name} is not understood: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(implementation: &str, node_steps_per_s: f64) -> Row {
        let (fixture, lanes, share_of_peak) = ("ring10".to_owned(), 16, None);
        Row {
            fixture,
            implementation: implementation.into(),
            lanes,
            node_steps_per_s,
            share_of_peak,
        }
    }

    #[test]
    fn a_longer_step_is_faster_by_as_much_and_errs_by_the_order() {
        let rows = [row("eigensync", 100.0), row("eigensync in steps of 0.1 of dop853", 300.0)];
        let errors = "fixture,method,order,step,largest_error_at_1\n\
                      ring10,rk4,4,0.01,1e-8\nring10,dop853,8,0.1,1e-10\n";
        let peers = "fixture,implementation,lanes,node_steps_per_s,largest_error_at_1,seconds_to_start\n\
                     ring10,Tool,1,100,1.6e-7,0.1\nring10,Tool 2,16,150,1e-10,0.1\n";
        let table = markdown(&rows, peers, errors).unwrap().unwrap();
        let lines: Vec<&str> = table.lines().skip(2).collect();
        // RK4 at twice the step: 200; DOP853 at 0.1 · 1600^(1/8) = 0.25 is beyond its reach.
        assert_eq!(lines[0], "| Tool | 2e-7 |  | 2.0 |");
        assert_eq!(lines[1], "| Tool 2 | 1e-10 |  | 2.0 |");
    }
}
