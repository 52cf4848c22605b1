//! Whether all nodes can synchronise, and at which ε, in the sentence that a paper prints.
//!
//! A window (σ₁, σ₂) of the stable set holds all transverse modes at σ₁ / |λ_2| < ε < σ₂ / |λ_N|, which
//! exists when the eigenratio λ_N / λ_2 is below the window's ratio σ₂ / σ₁ (M. Barahona & L. M. Pecora,
//! Phys. Rev. Lett. 89, 054101 (2002)). Zero modes of other components are stable only where Λ(0) < 0
//! and all oscillators come to rest in the same state; where these differ, a verdict is of nodes in the
//! same one.

use msf::{End, Interval, Looked, Stability, StableRegion, coupling_at, transition_at};
use serde::Serialize;

use crate::numbers::{EXACT, four_digits, six_digits, three_digits, two_digits};

/// The verdict with its numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Synchrony {
    /// The sentence.
    pub verdict: String,
    /// λ_N / λ_2, of the transverse modes that are not zero; none without links or without λ_N.
    pub eigenratio: Option<f64>,
    /// σ₂ / σ₁ of each window; none where it is infinite.
    pub window_ratios: Vec<Option<f64>>,
    /// The ranges of ε at which all nodes synchronise.
    pub epsilon: Vec<EpsilonRange>,
}

/// A range of ε with the standard errors of its ends.
#[derive(Clone, Debug, Serialize)]
pub struct EpsilonRange {
    /// Lower end.
    pub from: f64,
    /// Of the lower end, where it is a zero of Λ over an eigenvalue.
    pub from_standard_error: Option<f64>,
    /// None where it has no end.
    pub to: Option<f64>,
    /// Of the upper end.
    pub to_standard_error: Option<f64>,
}

/// What a verdict is made from.
pub struct Evidence<'a> {
    pub stable: &'a StableRegion,
    pub stability: &'a Stability,
    /// The largest λ below 0: zero modes are zero exactly.
    pub slowest: Option<f64>,
    /// λ_N, where it is known.
    pub fastest: Option<f64>,
    pub n_components: usize,
    /// In how many different states isolated oscillators come to rest; 0 where they do not.
    pub n_rests: usize,
    /// How far and how finely Λ was looked at.
    pub looked: Looked,
    /// As [`assumed_above`] has it.
    pub assumed_above: Option<f64>,
}

/// ε above which λ_N, or what |λ_N| is at least, has a σ beyond all that were looked at, where the set
/// counts as unbounded.
pub fn assumed_above(stable: &StableRegion, fastest: f64) -> Option<f64> {
    let top = stable.intervals.last().filter(|last| last.to.is_looked())?.to.sigma();
    Some(coupling_at(top, fastest)).filter(|above| above.is_finite())
}

impl Synchrony {
    /// From the evidence.
    pub fn of(evidence: &Evidence<'_>) -> Self {
        let stable = evidence.stable;
        let epsilon = evidence.ranges();
        Self {
            eigenratio: evidence.eigenratio(),
            window_ratios: stable.intervals.iter().map(ratio).collect(),
            verdict: evidence.verdict(&epsilon) + &evidence.assumption(&epsilon),
            epsilon,
        }
    }
}

impl Evidence<'_> {
    /// Where no mode is unstable, and the range begins and ends by a mode that becomes so.
    fn ranges(&self) -> Vec<EpsilonRange> {
        let Stability { stretches, decided, .. } = self.stability;
        let synchronous = stretches.iter().filter(|stretch| stretch.unstable_modes.is_empty());
        let mut ranges: Vec<EpsilonRange> = synchronous
            .map(|stretch| {
                let (from, to) = stretch.epsilon;
                EpsilonRange {
                    from,
                    from_standard_error: self.error_at(from),
                    to,
                    to_standard_error: to.and_then(|to| self.error_at(to)),
                }
            })
            .collect();
        if let (Some(top), Some(highest)) = (decided.to, ranges.first_mut())
            && highest.to == Some(top)
        {
            // λ_N is of no mode that was computed.
            highest.to_standard_error = decided.to_standard_error;
        }
        ranges.reverse();
        ranges
    }

    fn error_at(&self, epsilon: f64) -> Option<f64> {
        transition_at(&self.stability.transitions, epsilon).map(|found| found.standard_error)
    }

    fn eigenratio(&self) -> Option<f64> {
        Some(self.fastest? / self.slowest?)
    }

    /// What a verdict takes for granted: that σ beyond the look are stable.
    fn assumption(&self, ranges: &[EpsilonRange]) -> String {
        let Some(above) = self.assumed_above else { return String::new() };
        let looked = four_digits(self.looked.to);
        match ranges.last() {
            Some(range) if range.to.is_none() && above <= range.from => {
                format!(", if σ beyond {looked}, where nothing was looked at, are stable")
            }
            Some(range) if range.to.is_none() => format!(
                "; for ε > {} only if σ beyond {looked}, where nothing was looked at, are stable",
                four_digits(above)
            ),
            _ => String::new(),
        }
    }

    fn verdict(&self, ranges: &[EpsilonRange]) -> String {
        let at_rest = self.stable.contains(0.0);
        let never = |why: String| format!("no ε synchronises all nodes: {why}");
        if self.stable.intervals.is_empty() {
            return never(format!("of {} none was found stable", looked(&self.looked)));
        }
        if self.n_components > 1 && !at_rest {
            return never(format!("the network has {} components", self.n_components));
        }
        if !ranges.is_empty() {
            let ranges: Vec<String> = ranges.iter().map(|range| range.in_words(at_rest)).collect();
            let rest = match self.n_rests {
                0 | 1 if at_rest => ", since each comes to rest by itself".to_owned(),
                0 | 1 => String::new(),
                n => format!(
                    " if they come to the same one of the {n} states in which isolated oscillators rest"
                ),
            };
            return format!("all nodes synchronise for {}{rest}", ranges.join(" and for "));
        }
        let ratios: Vec<String> =
            self.stable.intervals.iter().filter_map(ratio).map(three_digits).collect();
        match self.eigenratio().map(three_digits) {
            Some(own) if ratios.len() == self.stable.intervals.len() => {
                let windows = match &ratios[..] {
                    [one] => format!("the window's {one}"),
                    several => format!("that of each window ({})", several.join(", ")),
                };
                format!("λ_N/λ_2 = {own} exceeds {windows}: no ε synchronises all nodes")
            }
            _ => "whether an ε synchronises all nodes was not found out".into(),
        }
    }
}

impl EpsilonRange {
    fn in_words(&self, at_rest: bool) -> String {
        let end = |value: f64, error: Option<f64>| match error {
            Some(error) if error > EXACT * value => {
                format!("{} (± {})", four_digits(value), two_digits(error))
            }
            Some(error) if error > 0.0 => six_digits(value),
            _ => four_digits(value),
        };
        let from = end(self.from, self.from_standard_error);
        match (self.from > 0.0, self.to) {
            (false, None) if at_rest => "every ε".into(),
            (false, None) => "every ε > 0".into(),
            (true, None) => format!("ε > {from}"),
            (false, Some(to)) => format!("ε < {}", end(to, self.to_standard_error)),
            (true, Some(to)) => format!("{from} < ε < {}", end(to, self.to_standard_error)),
        }
    }
}

/// From where to where and at how many σ was looked, in words.
pub fn looked(looked: &Looked) -> String {
    let [from, to] = [looked.from, looked.to].map(four_digits);
    format!("{} sigma from {from} to {to}", looked.points)
}

/// σ₂ / σ₁ of an interval; none where it is infinite or not known.
fn ratio(interval: &Interval) -> Option<f64> {
    match (interval.from, interval.upper()) {
        (End::Zero(_) | End::Looked { .. }, Some(to)) => Some(to / interval.lower()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use graph::{CouplingMatrix, Network, Normalization};
    use msf::Zero;
    use spectra::{Request, leading_modes};

    use super::*;
    use crate::prediction;

    /// The verdict on a network of links of weight 1, with all of its modes.
    fn verdict(n_nodes: usize, links: &[(usize, usize)], intervals: Vec<Interval>) -> String {
        verdict_at_rest(n_nodes, links, intervals, 0)
    }

    /// The same where isolated oscillators rest in so many states.
    fn verdict_at_rest(
        n_nodes: usize,
        links: &[(usize, usize)],
        intervals: Vec<Interval>,
        n_rests: usize,
    ) -> String {
        let links: Vec<_> = links.iter().map(|&(i, j)| (i, j, 1.0)).collect();
        let labels = (0..n_nodes).map(|node| node.to_string()).collect();
        let network = Network::undirected(labels, &links).unwrap();
        let n_components = network.components().len();
        let w = CouplingMatrix::new(&network, Normalization::Laplacian);
        let mut spectrum = leading_modes(&w, &Request::default()).unwrap();
        // No error but that of zeros is to be told.
        spectrum.eigenspaces.iter_mut().for_each(|space| space.residuals.fill(0.0));
        let stable = StableRegion { intervals };
        let looked = Looked { from: 0.0, to: 50.0, points: 3, ..Looked::default() };
        let eigenvalues = spectrum.real_eigenvalues();
        let fastest = eigenvalues.last().copied();
        let stability = prediction::stability(&stable, looked.from, &spectrum, fastest).unwrap();
        let evidence = Evidence {
            stable: &stable,
            stability: &stability,
            slowest: eigenvalues.iter().copied().find(|&lambda| lambda < 0.0),
            fastest,
            n_components,
            n_rests,
            looked,
            assumed_above: assumed_above(&stable, fastest.unwrap_or_default()),
        };
        Synchrony::of(&evidence).verdict
    }

    // A path of three: λ = 0, −1, −3.
    const PATH: [(usize, usize); 2] = [(0, 1), (1, 2)];

    #[test]
    fn a_window_wider_than_the_eigenratio_is_where_all_nodes_synchronise() {
        let window = vec![Interval::known(1.0, Some(4.5))];
        assert_eq!(verdict(3, &PATH, window), "all nodes synchronise for 1 < ε < 1.5");
        let unbounded = vec![Interval::known(8.0, None)];
        assert_eq!(verdict(3, &PATH, unbounded), "all nodes synchronise for ε > 8");
        let periodic = vec![Interval::known(0.0, None)];
        assert_eq!(verdict(3, &PATH, periodic), "all nodes synchronise for every ε > 0");
    }

    #[test]
    fn each_end_of_a_range_has_the_error_of_its_own_transition() {
        let zero = |sigma, falling, standard_error| {
            End::Zero(Zero { standard_error, ..Zero::exact(sigma, falling) })
        };
        let window = Interval { from: zero(1.0, true, 0.03), to: zero(4.5, false, 0.15) };
        let expected = "all nodes synchronise for 1 (± 0.03) < ε < 1.5 (± 0.05)";
        assert_eq!(verdict(3, &PATH, vec![window]), expected);
    }

    #[test]
    fn a_verdict_that_leans_on_what_was_not_looked_at_says_so() {
        let to = End::Looked { sigma: 50.0 };
        let of = |from| verdict(3, &PATH, vec![Interval { to, ..Interval::known(from, None) }]);
        // σ_N = 3ε passes 50 at ε = 16.67.
        assert_eq!(
            of(8.0),
            "all nodes synchronise for ε > 8; for ε > 16.67 only if σ beyond 50, where nothing was \
             looked at, are stable"
        );
        assert_eq!(
            of(20.0),
            "all nodes synchronise for ε > 20, if σ beyond 50, where nothing was looked at, are stable"
        );
    }

    #[test]
    fn a_window_that_is_too_narrow_is_told_with_both_ratios() {
        let window = vec![Interval::known(1.0, Some(2.0))];
        let expected = "λ_N/λ_2 = 3 exceeds the window's 2: no ε synchronises all nodes";
        assert_eq!(verdict(3, &PATH, window), expected);
        let two = vec![Interval::known(1.0, Some(2.0)), Interval::known(8.0, Some(10.0))];
        let expected =
            "λ_N/λ_2 = 3 exceeds that of each window (2, 1.25): no ε synchronises all nodes";
        assert_eq!(verdict(3, &PATH, two), expected);
    }

    #[test]
    fn modes_in_different_windows_synchronise_too() {
        // At ε = 1.5 the modes have σ = 1.5 and 4.5.
        let two = vec![Interval::known(1.0, Some(2.0)), Interval::known(4.0, Some(5.0))];
        assert_eq!(verdict(3, &PATH, two), "all nodes synchronise for 1.333 < ε < 1.667");
    }

    #[test]
    fn oscillators_at_rest_in_different_states_synchronise_in_the_same_one_only() {
        let from_origin = vec![Interval::known(0.0, None)];
        let expected = "all nodes synchronise for every ε > 0 if they come to the same one of the 2 \
                        states in which isolated oscillators rest";
        assert_eq!(verdict_at_rest(3, &PATH, from_origin.clone(), 2), expected);
        let pairs = [(0, 1), (2, 3)];
        let expected = "no ε synchronises all nodes: the network has 2 components";
        assert_eq!(verdict_at_rest(4, &pairs, from_origin, 2), expected);
    }

    #[test]
    fn components_synchronise_only_where_each_node_comes_to_rest() {
        let pairs = [(0, 1), (2, 3)];
        let above = Interval::known(1.0, None);
        assert_eq!(
            verdict(4, &pairs, vec![above]),
            "no ε synchronises all nodes: the network has 2 components"
        );
        let at_rest = Interval { from: End::Origin { included: true }, ..above };
        assert_eq!(
            verdict(4, &pairs, vec![at_rest]),
            "all nodes synchronise for every ε, since each comes to rest by itself"
        );
        assert_eq!(
            verdict(4, &pairs, vec![]),
            "no ε synchronises all nodes: of 3 sigma from 0 to 50 none was found stable"
        );
    }
}
