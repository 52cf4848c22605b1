//! A randomised test of completeness: random vectors on the complement of the modes found, and with which confidence they would
//! have shown an eigenvalue that is missing.
//!
//! Let y = T(S) x with x standard normal on the complement of the modes, T the Chebyshev polynomial
//! of degree d on [a, c], and θ the largest Ritz value of the span of all y. If an eigenvalue Λ > θ
//! with eigenvector u were left in the complement, then θ ≥ ⟨y, S y⟩ / ⟨y, y⟩ would demand
//!
//! ```text
//! ⟨u, x⟩² T(Λ)² (Λ − θ)  ≤  Σ_i ⟨u_i, x⟩² T(λ_i)² (θ − λ_i)  ≤  |x|² T(θ)² (θ − a)
//! ```
//!
//! (eigenvalues between θ and Λ only help, and |T| ≤ T(max(θ, c)) below θ). The component of a random
//! direction in N dimensions has a density of at most √(N / 2π), so one probe misses Λ with a
//! probability of at most √(2 N η / π), η = T(θ)² (θ − a) / (T(Λ)² (Λ − θ)), and p independent probes
//! with its p-th power. The exponent 2 d √(2 (Λ − c) / (c − a)) is that of Kuczyński & Woźniakowski,
//! SIAM J. Matrix Anal. Appl. 13, 1094 (1992), who bound Lanczos' method from a random vector.

use std::f64::consts::PI;

use crate::error::SpectraError;
use crate::matrix::product::Links;
use crate::progress::Asked;
use crate::recurrences::chebyshev::{Interval, filter_between};
use crate::vectors::basis::Basis;
use crate::vectors::block::Block;
use crate::vectors::random::Random;
use crate::vectors::small_eigen::symmetric_eigen;

/// The probability of a miss that probing aims at.
const MISS: f64 = 1e-6;
/// The probability with which it is content: θ may come to lie higher than expected.
const SMALL_ENOUGH: f64 = 1e-5;
/// Filters that probes pass at most.
const MOST_FILTERS: usize = 5;
/// Degree of a first filter where no affordable one would prove anything: the probes may still show
/// what is in the way.
const HOPELESS: usize = 100;
/// By how much the degree of a filter exceeds what suffices for the θ expected.
const MARGIN: f64 = 1.03;
/// A filter may amplify what is left of the modes by this much before they are projected out again.
const STRETCH_GAIN: f64 = 1e12;

/// Where to look for what.
pub(crate) struct Probe {
    /// At most the smallest eigenvalue.
    pub low: f64,
    /// The largest eigenvalue expected in the complement.
    pub expected: f64,
    /// Λ: eigenvalues from here on must not be missing.
    pub limit: f64,
    /// The largest eigenvalue of the modes.
    pub top: f64,
    /// Most products to spend.
    pub max_products: usize,
    /// Number of random vectors, if the complement has so many dimensions.
    pub probes: usize,
}

/// What the probes brought.
pub(crate) struct Probed {
    /// Orthonormal vectors of the complement.
    pub block: Option<Block>,
    /// Their largest Ritz value.
    pub theta: f64,
    /// 1 less the probability that Λ was missed.
    pub confidence: f64,
    /// Products spent.
    pub products: usize,
    /// Number of random vectors.
    pub probes: usize,
}

/// A filter that probes have passed.
struct Passed {
    unwanted: Interval,
    degree: usize,
}

impl Passed {
    /// By how much Λ has been amplified more than θ, as a logarithm.
    fn gain(&self, limit: f64, theta: f64) -> f64 {
        self.unwanted.log_gain(self.degree, limit) - self.unwanted.log_gain(self.degree, theta)
    }
}

impl Probe {
    /// Sends the probes through the complement of the first `n_modes` vectors of the basis.
    ///
    /// The polynomial is a product of a few Chebyshev polynomials, each with the largest eigenvalue
    /// expected, or seen so far, as its c: their gains multiply.
    pub fn send(
        &self,
        links: &Links<'_>,
        modes: (&Basis, usize),
        random: &mut Random,
        asked: Asked<'_>,
    ) -> Result<Probed, SpectraError> {
        let (basis, n_modes) = modes;
        let n_rows = basis.n_rows();
        let probes = self.probes.min(n_rows - n_modes);
        let enough = MISS.ln() / probes as f64;
        let clean = |block: &mut Block| basis.project_out_first(n_modes, block);
        let mut passed = Vec::new();
        // When nothing is missing, the largest Ritz value comes to lie in the middle of the bulk.
        let mut theta = self.expected.min(0.5 * (self.low + self.limit));
        let (mut products, mut miss) = (0, 0.0);
        let mut block = Some(random.block(n_rows, probes));
        while let Some(mut probes_now) = block.take() {
            let unwanted = self.unwanted(theta.max(self.expected));
            let most = self.max_products.saturating_sub(products) / probes_now.width();
            let needed = self.degree(n_rows, &passed, (unwanted, theta), enough);
            let degree = if needed <= most { needed } else { most.min(HOPELESS) };
            if degree == 0 || (needed > most && !passed.is_empty()) {
                block = Some(probes_now);
                break;
            }
            let stretch = unwanted.stretch(self.top, STRETCH_GAIN);
            clean(&mut probes_now);
            let before = products;
            products += (degree + 1) * probes_now.width();
            let asked = |more: usize| asked(before + more);
            let filtered =
                filter_between(links, probes_now, (degree, stretch), unwanted, clean, &asked)?;
            block = basis.orthonormalise_against_first(n_modes, filtered)?;
            theta =
                block.as_ref().map_or(Ok(self.low), |block| largest_ritz_value(links, block))?;
            passed.push(Passed { unwanted, degree });
            miss = self.log_miss(n_rows, &passed, theta).min(0.0);
            if miss <= SMALL_ENOUGH.ln() / probes as f64
                || theta >= self.limit
                || passed.len() == MOST_FILTERS
            {
                break;
            }
        }
        let confidence = -(miss * probes as f64).exp_m1();
        Ok(Probed { block, theta, confidence, products, probes })
    }

    /// An interval with the given upper end, not so narrow that the filter's gains overflow.
    fn unwanted(&self, high: f64) -> Interval {
        Interval { low: self.low.min(high - 0.05 * (self.top - self.low)), high }
    }

    /// The degree that leaves a miss as improbable as aimed at, if θ stays as it is.
    fn degree(
        &self,
        n_rows: usize,
        passed: &[Passed],
        (unwanted, theta): (Interval, f64),
        enough: f64,
    ) -> usize {
        let missing = self.log_miss(n_rows, passed, theta) - enough;
        let per_degree = unwanted.growth(self.limit);
        // cosh x ≥ ½ eˣ
        let degree = ((missing + std::f64::consts::LN_2) / per_degree).max(1.0);
        (MARGIN * degree).min(1e9).ceil() as usize
    }

    /// ln √(2 N η / π).
    fn log_miss(&self, n_rows: usize, passed: &[Passed], theta: f64) -> f64 {
        if theta >= self.limit {
            return 0.0;
        }
        let gain: f64 = passed.iter().map(|filter| filter.gain(self.limit, theta)).sum();
        let ratio = (theta - self.low).max(0.0) / (self.limit - theta);
        0.5 * (2.0 * n_rows as f64 / PI * ratio).ln() - gain
    }
}

fn largest_ritz_value(links: &Links<'_>, block: &Block) -> Result<f64, SpectraError> {
    let image = links.multiply(block);
    let projected = block.overlaps(&image);
    let pairs =
        symmetric_eigen(block.width(), |i, j| 0.5 * (projected[(i, j)] + projected[(j, i)]))?;
    Ok(pairs.values[0])
}
