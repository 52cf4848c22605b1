//! How prediction and simulation agree at an ε.

use eigensync::numbers::plain;
use eigensync::{Agreement, Predicted};

use super::{cascade, simulated};
use crate::Number;
use crate::found::Found;

/// Pearson's correlation at each ε of the claim.
pub fn pearson(found: &Found<'_>) -> Vec<Number> {
    numbers(found, |a| known(a.correlation.map(|c| c.pearson), a.errors.pearson))
}

/// Spearman's.
pub fn spearman(found: &Found<'_>) -> Vec<Number> {
    numbers(found, |a| known(a.correlation.map(|c| c.spearman), a.errors.spearman))
}

/// The adjusted Rand index.
pub fn rand_index(found: &Found<'_>) -> Vec<Number> {
    numbers(found, |a| known(a.rand_index, a.errors.rand_index))
}

fn numbers(found: &Found<'_>, of: impl Fn(&Agreement) -> Number) -> Vec<Number> {
    found.at_each_epsilon(|_, position| {
        let number = found.findings.agreement.get(position).map_or(Number::None, &of);
        match (number, not_compared(found, position)) {
            (Number::None, Some(why)) => Number::Unknown(why),
            (number, _) => number,
        }
    })
}

/// Why prediction and simulation are not compared at a point of the sweep.
pub fn not_compared(found: &Found<'_>, position: usize) -> Option<String> {
    let simulated = found.findings.simulated.as_ref()?;
    let epsilon = plain(simulated.epsilon[position]);
    if let Some(why) = simulated::nothing_left(simulated, position) {
        return Some(why);
    }
    match found.findings.agreement.get(position)?.predicted {
        Predicted::NotReached => Some(cascade::not_predicted(simulated.epsilon[position])),
        Predicted::AllTogether => Some(format!(
            "no mode is unstable at epsilon = {epsilon}: all nodes are predicted to be alike"
        )),
        Predicted::Uncoupled | Predicted::Unstable(_) => None,
    }
}

/// A number with the scatter of the seeds, which a single one does not tell.
fn known(value: Option<f64>, error: Option<f64>) -> Number {
    match value {
        Some(value) => Number::Known { value, error: error.unwrap_or(0.0) },
        None => Number::None,
    }
}
