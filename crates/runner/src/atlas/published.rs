//! Stable windows as obtained against those that were published.

use claims::{Judged, Verdict};
use eigensync::numbers::plain;
use experiment::spec::PublishedSpec;
use experiment::{AtlasPlan, Pair, System};
use msf::{End, Interval, MasterStability};
use serde_json::{Value, json};

use super::curves::name;

/// Half the width of an interval that holds a zero with a probability of 95 %, in standard errors.
const CONFIDENCE: f64 = 1.96;

/// The verdict on what was published of a pair; none where nothing was.
pub fn judged(
    (plan, system, pair): (&AtlasPlan, &System, &Pair),
    curve: &MasterStability,
    is_quick: bool,
) -> Option<Judged> {
    let published = pair.published.as_ref()?;
    let intervals = &curve.stable.intervals;
    let is_same = agree(published, intervals);
    let known = &published.known_difference;
    let verdict = match (is_same, known) {
        (true, _) => Verdict::Holds,
        (false, Some(_)) => Verdict::DiffersAsKnown,
        (false, None) if is_quick => Verdict::NeedsFullRun,
        (false, None) => Verdict::Differs,
    };
    let zeros = || curve.stable.zeros();
    let source = if published.source.is_empty() { &plan.source } else { &published.source };
    Some(Judged {
        name: name(system, pair),
        source: source.clone(),
        paper: published.windows.iter().map(|&[from, to]| window(from, to)).collect(),
        obtained: intervals
            .iter()
            .map(|interval| window(interval.lower(), interval.upper().unwrap_or(f64::INFINITY)))
            .collect(),
        uncertainty: zeros().map(|zero| zero.standard_error).reduce(f64::max),
        runs: None,
        refined: zeros().any(|zero| !zero.refined).then_some(false),
        tolerance: format!("± {} and the 95 % interval", plain(published.within)),
        verdict,
        reason: known.clone().filter(|_| !is_same).unwrap_or_default(),
    })
}

/// [from, to]; no upper end where none was found.
fn window(from: f64, to: f64) -> Value {
    json!([from, to.is_finite().then_some(to)])
}

/// Whether there are the same windows, each end where it was published.
fn agree(published: &PublishedSpec, obtained: &[Interval]) -> bool {
    let is_near = |value: f64, end: End| match end {
        End::Looked { .. } => value.is_infinite(),
        End::Origin { .. } => value == 0.0,
        End::Zero(zero) => {
            (value - zero.sigma).abs() <= published.within + CONFIDENCE * zero.standard_error
        }
    };
    let is_same = |(&[from, to], interval): (&[f64; 2], &Interval)| {
        is_near(from, interval.from) && is_near(to, interval.to)
    };
    published.windows.len() == obtained.len() && published.windows.iter().zip(obtained).all(is_same)
}

#[cfg(test)]
mod tests {
    use super::*;
    use msf::Zero;

    fn published(windows: &[[f64; 2]]) -> PublishedSpec {
        let (source, known_difference) = (String::new(), None);
        PublishedSpec { windows: windows.to_vec(), within: 0.01, source, known_difference }
    }

    fn zero(sigma: f64) -> End {
        End::Zero(Zero { standard_error: 0.01, ..Zero::exact(sigma, true) })
    }

    #[test]
    fn a_window_holds_where_both_ends_lie_within_what_is_known_of_them() {
        let obtained = [Interval { from: zero(1.02), to: zero(4.0) }];
        assert!(agree(&published(&[[1.0, 4.0]]), &obtained));
        assert!(!agree(&published(&[[0.9, 4.0]]), &obtained));
        assert!(!agree(&published(&[[1.0, f64::INFINITY]]), &obtained));
        assert!(!agree(&published(&[[1.0, 4.0], [5.0, 6.0]]), &obtained));
        assert!(!agree(&published(&[]), &obtained));
    }

    #[test]
    fn no_end_is_published_as_infinity_and_found_as_the_end_of_the_look() {
        let obtained = [Interval { from: zero(1.0), to: End::Looked { sigma: 9.0 } }];
        assert!(agree(&published(&[[1.0, f64::INFINITY]]), &obtained));
        assert!(!agree(&published(&[[1.0, 9.0]]), &obtained));
    }
}
