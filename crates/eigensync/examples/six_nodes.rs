//! From an edge list to clusters, critical couplings, a sweep and its agreement.
//!
//! `cargo run --release -p eigensync --example six_nodes`

use std::fs::File;
use std::sync::Arc;

use eigensync::dynamics::{Coupling, Lorenz, Native};
use eigensync::graph::Normalization;
use eigensync::graph::formats::edge_list;
use eigensync::numbers::{four_digits, with_error};
use eigensync::{Node, Study, Sweep, find};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../experiments/networks/six-node.edges");
    let network = edge_list::read(File::open(file)?)?;
    let lorenz = Arc::new(Native::new(Lorenz::default()));
    let node = Node { dynamics: lorenz, coupling: Coupling::pair(0, 1) };
    let mut study = Study::new(network, Normalization::Laplacian, node);
    study.sweep = Some(Sweep::over(vec![0.5, 1.5, 3.0, 4.5]));

    let found = find(&study, &())?;
    println!("{}", found.synchrony.verdict);
    for transition in &found.transitions {
        let epsilon = with_error(transition.epsilon, transition.standard_error);
        println!(
            "the mode of lambda = {} is stable from epsilon = {epsilon} on",
            four_digits(transition.lambda)
        );
    }
    for state in &found.cascade {
        println!("above {}: {:?}", four_digits(state.epsilon.0), state.clusters.clusters());
    }
    let simulated = found.simulated.as_ref().expect("a sweep was asked for");
    for (position, epsilon) in simulated.epsilon.iter().enumerate() {
        let clusters = simulated.clusters(position).map(|clusters| clusters.clusters());
        let index = found.agreement[position].rand_index;
        println!("at {epsilon}: simulated {clusters:?}, adjusted Rand index {index:?}");
    }
    for warning in &found.warnings {
        println!("{}: {}", warning.about, warning.message);
    }
    Ok(())
}
