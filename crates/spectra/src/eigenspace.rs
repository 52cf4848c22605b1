//! An eigenvalue and all that W keeps to itself at it: a real basis with its residuals and its
//! separation from the rest.

use std::fmt;
use std::ops::Range;

/// λ = re + i im.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Eigenvalue {
    /// Re λ.
    pub re: f64,
    /// Im λ; exactly 0 for a matrix that is similar to a symmetric one.
    pub im: f64,
}

impl Eigenvalue {
    /// A real one.
    pub const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    /// Whether Im λ = 0.
    pub fn is_real(self) -> bool {
        self.im == 0.0
    }
}

impl fmt::Display for Eigenvalue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.im {
            0.0 => write!(f, "{}", self.re),
            im => write!(f, "{}{im:+}i", self.re),
        }
    }
}

/// One eigenvalue of W with the space that belongs to it, of a complex pair λ, λ̄ that of both.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Eigenspace {
    /// λ as computed, once for each vector of the basis: equal up to the tolerance of the spectrum,
    /// Re λ descending; of a pair both in turn.
    pub values: Vec<Eigenvalue>,
    /// An orthonormal real basis in node space, one vector of length N each; that of a pair spans the
    /// real and the imaginary parts of its eigenvectors. The component of largest magnitude of a
    /// vector is positive; where several are largest within 1e-6 of it, that of the lowest node. The
    /// basis is one of many: only the span has a meaning.
    pub basis: Vec<Vec<f64>>,
    /// ‖W v − λ v‖ of each vector.
    pub residuals: Vec<f64>,
    /// How far λ is from every other eigenvalue at least: from the nearest one computed, or from what
    /// is known to lie below all of them. Infinite where there is no other.
    pub separation: f64,
}

impl Eigenspace {
    /// Divides real modes, λ descending, into eigenspaces.
    ///
    /// - `ranges`: the modes of each, from 0; they cover all in order.
    /// - `next`: no eigenvalue that is not among the modes exceeds this; −∞ where there is none.
    ///
    /// # Panics
    /// If the parts differ in length, or the ranges do not cover them.
    pub fn divided(
        eigenvalues: &[f64],
        eigenvectors: Vec<Vec<f64>>,
        residuals: &[f64],
        ranges: &[Range<usize>],
        next: f64,
    ) -> Vec<Self> {
        let n_modes = eigenvalues.len();
        assert_eq!((eigenvectors.len(), residuals.len()), (n_modes, n_modes), "vectors, residuals");
        let mut vectors = eigenvectors.into_iter();
        let mut end = 0;
        let of = |range: &Range<usize>| {
            assert!(range.start == end && range.end > end, "eigenspace {range:?} after mode {end}");
            end = range.end;
            let above = range.start.checked_sub(1).map_or(f64::INFINITY, |mode| eigenvalues[mode]);
            let below = eigenvalues.get(end).copied().unwrap_or(next);
            let (first, last) = (eigenvalues[range.start], eigenvalues[end - 1]);
            Self {
                values: eigenvalues[range.clone()].iter().copied().map(Eigenvalue::real).collect(),
                basis: vectors.by_ref().take(range.len()).collect(),
                residuals: residuals[range.clone()].to_vec(),
                separation: (above - first).min(last - below),
            }
        };
        let spaces = ranges.iter().map(of).collect();
        assert_eq!(end, n_modes, "eigenspaces cover {end} of {n_modes} modes");
        spaces
    }

    /// λ, the mean of its computed copies; of a pair the one above the real axis.
    pub fn eigenvalue(&self) -> Eigenvalue {
        let mean = |part: fn(&Eigenvalue) -> f64| {
            self.values.iter().map(part).sum::<f64>() / self.values.len() as f64
        };
        Eigenvalue { re: mean(|value| value.re), im: mean(|value| value.im.abs()) }
    }

    /// How often λ is an eigenvalue.
    pub fn multiplicity(&self) -> usize {
        let of_each = if self.eigenvalue().is_real() { 1 } else { 2 };
        self.basis.len() / of_each
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_space_is_as_far_apart_as_its_nearest_neighbour() {
        let eigenvalues = [0.0, -1.0, -1.0, -4.0];
        let vectors = vec![vec![1.0, 0.0, 0.0, 0.0]; 4];
        let spaces = |next| {
            Eigenspace::divided(&eigenvalues, vectors.clone(), &[0.0; 4], &[0..1, 1..3, 3..4], next)
        };
        let separations = |next| spaces(next).iter().map(|s| s.separation).collect::<Vec<_>>();
        assert_eq!(separations(f64::NEG_INFINITY), [1.0, 1.0, 3.0]);
        assert_eq!(separations(-4.5), [1.0, 1.0, 0.5]);
        let middle = &spaces(-4.5)[1];
        assert_eq!((middle.eigenvalue(), middle.multiplicity()), (Eigenvalue::real(-1.0), 2));
        let whole = std::iter::once(0..1).collect::<Vec<_>>();
        let alone = Eigenspace::divided(&[0.0], vec![vec![1.0]], &[0.0], &whole, f64::NEG_INFINITY);
        assert_eq!(alone[0].separation, f64::INFINITY);
    }

    #[test]
    fn a_pair_counts_once_and_lies_above_the_real_axis() {
        let at = |im| Eigenvalue { re: -1.0, im };
        let pair = Eigenspace {
            values: vec![at(2.0), at(-2.0)],
            basis: vec![vec![1.0, 0.0], vec![0.0, 1.0]],
            residuals: vec![0.0; 2],
            separation: 1.0,
        };
        assert_eq!((pair.eigenvalue(), pair.multiplicity()), (at(2.0), 1));
        assert_eq!(format!("{} {}", at(-2.0), Eigenvalue::real(-0.5)), "-1-2i -0.5");
    }
}
