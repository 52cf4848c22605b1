//! Panel of the master stability function: Λ against σ with its standard error, the zero line,
//! the stable set shaded, and every zero marked with its value.
//!
//! σ_k = −ελ_k is the generic coupling strength of mode k, which is damped where Λ(σ_k) < 0
//! (Pecora & Carroll, PRL 80, 2109 (1998)).

use super::label::Label;
use super::lines::{LinePanel, Note, Shade, Tone};
use super::series::{Series, Spread, SpreadStyle};

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
    /// Zeros of Λ, each as a number in words; other ends of intervals are only those of the look.
    pub zeros: Vec<(f64, String)>,
}

/// The panel: band of ± 2 standard errors, and zeros labelled σ_c where there is one, σ_min and σ_max
/// where two are the ends of one stable interval, as couplings are that follow from them, else σ_1, σ_2, ….
pub fn msf_panel(curve: &MsfCurve) -> LinePanel {
    let ends = |sign: f64| {
        curve.lambda.iter().zip(&curve.standard_error).map(|(l, e)| l + sign * 2.0 * e).collect()
    };
    let last = curve.sigma.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let stable = curve.stable.iter();
    let name = |k: usize| match (curve.zeros.len(), curve.stable.len()) {
        (1, _) => "c".to_owned(),
        (2, 1) => ["min", "max"][k].to_owned(),
        _ => (k + 1).to_string(),
    };
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
        notes: curve.zeros.iter().enumerate().map(|(k, zero)| note(&name(k), zero)).collect(),
        // An open interval is shaded beyond the right edge of the frame, which cuts it.
        shaded: vec![Shade {
            spans: stable.map(|&(from, to)| [from, to.unwrap_or(2.0 * last.max(from))]).collect(),
            label: Label::default(),
            tone: Tone::Grey,
        }],
        ..LinePanel::default()
    }
}

fn note(name: &str, (zero, value): &(f64, String)) -> Note {
    let label = Label::math("σ").subscript(name).with_math(&format!(" = {value}"));
    Note { at: [*zero, 0.0], label }
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
    fn zeros_are_named_as_the_ends_that_they_are() {
        let names = |zeros: &[f64], stable: Vec<(f64, Option<f64>)>| -> Vec<Label> {
            let zeros = zeros.iter().map(|&zero| (zero, "x".to_owned())).collect();
            let (sigma, lambda, standard_error) = (vec![0.0, 9.0], vec![1.0; 2], vec![0.1; 2]);
            let panel = msf_panel(&MsfCurve { sigma, lambda, standard_error, stable, zeros });
            panel.notes.into_iter().map(|note| note.label).collect()
        };
        let named = |name: &str| Label::math("σ").subscript(name).with_math(" = x");
        assert_eq!(names(&[1.0], vec![(1.0, None)]), [named("c")]);
        assert_eq!(names(&[1.0, 2.0], vec![(1.0, Some(2.0))]), ["min", "max"].map(named));
        let twice = vec![(1.0, Some(2.0)), (3.0, None)];
        assert_eq!(names(&[1.0, 2.0, 3.0], twice), ["1", "2", "3"].map(named));
        let from_zero = vec![(0.0, Some(1.0)), (3.0, None)];
        assert_eq!(names(&[1.0, 3.0], from_zero), ["1", "2"].map(named));
    }

    #[test]
    fn the_band_is_two_standard_errors_to_either_side() {
        let panel = msf_panel(&MsfCurve {
            sigma: vec![0.0, 1.0],
            lambda: vec![1.0, -1.0],
            standard_error: vec![0.25, 0.5],
            stable: vec![(0.5, None)],
            zeros: vec![(0.5, "0.5".into())],
        });
        let spread = panel.series[0].spread.as_ref().unwrap();
        assert_eq!((&spread.lower[..], &spread.upper[..]), (&[0.5, -2.0][..], &[1.5, 0.0][..]));
        assert!(panel.shaded[0].spans[0][1] > 1.0);
    }
}
