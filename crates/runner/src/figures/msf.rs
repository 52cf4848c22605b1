//! Panel of the master stability function: Λ against σ with its standard error, the zero line,
//! the stable set shaded, and every zero marked with its value.
//!
//! σ_k = −ελ_k is the generic coupling strength of mode k, which is damped where Λ(σ_k) < 0
//! (Pecora & Carroll, PRL 80, 2109 (1998)).

use super::label::Label;
use super::lines::{LinePanel, Note, Shade, Tone};
use super::series::{Series, Spread, SpreadStyle};
use crate::table::three_digits;

/// What a panel of the master stability function shows.
#[derive(Clone, Debug)]
pub struct MsfCurve {
    /// Generic coupling strengths σ, dimensionless.
    pub sigma: Vec<f64>,
    /// Largest Lyapunov exponent Λ at each σ, per model time unit.
    pub lambda: Vec<f64>,
    /// Standard error of each Λ.
    pub standard_error: Vec<f64>,
    /// Intervals of σ with Λ < 0; none for an end beyond the σ that were looked at.
    pub stable: Vec<(f64, Option<f64>)>,
    /// Zeros of Λ; other ends of intervals are only those of the look.
    pub zeros: Vec<f64>,
}

/// The panel: band of ± 2 standard errors, zeros labelled σ_c or, where there are several, σ_1, σ_2, ….
pub fn msf_panel(curve: &MsfCurve) -> LinePanel {
    let ends = |sign: f64| {
        curve.lambda.iter().zip(&curve.standard_error).map(|(l, e)| l + sign * 2.0 * e).collect()
    };
    let last = curve.sigma.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let stable = curve.stable.iter();
    let is_one = curve.zeros.len() == 1;
    let name = |k: usize| if is_one { "c".to_owned() } else { (k + 1).to_string() };
    LinePanel {
        x_label: Label::math("σ"),
        y_label: Label::math("Λ"),
        zero_line: true,
        series: vec![Series {
            x: curve.sigma.clone(),
            y: curve.lambda.clone(),
            spread: Some(Spread { lower: ends(-1.0), upper: ends(1.0), drawn: SpreadStyle::Band }),
            ..Series::default()
        }],
        notes: curve.zeros.iter().enumerate().map(|(k, &zero)| note(&name(k), zero)).collect(),
        // An open interval is shaded beyond the right edge of the frame, which cuts it.
        shaded: vec![Shade {
            spans: stable.map(|&(from, to)| [from, to.unwrap_or(2.0 * last.max(from))]).collect(),
            label: Label::default(),
            tone: Tone::Grey,
        }],
        ..LinePanel::default()
    }
}

fn note(name: &str, zero: f64) -> Note {
    let value = three_digits(zero);
    let label = Label::math("σ").subscript(name).with_math(&format!(" = {value}"));
    Note { at: [zero, 0.0], label }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_the_look_is_not_marked_as_a_zero() {
        let panel = msf_panel(&MsfCurve {
            sigma: vec![10.0, 20.0],
            lambda: vec![-1.0, -1.0],
            standard_error: vec![0.1, 0.1],
            stable: vec![(10.0, None)],
            zeros: vec![],
        });
        assert_eq!((panel.notes.len(), panel.shaded[0].spans.len()), (0, 1));
    }

    #[test]
    fn the_band_is_two_standard_errors_to_either_side() {
        let panel = msf_panel(&MsfCurve {
            sigma: vec![0.0, 1.0],
            lambda: vec![1.0, -1.0],
            standard_error: vec![0.25, 0.5],
            stable: vec![(0.5, None)],
            zeros: vec![0.5],
        });
        let spread = panel.series[0].spread.as_ref().unwrap();
        assert_eq!((&spread.lower[..], &spread.upper[..]), (&[0.5, -2.0][..], &[1.5, 0.0][..]));
        assert!(panel.shaded[0].spans[0][1] > 1.0);
    }
}
