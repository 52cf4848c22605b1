//! Random kicks of the size of rounding, which keep equal states from staying equal by accident.
//!
//! Two nodes whose states have become equal to the last bit, and whose inputs round alike, stay equal
//! for ever in floating point, even where that state is unstable: a burst that should come never
//! does. Real oscillators are never equal to the last bit. Every unit of model time each component of
//! each node is multiplied by 1 + kick · u, u uniform in [−1, 1), from a generator of its replica.
//!
//! Source: on bursts where synchrony is lost, E. Ott & J. C. Sommerer, Phys. Lett. A 188, 39 (1994);
//! on how they depend on noise, N. Platt, S. M. Hammel & J. F. Heagy, PRL 72, 3498 (1994).

use rand_core::Rng;
use rand_pcg::Pcg64;

use crate::Replica;
use crate::random::unit_interval;

/// Model time between kicks.
const INTERVAL: f64 = 1.0;

/// Apart from the stream of initial states.
const STREAM: u128 = 0x006b_6963_6b73;

/// The kicks of `L` replicas.
pub(crate) struct Kicks<const L: usize> {
    size: f64,
    generators: [Pcg64; L],
    samples_between: u64,
}

impl<const L: usize> Kicks<L> {
    /// Kicks of a relative size, at the samples nearest to every unit of model time.
    pub(crate) fn new(size: f64, sampling_interval: f64, replicas: [Replica; L]) -> Self {
        Self {
            size,
            generators: replicas.map(|replica| Pcg64::new(u128::from(replica.seed), STREAM)),
            samples_between: crate::error::whole((INTERVAL / sampling_interval).max(1.0)),
        }
    }

    /// Goes on after a sample, kicks of so many numbers a replica behind it: each takes one draw.
    pub(crate) fn go_on_after(&mut self, sample: u64, numbers: usize) {
        if self.size > 0.0 {
            let draws = u128::from(sample / self.samples_between) * numbers as u128;
            self.generators.iter_mut().for_each(|generator| generator.advance(draws));
        }
    }

    /// Whether kicks are due at a sample.
    pub(crate) fn due(&self, sample: u64) -> bool {
        self.size > 0.0 && sample.is_multiple_of(self.samples_between)
    }

    /// Kicks one component of one node in every lane.
    pub(crate) fn apply(&mut self, lanes: &mut [f64; L]) {
        for (x, generator) in lanes.iter_mut().zip(&mut self.generators) {
            *x *= 1.0 + self.size * (2.0 * unit_interval(generator.next_u64()) - 1.0);
        }
    }
}
