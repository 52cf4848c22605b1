//! Claims about numbers.

use serde_json::json;

use super::number::{all, follows};
use super::{Judge, Judged};
use experiment::spec::{OneOrMany, Trend};
use user::Result;

impl Judge<'_> {
    /// One number or a list of numbers.
    pub(super) fn numbers(&self) -> Result<Judged> {
        let obtained = self.obtained_numbers();
        let shown = match &obtained[..] {
            [single] => single.shown(),
            many => many.iter().map(super::Number::shown).collect(),
        };
        let spec = self.spec;
        if let Some(limit) = spec.at_most {
            let answer = all(&obtained, |_, x| x.is_within(f64::NEG_INFINITY, limit));
            return Ok(Judged::new(json!(format!("at most {limit}")), shown, "exact", answer));
        }
        if let Some(limit) = spec.at_least {
            let answer = all(&obtained, |_, x| x.is_within(limit, f64::INFINITY));
            return Ok(Judged::new(json!(format!("at least {limit}")), shown, "exact", answer));
        }
        if let Some(trend) = spec.trend {
            let word = if trend == Trend::Rises { "rising" } else { "falling" };
            return Ok(Judged::new(json!(word), shown, "exact", follows(&obtained, trend)));
        }
        let paper = self.equals::<OneOrMany>("a number or a list of numbers")?;
        let paper = paper.list();
        let (abs, rel) = (spec.abs_tol.unwrap_or(0.0), spec.rel_tol.unwrap_or(0.0));
        // A hair of slack: 4.2 ± 0.1 holds 4.1, whose difference is 0.10000000000000053.
        let allowed = |expected: f64| (abs + rel * expected.abs()) * (1.0 + 1e-9);
        let near = |at: usize, x: &super::Number| {
            let expected = paper[at];
            x.is_within(expected - allowed(expected), expected + allowed(expected))
        };
        let answer = if obtained.len() == paper.len() {
            all(&obtained, near)
        } else {
            super::Answer::Differs
        };
        let tolerance = match (abs > 0.0, rel > 0.0) {
            (true, true) => format!("± {abs} ± {} %", 100.0 * rel),
            (true, false) => format!("± {abs}"),
            (false, true) => format!("± {} %", 100.0 * rel),
            (false, false) => "exact".into(),
        };
        let paper = if let [single] = paper { json!(single) } else { json!(paper) };
        Ok(Judged::new(paper, shown, tolerance, answer))
    }
}
