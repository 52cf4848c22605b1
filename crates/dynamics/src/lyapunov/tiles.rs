//! The master equation of equations that are chosen at run time, sixteen tangents side by side, and all
//! exponents of one orbit: the same operations as those of compiled equations, through memory.

use super::growth::{Growing, Tangents, estimates, log};
use crate::integrators::rk4::STAGES;
use crate::random::initial_states;
use crate::tile::{TILE, Tile, slices, slices_mut};
use crate::{
    DynamicsError, ESCAPE_RADIUS, Estimate, InstructionSet, Linearised, LinearisedMut, NodeDynamics,
};

/// Exponents of equations that are chosen at run time.
pub(super) fn exponents(
    dynamics: &dyn NodeDynamics,
    set: InstructionSet,
    tangents: &Tangents<'_>,
) -> Result<Vec<Estimate>, DynamicsError> {
    let Tangents { coupling, plan, tangents, progress } = tangents;
    // Numbers beyond the tangents repeat the last one and are never read.
    let tangent = |number: usize| tangents[number.min(tangents.len() - 1)];
    let sigma = |weight| std::array::from_fn(|number| tangent(number).sigma * weight);
    let damping = coupling.derivative().map(|(d, c, weight)| (d, c, sigma(weight)));
    let orbits: [Vec<f64>; TILE] =
        std::array::from_fn(|number| initial_states(dynamics.start(), 1, tangent(number).seed));
    let n_components = dynamics.start().len();
    let value = |c: usize| std::array::from_fn(|number: usize| orbits[number][c]);
    let mut tiles = Tiles {
        dynamics,
        set,
        damping: damping.collect(),
        value: (0..n_components).map(value).collect(),
        tangent: vec![[1.0; TILE]; n_components],
        orthonormal: false,
    };
    let count = tangents.len();
    let blocks = plan.block_means(&mut tiles, |steps| progress(steps * count as u64))?;
    Ok(estimates(&blocks, count))
}

/// Orbits with a tangent each, `[component][number]`.
pub(super) struct Tiles<'a> {
    dynamics: &'a dyn NodeDynamics,
    set: InstructionSet,
    /// Equation, component and σ B of every entry of DH.
    damping: Vec<(usize, usize, Tile)>,
    value: Vec<Tile>,
    tangent: Vec<Tile>,
    /// Whether tangents are made orthonormal, number by number, rather than of unit length.
    orthonormal: bool,
}

impl<'a> Tiles<'a> {
    /// One isolated orbit with tangents along all axes, which are kept orthonormal.
    pub(super) fn axes(dynamics: &'a dyn NodeDynamics, set: InstructionSet, seed: u64) -> Self {
        let start = initial_states(dynamics.start(), 1, seed);
        let axis = |c: usize| std::array::from_fn(|number| f64::from(u8::from(number == c)));
        Self {
            dynamics,
            set,
            damping: Vec::new(),
            value: start.iter().map(|&x| [x; TILE]).collect(),
            tangent: (0..start.len()).map(axis).collect(),
            orthonormal: true,
        }
    }

    fn slope(&self, at: &[Vec<Tile>; 2], slope: &mut [Vec<Tile>; 2]) {
        let n = self.value.len();
        let [value, tangent] = at.each_ref().map(|tiles| slices(tiles.iter().map(Tile::as_slice)));
        let [of_value, of_tangent] = slope;
        let mut to_value = slices_mut(of_value.iter_mut().map(Tile::as_mut_slice));
        let mut to_tangent = slices_mut(of_tangent.iter_mut().map(Tile::as_mut_slice));
        self.dynamics.tangent_flow(
            self.set,
            Linearised { value: &value[..n], tangent: &tangent[..n] },
            LinearisedMut { value: &mut to_value[..n], tangent: &mut to_tangent[..n] },
        );
        for (equation, component, sigma) in &self.damping {
            for number in 0..TILE {
                of_tangent[*equation][number] -= sigma[number] * at[1][*component][number];
            }
        }
    }

    /// Takes away what a tangent has of those before it.
    fn project(&mut self, number: usize) {
        for before in 0..number {
            let overlap: f64 = self.tangent.iter().map(|x| x[number] * x[before]).sum();
            for x in &mut self.tangent {
                x[number] -= overlap * x[before];
            }
        }
    }
}

impl Growing<TILE> for Tiles<'_> {
    fn advance(&mut self, n_steps: u64, h: f64) {
        let mut ahead = [self.value.clone(), self.tangent.clone()];
        let (mut sum, mut slope) = (ahead.clone(), ahead.clone());
        for _ in 0..n_steps {
            for (weight, advance) in STAGES {
                self.slope(&ahead, &mut slope);
                for (part, state) in [&self.value, &self.tangent].into_iter().enumerate() {
                    let (state, slope) = (state.as_flattened(), slope[part].as_flattened());
                    let sum = sum[part].as_flattened_mut();
                    let ahead = ahead[part].as_flattened_mut();
                    for k in 0..state.len() {
                        sum[k] += slope[k] * (weight * h);
                        ahead[k] = state[k] + slope[k] * (advance * h);
                    }
                }
            }
            self.value.clone_from(&sum[0]);
            self.tangent.clone_from(&sum[1]);
            ahead.clone_from(&sum);
        }
    }

    fn is_bounded(&self) -> bool {
        self.value.as_flattened().iter().all(|x| x.abs() < ESCAPE_RADIUS)
    }

    fn renormalise(&mut self) -> [f64; TILE] {
        // Of as many tangents as components no more can be orthogonal.
        let n_tangents = if self.orthonormal { self.value.len() } else { TILE };
        let mut logs = [0.0; TILE];
        for (number, log_of) in logs.iter_mut().enumerate().take(n_tangents) {
            if self.orthonormal {
                self.project(number);
            }
            let square = |x: &Tile| x[number] * x[number];
            let length = self.tangent.iter().map(square).sum::<f64>().sqrt();
            for x in &mut self.tangent {
                x[number] /= length;
            }
            *log_of = log(length);
        }
        logs
    }
}
