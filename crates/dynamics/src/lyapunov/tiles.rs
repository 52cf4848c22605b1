//! The master equation of equations that are chosen at run time, many tangents side by side, and all
//! exponents of one orbit: the same operations as those of compiled equations, through memory.

use super::growth::{Growing, Tangents, estimates, length, log, vanished};
use crate::instruction_set::Work;
use crate::integrators::rk4::STAGES;
use crate::random::initial_states;
use crate::tile::{TILE, slices, slices_mut};
use crate::{
    Coupling, DynamicsError, Estimate, InstructionSet, Linearised, LinearisedMut, NodeDynamics,
};

/// Tangents that are advanced together at the most: enough that calling the equations costs nothing beside.
pub(super) const MOST: usize = 128;

/// Exponents of equations that are chosen at run time, at most [`MOST`].
pub(super) fn exponents(
    dynamics: &dyn NodeDynamics,
    set: InstructionSet,
    tangents: &Tangents<'_>,
) -> Result<Vec<Estimate>, DynamicsError> {
    match tangents.tangents.len() {
        0..=16 => exponents_of::<16>(dynamics, set, tangents),
        17..=32 => exponents_of::<32>(dynamics, set, tangents),
        33..=64 => exponents_of::<64>(dynamics, set, tangents),
        _ => exponents_of::<MOST>(dynamics, set, tangents),
    }
}

fn exponents_of<const L: usize>(
    dynamics: &dyn NodeDynamics,
    set: InstructionSet,
    tangents: &Tangents<'_>,
) -> Result<Vec<Estimate>, DynamicsError> {
    let Tangents { coupling, plan, tangents, progress, .. } = tangents;
    // Numbers beyond the tangents repeat the last one and are never read.
    let tangent = |number: usize| tangents[number.min(tangents.len() - 1)];
    let sigma = |weight| std::array::from_fn(|number| tangent(number).sigma * weight);
    let orbits: [Vec<f64>; L] =
        std::array::from_fn(|number| initial_states(dynamics.start(), 1, tangent(number).seed));
    let n_components = dynamics.start().len();
    let value = |c: usize| std::array::from_fn(|number: usize| orbits[number][c]);
    let mut tiles = Tiles {
        dynamics,
        set,
        damping: Some(Damping {
            coupling,
            sigma: coupling.gains().iter().map(|gain| sigma(gain.weight)).collect(),
            sent: std::array::from_fn(|_| vec![[0.0; L]; coupling.n_channels()]),
        }),
        value: (0..n_components).map(value).collect(),
        tangent: (0..n_components)
            .map(|c| [f64::from(u8::from(c < dynamics.n_free())); L])
            .collect(),
        orthonormal: false,
    };
    let count = tangents.len();
    let blocks = plan.block_means(&mut tiles, |steps| progress(steps * count as u64))?;
    Ok(estimates(&blocks, count))
}

/// Orbits with a tangent each, `[component][number]`.
pub(super) struct Tiles<'a, const L: usize> {
    dynamics: &'a dyn NodeDynamics,
    set: InstructionSet,
    /// None for an isolated oscillator.
    damping: Option<Damping<'a, L>>,
    value: Vec<[f64; L]>,
    tangent: Vec<[f64; L]>,
    /// Whether tangents are made orthonormal, number by number, rather than of unit length.
    orthonormal: bool,
}

/// What coupling takes from the growth of tangents, σ B Dh(s) δ.
struct Damping<'a, const L: usize> {
    coupling: &'a Coupling,
    /// σ B of every entry of B.
    sigma: Vec<[f64; L]>,
    /// h(s) and Dh(s) δ, channel by channel.
    sent: [Vec<[f64; L]>; 2],
}

impl<const L: usize> Damping<'_, L> {
    /// Takes it from the slopes of tangents.
    fn damp(&mut self, set: InstructionSet, at: Linearised<'_>, slopes: &mut [[f64; L]]) {
        let [of_value, of_tangent] = &mut self.sent;
        let n = of_value.len();
        let mut to_value = slices_mut(of_value.iter_mut().map(<[f64; L]>::as_mut_slice));
        let mut to_tangent = slices_mut(of_tangent.iter_mut().map(<[f64; L]>::as_mut_slice));
        let to = LinearisedMut { value: &mut to_value[..n], tangent: &mut to_tangent[..n] };
        self.coupling.send(set, at, to);
        for (gain, sigma) in self.coupling.gains().iter().zip(&self.sigma) {
            for number in 0..L {
                slopes[gain.equation][number] -= sigma[number] * of_tangent[gain.channel][number];
            }
        }
    }
}

impl<'a> Tiles<'a, TILE> {
    /// One isolated orbit with tangents along all axes, which are kept orthonormal.
    pub(super) fn axes(dynamics: &'a dyn NodeDynamics, set: InstructionSet, seed: u64) -> Self {
        let start = initial_states(dynamics.start(), 1, seed);
        let axis = |c: usize| std::array::from_fn(|number| f64::from(u8::from(number == c)));
        Self {
            dynamics,
            set,
            damping: None,
            value: start.iter().map(|&x| [x; TILE]).collect(),
            tangent: (0..start.len()).map(axis).collect(),
            orthonormal: true,
        }
    }
}

impl<const L: usize> Tiles<'_, L> {
    fn slope(&mut self, at: &[Vec<[f64; L]>; 2], slope: &mut [Vec<[f64; L]>; 2]) {
        let n = self.value.len();
        let [value, tangent] =
            at.each_ref().map(|tiles| slices(tiles.iter().map(<[f64; L]>::as_slice)));
        let [of_value, of_tangent] = slope;
        let mut to_value = slices_mut(of_value.iter_mut().map(<[f64; L]>::as_mut_slice));
        let mut to_tangent = slices_mut(of_tangent.iter_mut().map(<[f64; L]>::as_mut_slice));
        let at = Linearised { value: &value[..n], tangent: &tangent[..n] };
        let to = LinearisedMut { value: &mut to_value[..n], tangent: &mut to_tangent[..n] };
        self.dynamics.tangent_flow(self.set, at, to);
        if let Some(damping) = &mut self.damping {
            damping.damp(self.set, at, of_tangent);
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

impl<const L: usize> Growing<L> for Tiles<'_, L> {
    fn advance(&mut self, n_steps: u64, h: f64) {
        let mut ahead = [self.value.clone(), self.tangent.clone()];
        let (mut sum, mut slope) = (ahead.clone(), ahead.clone());
        if self.dynamics.is_map() {
            for _ in 0..n_steps {
                self.slope(&ahead, &mut slope);
                std::mem::swap(&mut ahead, &mut slope);
            }
            [self.value, self.tangent] = ahead;
            return;
        }
        for _ in 0..n_steps {
            for (weight, advance) in STAGES {
                self.slope(&ahead, &mut slope);
                for (part, state) in [&self.value, &self.tangent].into_iter().enumerate() {
                    self.set.run(Advanced {
                        state: state.as_flattened(),
                        slope: slope[part].as_flattened(),
                        sum: sum[part].as_flattened_mut(),
                        ahead: ahead[part].as_flattened_mut(),
                        by: [weight * h, advance * h],
                    });
                }
            }
            self.value.clone_from(&sum[0]);
            self.tangent.clone_from(&sum[1]);
            ahead.clone_from(&sum);
        }
    }

    fn is_bounded(&self) -> bool {
        let radius = self.dynamics.escape_radius();
        let free = &self.value[..self.dynamics.n_free()];
        free.as_flattened().iter().all(|x| x.abs() < radius)
    }

    fn renormalise(&mut self) -> [f64; L] {
        // Of as many tangents as components no more can be orthogonal.
        let n_tangents = if self.orthonormal { self.value.len() } else { L };
        let n_free = self.dynamics.n_free();
        let mut logs = [0.0; L];
        for (number, log_of) in logs.iter_mut().enumerate().take(n_tangents) {
            if self.orthonormal {
                self.project(number);
            }
            let length = length(self.tangent.iter().map(|x| x[number]));
            let begins = |c: usize| f64::from(u8::from(c < n_free));
            for (c, x) in self.tangent.iter_mut().enumerate() {
                x[number] = if vanished(length) { begins(c) } else { x[number] / length };
            }
            *log_of = log(length);
        }
        logs
    }
}

/// What a stage adds to the step, and where the next one is evaluated.
struct Advanced<'a> {
    state: &'a [f64],
    slope: &'a [f64],
    sum: &'a mut [f64],
    ahead: &'a mut [f64],
    /// The weight of the stage, and how far it goes.
    by: [f64; 2],
}

impl Work for Advanced<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { state, slope, sum, ahead, by: [weight, advance] } = self;
        let n = state.len();
        let (slope, sum, ahead) = (&slope[..n], &mut sum[..n], &mut ahead[..n]);
        for number in 0..n {
            sum[number] += slope[number] * weight;
            ahead[number] = state[number] + slope[number] * advance;
        }
    }
}
