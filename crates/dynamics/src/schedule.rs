//! The times of a simulation.

use serde::Serialize;

use crate::DynamicsError;
use crate::error::{check_times, whole};
use crate::statistics::BLOCKS;

/// How long to simulate and how often to look. All times in model time units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Schedule {
    /// Step of the integrator (the sampling unit of an adaptive one).
    pub step: f64,
    /// Time left for the initial state to be forgotten.
    pub transient: f64,
    /// Time over which errors are averaged, rounded up to [`BLOCKS`] blocks of whole samples.
    pub average: f64,
    /// Steps from one sample to the next.
    pub stride: u32,
}

impl Schedule {
    /// Steps of one replica from its initial state to its end.
    pub fn steps(&self) -> u64 {
        (self.transient_samples() + self.samples()) * u64::from(self.stride)
    }

    /// Samples in the averaging time.
    pub fn samples(&self) -> u64 {
        self.samples_per_block() * BLOCKS as u64
    }

    /// Time between two samples.
    pub fn sampling_interval(&self) -> f64 {
        self.step * f64::from(self.stride)
    }

    pub(crate) fn transient_samples(&self) -> u64 {
        whole(self.transient / self.sampling_interval())
    }

    pub(crate) fn samples_per_block(&self) -> u64 {
        whole((self.average / self.sampling_interval() / BLOCKS as f64).max(1.0))
    }

    pub(crate) fn time_of(&self, sample: u64) -> f64 {
        sample as f64 * self.sampling_interval()
    }

    pub(crate) fn check(&self) -> Result<(), DynamicsError> {
        let times = [("transient", self.transient), ("average", self.average)];
        check_times(self.step, &times, self.average / self.sampling_interval())
    }
}
