//! The stable set {σ ≥ 0 : Λ(σ) < 0} as intervals, each end of which says what it is.

use crate::Zero;

/// Where an interval of stable σ ends, and why there.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum End {
    /// At a zero of Λ.
    Zero(Zero),
    /// At σ = 0.
    Origin {
        /// Whether nodes become equal at σ = 0: Λ(0) < 0, oscillators at rest in the same state.
        /// Otherwise they rest in different ones, or Λ(0) = 0, a periodic orbit, and Λ is negative
        /// right above.
        included: bool,
    },
    /// Nowhere that is known: Λ < 0 up to the end of what was looked at.
    Looked {
        /// The smallest or largest σ that was looked at.
        sigma: f64,
    },
}

impl End {
    /// σ of the end.
    pub fn sigma(&self) -> f64 {
        match *self {
            Self::Zero(zero) => zero.sigma,
            Self::Origin { .. } => 0.0,
            Self::Looked { sigma } => sigma,
        }
    }

    /// The zero that it is.
    pub fn zero(&self) -> Option<Zero> {
        match *self {
            Self::Zero(zero) => Some(zero),
            _ => None,
        }
    }

    /// Whether it is the end of what was looked at only.
    pub fn is_looked(&self) -> bool {
        matches!(self, Self::Looked { .. })
    }
}

/// One interval of stable σ.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Interval {
    /// Lower end. Nothing is known below it where it is [`End::Looked`].
    pub from: End,
    /// Upper end. Where it is [`End::Looked`], predictions take the interval as unbounded.
    pub to: End,
}

impl Interval {
    /// An interval between ends that are known exactly: zeros of Λ, or the origin where `from` is 0.
    /// Without `to`, all σ above `from` are stable.
    pub fn known(from: f64, to: Option<f64>) -> Self {
        let zero = |sigma, falling| End::Zero(Zero::exact(sigma, falling));
        Self {
            from: if from == 0.0 { End::Origin { included: false } } else { zero(from, true) },
            to: to.map_or(End::Looked { sigma: f64::INFINITY }, |to| zero(to, false)),
        }
    }

    /// σ of the lower end.
    pub fn lower(&self) -> f64 {
        self.from.sigma()
    }

    /// σ of the upper end; none where Λ < 0 as far as was looked.
    pub fn upper(&self) -> Option<f64> {
        (!self.to.is_looked()).then(|| self.to.sigma())
    }

    /// Whether a mode with this σ is damped; beyond what was looked at as at its end.
    pub fn contains(&self, sigma: f64) -> bool {
        let above = match self.from {
            End::Origin { included } => sigma > 0.0 || included,
            end => sigma > end.sigma(),
        };
        above && self.upper().is_none_or(|to| sigma < to)
    }
}

/// The stable set: disjoint intervals in ascending order, possibly none.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StableRegion {
    /// Disjoint, ascending.
    pub intervals: Vec<Interval>,
}

impl StableRegion {
    /// Whether a mode with this σ = −ελ is damped. One with σ = 0 is where Λ(0) < 0 and oscillators
    /// come to rest in the same state.
    pub fn contains(&self, sigma: f64) -> bool {
        self.intervals.iter().any(|interval| interval.contains(sigma))
    }

    /// Every zero of Λ that bounds it, ascending.
    pub fn zeros(&self) -> impl Iterator<Item = Zero> {
        self.intervals.iter().flat_map(|i| [i.from, i.to]).filter_map(|end| end.zero())
    }

    /// σ up to which nothing is known, where the lowest interval begins where the look began.
    pub fn unknown_below(&self) -> Option<f64> {
        self.intervals.first().filter(|first| first.from.is_looked()).map(Interval::lower)
    }

    /// Whether no σ that was looked at last is unstable, so that large σ count as stable.
    pub fn is_unbounded(&self) -> bool {
        self.intervals.last().is_some_and(|last| last.upper().is_none())
    }

    /// σ_c: the edge of the stable set where that is σ > σ_c, as far as was looked.
    pub fn sigma_c(&self) -> Option<Zero> {
        match self.intervals[..] {
            [Interval { from: End::Zero(zero), to: End::Looked { .. } }] => Some(zero),
            _ => None,
        }
    }

    /// Takes σ = 0 out: without coupling nodes do not become equal.
    pub(crate) fn exclude_origin(&mut self) {
        for interval in &mut self.intervals {
            if let End::Origin { included } = &mut interval.from {
                *included = false;
            }
        }
    }

    /// What is stable in both.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let mut intervals = Vec::new();
        for a in &self.intervals {
            for b in &other.intervals {
                let from = higher(a.from, b.from);
                let beyond = |i: &Interval| i.upper().unwrap_or(f64::INFINITY);
                let to = if beyond(a) <= beyond(b) { a.to } else { b.to };
                if from.sigma() < to.sigma() {
                    intervals.push(Interval { from, to });
                }
            }
        }
        Self { intervals }
    }
}

/// The higher of two lower ends; σ = 0 is included only in both.
fn higher(a: End, b: End) -> End {
    match (a, b) {
        (End::Origin { included }, End::Origin { included: as_well }) => {
            End::Origin { included: included && as_well }
        }
        _ if a.sigma() >= b.sigma() => a,
        _ => b,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_origin_is_stable_only_where_it_is_included() {
        let to = End::Looked { sigma: 9.0 };
        let region = |included| StableRegion {
            intervals: vec![Interval { from: End::Origin { included }, to }],
        };
        assert!(region(true).contains(0.0) && !region(false).contains(0.0));
        assert!(region(false).contains(1e-300) && region(false).contains(10.0));
    }

    #[test]
    fn sigma_c_is_a_zero_and_nothing_else() {
        let to = End::Looked { sigma: 9.0 };
        let of = |from| StableRegion { intervals: vec![Interval { from, to }] }.sigma_c();
        let zero = Zero::exact(8.0, true);
        assert_eq!(of(End::Zero(zero)), Some(zero));
        assert_eq!(of(End::Looked { sigma: 8.0 }), None);
        assert_eq!(of(End::Origin { included: true }), None);
        let bounded = StableRegion { intervals: vec![Interval::known(0.2, Some(4.6))] };
        assert_eq!(bounded.sigma_c(), None);
    }

    #[test]
    fn an_intersection_is_what_lies_in_both() {
        let region = |ends: &[(f64, Option<f64>)]| StableRegion {
            intervals: ends.iter().map(|&(from, to)| Interval::known(from, to)).collect(),
        };
        let both = region(&[(1.0, Some(4.0)), (5.0, None)])
            .intersection(&region(&[(0.0, Some(2.0)), (3.0, None)]));
        assert_eq!(both, region(&[(1.0, Some(2.0)), (3.0, Some(4.0)), (5.0, None)]));
    }
}
