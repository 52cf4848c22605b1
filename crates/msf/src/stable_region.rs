//! The stable set {σ ≥ 0 : Λ(σ) < 0} as intervals.

/// One interval of stable σ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end: the zero of Λ, or 0 when Λ(0) < 0.
    pub from: f64,
    /// Upper end; none when Λ < 0 up to the largest σ that was looked at.
    pub to: Option<f64>,
}

/// The stable set: disjoint intervals in ascending order, possibly none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StableRegion {
    /// Disjoint, ascending.
    pub intervals: Vec<Interval>,
}

impl StableRegion {
    /// Whether a mode with this σ = −ελ is damped.
    pub fn contains(&self, sigma: f64) -> bool {
        self.intervals.iter().any(|i| sigma > i.from && i.to.is_none_or(|to| sigma < to))
    }
}
