//! What was found of the instance that a claim is about.

use eigensync::{Findings, Simulated, Study};

use crate::Number;
use crate::at::At;

/// The findings of a study, and where a claim looks in them.
#[derive(Clone, Copy)]
pub struct Found<'a> {
    /// What was asked.
    pub study: &'a Study,
    /// What was found.
    pub findings: &'a Findings,
    /// Which instance the claim is about.
    pub at: &'a At,
}

impl Found<'_> {
    /// A number of the simulations at each ε of the claim, of which it was made sure that they are in the
    /// sweep.
    pub fn at_each_epsilon(&self, of: impl Fn(&Simulated, usize) -> Number) -> Vec<Number> {
        let number = |&epsilon: &f64| {
            let simulated = self.findings.simulated.as_ref();
            let found = simulated.and_then(|s| Some(of(s, s.position(epsilon)?)));
            found.unwrap_or(Number::None)
        };
        self.at.epsilon.iter().map(number).collect()
    }

    /// That a mode is not among those that were computed.
    pub fn not_computed(&self, mode: usize) -> String {
        let all = self.study.network.n_nodes();
        let computed = self.findings.spectrum.n_modes();
        format!("{computed} of {all} modes were computed, and not mode {mode}")
    }
}
