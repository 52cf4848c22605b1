//! Readers of network formats: files that third-party tools wrote, and what is refused and where.
//!
//! `fixtures/make_fixtures.py` wrote the files; the matrices below are those that it states.

mod dense;
mod graphml;
mod matlab;
mod matrix_market;
mod numpy;
mod table;
mod tvb;

use graph::RawNetwork;
use graph::formats::{Layout, Rows};

/// Four nodes: a ring of unequal weights and one chord.
const SYMMETRIC: [[f64; 4]; 4] =
    [[0.0, 1.5, 0.0, 2.0], [1.5, 0.0, 0.25, 1.0], [0.0, 0.25, 0.0, 3.0], [2.0, 1.0, 3.0, 0.0]];

/// Three nodes: a directed triangle with a way back and a self-loop.
const DIRECTED: [[f64; 3]; 3] = [[0.0, 2.0, 0.0], [0.0, 5.0, 1.0], [3.0, 4.0, 0.0]];

/// The bytes of a fixture.
macro_rules! fixture {
    ($name:literal) => {
        &include_bytes!(concat!("../fixtures/", $name))[..]
    };
}
use fixture;

fn whole() -> Layout {
    Layout::default()
}

fn block(start: usize, end: usize) -> Layout {
    Layout { block: Some(start..end), ..Layout::default() }
}

fn driving() -> Layout {
    Layout { rows: Rows::Driving, block: None }
}

fn dense<const N: usize>(network: &RawNetwork) -> [[f64; N]; N] {
    assert_eq!(network.n_nodes(), N);
    let mut matrix = [[0.0; N]; N];
    for (i, row) in network.matrix().outer_iterator().enumerate() {
        for (j, &value) in row.iter() {
            matrix[i][j] = value;
        }
    }
    matrix
}

fn transposed<const N: usize>(matrix: [[f64; N]; N]) -> [[f64; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[j][i]))
}

/// The message of an error that something must be.
#[track_caller]
fn refusal<E: std::fmt::Display>(result: Result<RawNetwork, E>) -> String {
    match result {
        Ok(network) => panic!("read as {network:?}"),
        Err(error) => error.to_string(),
    }
}
