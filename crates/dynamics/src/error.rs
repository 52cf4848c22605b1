//! What can go wrong in a simulation, beyond an orbit that escapes.

use thiserror::Error;

use crate::statistics::BLOCKS;

/// An orbit has escaped when a component exceeds this size, where equations do not say otherwise
/// ([`crate::NodeDynamics::escape_radius`]). Attractors of the oscillators here stay
/// below 10³, in the units of their equations.
pub const ESCAPE_RADIUS: f64 = 1e6;

/// Why a simulation or an exponent could not be computed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DynamicsError {
    /// A step that is zero, negative or not finite.
    #[error("the step is {step}; it must be finite and above zero")]
    BadStep {
        /// Step in model time units.
        step: f64,
    },
    /// A step of a map that is not 1.
    #[error("the step is {step}; a map goes in steps of 1")]
    StepOfMap {
        /// Step in iterations.
        step: f64,
    },
    /// A map that would be integrated, or a flow that would be iterated.
    #[error(
        "the equations are those of a {}, {}",
        if *is_map { "map" } else { "flow" },
        if *is_map { "which is iterated, not integrated" } else { "which is integrated, not iterated" }
    )]
    WrongMethod {
        /// Whether they are a map's.
        is_map: bool,
    },
    /// A span of time that is negative or not finite.
    #[error("the {name} is {value}; it must be finite and not negative")]
    BadTime {
        /// Which span.
        name: &'static str,
        /// Its length in model time units.
        value: f64,
    },
    /// Fewer samples than blocks.
    #[error(
        "the average gives {samples} samples, fewer than the {needed} its standard error needs"
    )]
    TooFewSamples {
        /// Samples in the averaging time.
        samples: u64,
        /// The least number.
        needed: u64,
    },
    /// A node of a time series that the network does not have.
    #[error("the series is of node {node}, counted from 0, of a network of {n_nodes}")]
    NoSuchNode {
        /// Node asked for.
        node: usize,
        /// How many there are.
        n_nodes: usize,
    },
    /// A component of a time series that the oscillator does not have.
    #[error("the series is of component {component}, counted from 0, of {n_components}")]
    NoSuchComponent {
        /// Component asked for.
        component: usize,
        /// How many there are.
        n_components: usize,
    },
    /// A time series without a single record.
    #[error("the series has no sample: it is of every {every} samples from time {from} to {to}")]
    EmptySeries {
        /// Samples from one record to the next.
        every: u64,
        /// Model time of the first.
        from: f64,
        /// Model time that none is later than.
        to: f64,
    },
    /// An isolated orbit left every bounded region.
    #[error("the isolated orbit escapes at time {time}")]
    Escaped {
        /// Model time at which it was seen.
        time: f64,
    },
    /// Tangents grew beyond all numbers between two renormalisations.
    #[error("at sigma = {sigma} tangents grow beyond all numbers between two renormalisations")]
    Overflow {
        /// σ of the first of them.
        sigma: f64,
    },
    /// The observer, or whoever is told of progress, wanted to stop.
    #[error("the work was stopped before its end")]
    Cancelled,
}

/// Checks a step, named times and the number of samples they give, in model time units.
pub(crate) fn check_times(
    step: f64,
    times: &[(&'static str, f64)],
    samples: f64,
) -> Result<(), DynamicsError> {
    if !(step.is_finite() && step > 0.0) {
        return Err(DynamicsError::BadStep { step });
    }
    for &(name, value) in times {
        if !(value.is_finite() && value >= 0.0) {
            return Err(DynamicsError::BadTime { name, value });
        }
    }
    let (samples, needed) = (whole(samples), BLOCKS as u64);
    if samples < needed {
        return Err(DynamicsError::TooFewSamples { samples, needed });
    }
    Ok(())
}

/// Refuses any step of a map but 1.
pub(crate) fn check_step(is_map: bool, step: f64) -> Result<(), DynamicsError> {
    if is_map && step != 1.0 {
        return Err(DynamicsError::StepOfMap { step });
    }
    Ok(())
}

/// A count of steps or samples from a ratio of times: rounded, and saturating.
pub(crate) fn whole(ratio: f64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates at both ends, and the ratio of two checked times is not negative"
    )]
    {
        ratio.round() as u64
    }
}
