//! An oscillator and a coupling matrix of one's own: FitzHugh–Nagumo neurons on a ring, each driving
//! the next two on either side through a rotation, as in I. Omelchenko et al., PRL 110, 224101 (2013).
//!
//! `cargo run --release -p eigensync --example own_oscillator`

use std::sync::Arc;

use eigensync::dynamics::lyapunov::{Integrator, Times};
use eigensync::dynamics::{Coupling, Native, Oscillator, Scalar};
use eigensync::graph::Normalization;
use eigensync::graph::formats::edge_list;
use eigensync::{Node, Study, find};

/// u̇ = (u − u³/3 − v)/ε, v̇ = u + a.
#[derive(Clone, Copy, Debug)]
struct FitzHughNagumo {
    epsilon: f64,
    a: f64,
}

impl Oscillator<2> for FitzHughNagumo {
    const COMPONENTS: [&'static str; 2] = ["u", "v"];
    const START: [[f64; 2]; 2] = [[-2.0, 2.0], [-1.0, 1.0]];

    #[inline(always)]
    fn flow<S: Scalar>(&self, [u, v]: [S; 2]) -> [S; 2] {
        [(u - u * u * u * (1.0 / 3.0) - v) * (1.0 / self.epsilon), u + S::from(self.a)]
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let n_nodes = 12;
    let links = |node: usize| format!("{node} {}\n{node} {}\n", (node + 1) % 12, (node + 2) % 12);
    let ring: String = (0..n_nodes).map(links).collect();
    let network = edge_list::read(ring.as_bytes())?;

    let neuron = FitzHughNagumo { epsilon: 0.05, a: 0.5 };
    let (sin, cos) = 0.4f64.sin_cos();
    // What enters u̇ is larger by 1/ε.
    let rotation = [vec![cos / neuron.epsilon, sin / neuron.epsilon], vec![-sin, cos]];
    let node =
        Node { dynamics: Arc::new(Native::new(neuron)), coupling: Coupling::matrix(&rotation) };
    let mut study = Study::new(network, Normalization::Laplacian, node);
    study.msf.sigma = (0..=40).map(|k| 0.05 * f64::from(k)).collect();
    study.msf.times = Times {
        integrator: Integrator::Rk4,
        step: 0.001,
        transient: 50.0,
        average: 500.0,
        renormalise: 0.1,
    };

    let found = find(&study, &())?;
    let exponent = found.msf.isolated;
    println!("Lambda(0) = {} ± {}", exponent.mean, exponent.standard_error);
    println!("{}", found.synchrony.verdict);
    for warning in &found.warnings {
        println!("{}: {}", warning.about, warning.message);
    }
    Ok(())
}
