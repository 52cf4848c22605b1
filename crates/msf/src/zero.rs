//! A zero of Λ(σ), with what is known of it.

use dynamics::Estimate;

use crate::step::is_certain;

/// A zero of Λ, where the stability of a mode changes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Zero {
    /// Where Λ(σ) = 0.
    pub sigma: f64,
    /// Standard error of it: of averages from the scatter of independent orbits about a line, what bending
    /// of Λ may add, and what half the step and a longer transient change where that is more than chance,
    /// or half the width of the bracket where no line could be drawn; on orbits that close that of
    /// the computation.
    pub standard_error: f64,
    /// Whether Λ falls through zero, so that larger σ is stable.
    pub falling: bool,
    /// Whether it is known as well as was asked for: [`crate::Refinement::relative_error`].
    pub refined: bool,
    /// By how much half the step of the integrator moves it, with the standard error of that; none
    /// where no line could be drawn.
    pub step_shift: Option<Estimate>,
}

impl Zero {
    /// A zero that is known exactly, as in closed forms.
    pub fn exact(sigma: f64, falling: bool) -> Self {
        Self { sigma, standard_error: 0.0, falling, refined: true, step_shift: None }
    }

    /// Interval that holds the zero with a probability of 95 %.
    pub fn confidence_interval(&self) -> [f64; 2] {
        let half_width = 1.96 * self.standard_error;
        [self.sigma - half_width, self.sigma + half_width]
    }

    /// What half the step changes, where that is more than chance.
    pub fn certain_step_shift(&self) -> Option<Estimate> {
        self.step_shift.filter(|&shift| is_certain(shift))
    }
}
