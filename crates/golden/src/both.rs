//! Both summaries of a comparison, and what of their numbers decides how wide bands are.

use serde_json::{Map, Value};

/// A value on both sides, the golden one first.
pub type Pair<'a> = [&'a Value; 2];
/// The objects around both.
pub type Siblings<'a> = [&'a Map<String, Value>; 2];

/// How much larger than the golden standard error one may be that is obtained over the same time.
pub const GROWTH: f64 = 3.0;

/// The golden summary and the one that is held against it.
pub struct Both<'a> {
    pub expected: &'a Value,
    pub obtained: &'a Value,
}

impl Both<'_> {
    /// What an error of a kind of quantity is large against, where it is not the quantity itself.
    pub fn scale(&self, kind: &str) -> Option<f64> {
        let list = kind.strip_prefix("simulations[].")?.strip_suffix("[].mean")?;
        let simulations = self.expected["simulations"].as_array()?.iter();
        let errors = simulations.filter_map(|s| s[list].as_array()).flatten();
        Some(errors.filter_map(|error| error["mean"].as_f64()).fold(0.0, f64::max))
    }

    /// Standard errors of both sides added in squares, the expected one widened when the obtained run
    /// was shortened: its averages are over less time than the golden ones. The obtained one counts as
    /// far as the golden one lets it.
    pub fn joint_error(&self, [expected, obtained]: Siblings, key: &str) -> f64 {
        let of = |side: &Map<String, Value>| side.get(key).and_then(Value::as_f64).unwrap_or(0.0);
        let golden = of(expected) * self.widening();
        golden.hypot(of(obtained).min(GROWTH * golden))
    }

    /// Spreads of an onset over seeds on both sides; none is known better than to a step.
    pub fn joint_spread(&self, [expected, obtained]: Siblings, step: f64) -> f64 {
        let of =
            |side: &Map<String, Value>| side.get("spread").and_then(Value::as_f64).unwrap_or(0.0);
        let golden = of(expected) * self.widening();
        golden.hypot(of(obtained).min(GROWTH * golden.max(step)))
    }

    /// How far a number depends on the seeds: as the golden output says or, where it does not, as the
    /// obtained one does, up to a size.
    pub fn seeds_error(&self, [expected, obtained]: Siblings, key: &str, most: f64) -> f64 {
        let of = |side: &Map<String, Value>| side.get(key).and_then(Value::as_f64);
        of(expected).unwrap_or_else(|| of(obtained).unwrap_or(0.0).min(most))
    }

    pub fn widening(&self) -> f64 {
        (shortening(self.obtained) / shortening(self.expected)).sqrt().max(1.0)
    }

    /// The largest joint standard error of the entries of a list on both sides.
    fn largest_joint_error(&self, lists: [Option<&Value>; 2]) -> f64 {
        let [a, b] = lists.map(|list| list.and_then(Value::as_array));
        let pairs = a.into_iter().flatten().zip(b.into_iter().flatten());
        pairs
            .filter_map(|(a, b)| {
                Some(self.joint_error([a.as_object()?, b.as_object()?], "standard_error"))
            })
            .fold(0.0, f64::max)
    }

    /// Of the zeros of one curve, which stand beside its stable set.
    pub fn largest_zero_error(&self, curves: Siblings) -> f64 {
        self.largest_joint_error(curves.map(|curve| curve.get("zeros")))
    }

    pub fn largest_coupling_error(&self) -> f64 {
        self.largest_joint_error(
            [self.expected, self.obtained].map(|side| side.get("critical_couplings")),
        )
    }

    pub fn largest_eigenvalue(&self) -> f64 {
        let values = self.expected["eigenvalues"].as_array();
        values.into_iter().flatten().filter_map(Value::as_f64).fold(1.0, |m, x| m.max(x.abs()))
    }

    pub fn widest_step(&self) -> f64 {
        self.swept().windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max)
    }

    /// How far a coupling is from the nearer end of the sweep.
    pub fn to_an_end(&self, epsilon: f64) -> f64 {
        let swept = self.swept();
        let ends = swept.first().into_iter().chain(swept.last());
        ends.map(|end| (epsilon - end).abs()).fold(f64::INFINITY, f64::min)
    }

    /// The couplings of the sweep, ascending.
    pub fn swept(&self) -> Vec<f64> {
        let simulations = self.expected["simulations"].as_array();
        simulations.into_iter().flatten().filter_map(|s| s["epsilon"].as_f64()).collect()
    }
}

/// By how much the times of a run were shortened.
fn shortening(summary: &Value) -> f64 {
    summary["shortened"].as_f64().unwrap_or(1.0)
}
