//! The largest |eigenvalue| of a product P_N … P_1 of small matrices, which may be too large or too small for
//! a number: that of a limit cycle is its largest Floquet multiplier.
//!
//! Orthonormal vectors Q are taken round, and made orthonormal again after each factor: P_k Q_{k−1} = Q_k R_k.
//! After some rounds the first of them spans the leading direction, and Σ log R_k,11 is the logarithm of its
//! eigenvalue; where two eigenvalues have one size, as a complex pair has, the first two span their plane,
//! in which the product is a small matrix that is scaled on the way.
//!
//! Source: orthogonal iteration as in G. H. Golub & C. F. Van Loan, Matrix Computations (2013), Sec. 7.3,
//! factor by factor as in A. Bojanczyk, G. Golub & P. Van Dooren, Proc. SPIE 1770, 31 (1992).

use nalgebra::{Complex, DMatrix};

use crate::small_eigenvalues::eigenvalues;

/// Rounds after which all directions are taken together.
const MOST_ROUNDS: usize = 60;
/// Directions stay within themselves when no more than this of a round leaves them.
const STAYS: f64 = 1e-11;

/// log of the largest |eigenvalue| of the product of matrices of shape (n, n), each row by row, the first of
/// them applied first. Nothing is smaller than the smallest number.
pub(super) fn log_spectral_radius(factors: &[f64], n: usize) -> f64 {
    let mut frame = start(n);
    for round in 1..=MOST_ROUNDS {
        let Round { end, product, log_scale, log_first } = Round::of(factors, n, &frame);
        let turned = transposed_times(&frame, &end, n);
        let leaves = |k: usize| {
            let below = (k..n).flat_map(|row| (0..k).map(move |c| (row, c)));
            below.map(|(row, c)| turned[row * n + c].powi(2)).sum::<f64>().sqrt()
        };
        let stays = (1..n).find(|&k| leaves(k) <= STAYS);
        match stays {
            Some(1) => return log_first,
            Some(k) => return of_block((&turned, &product), (n, k), log_scale),
            None if n == 1 => return log_first,
            None if round == MOST_ROUNDS => {
                return of_block((&turned, &product), (n, n), log_scale);
            }
            None => frame = end,
        }
    }
    unreachable!("the last round answers")
}

/// One round of orthonormal vectors.
struct Round {
    /// The vectors at its end, column by column of a matrix that is stored row by row.
    end: Vec<f64>,
    /// R_N … R_1, over exp(`log_scale`).
    product: Vec<f64>,
    log_scale: f64,
    /// Σ log R_k,11.
    log_first: f64,
}

impl Round {
    fn of(factors: &[f64], n: usize, frame: &[f64]) -> Self {
        let mut end = frame.to_vec();
        let mut product: Vec<f64> = identity(n);
        let (mut log_scale, mut log_first) = (0.0, 0.0);
        for factor in factors.chunks_exact(n * n) {
            let mut moved = times(factor, &end, n);
            let r = orthonormalise(&mut moved, n);
            log_first += libm::log(r[0].max(f64::MIN_POSITIVE));
            product = times(&r, &product, n);
            let size = product.iter().fold(f64::MIN_POSITIVE, |size, x| size.max(x.abs()));
            product.iter_mut().for_each(|x| *x /= size);
            log_scale += libm::log(size);
            end = moved;
        }
        Self { end, product, log_scale, log_first }
    }
}

/// From the leading k directions alone.
fn of_block((turned, product): (&[f64], &[f64]), (n, k): (usize, usize), log_scale: f64) -> f64 {
    let whole = times(turned, product, n);
    let block = DMatrix::from_fn(k, k, |row, column| whole[row * n + column]);
    let sizes = eigenvalues(block).into_iter().flatten().map(Complex::norm);
    libm::log(sizes.fold(f64::MIN_POSITIVE, f64::max)) + log_scale
}

/// Orthonormal vectors that lie along no axis, so that whatever leads has a part along the first.
fn start(n: usize) -> Vec<f64> {
    // The fractional parts of multiples of the golden ratio lie in no pattern.
    let mut frame: Vec<f64> =
        (1..=n * n).map(|k| (k as f64 * 0.618_033_988_749_894_9).fract() - 0.3).collect();
    orthonormalise(&mut frame, n);
    frame
}

/// Makes the columns orthonormal by Gram & Schmidt, twice; gives R. A column of which nothing is left
/// becomes some direction that is orthogonal to the others.
fn orthonormalise(columns: &mut [f64], n: usize) -> Vec<f64> {
    let mut r = vec![0.0; n * n];
    for c in 0..n {
        let length =
            |columns: &[f64]| (0..n).map(|row| columns[row * n + c].powi(2)).sum::<f64>().sqrt();
        let before = length(columns);
        for _ in 0..2 {
            for other in 0..c {
                let along: f64 =
                    (0..n).map(|row| columns[row * n + other] * columns[row * n + c]).sum();
                (0..n).for_each(|row| columns[row * n + c] -= along * columns[row * n + other]);
                r[other * n + c] += along;
            }
        }
        let left = length(columns);
        // Below this only rounding is left.
        if left > 1e-15 * before && left > 1e-150 {
            r[c * n + c] = left;
            (0..n).for_each(|row| columns[row * n + c] /= left);
        } else {
            r[c * n + c] = 0.0;
            fill(columns, n, c);
        }
    }
    r
}

/// A unit vector orthogonal to the columns before.
fn fill(columns: &mut [f64], n: usize, c: usize) {
    for axis in 0..n {
        (0..n).for_each(|row| columns[row * n + c] = f64::from(u8::from(row == axis)));
        for _ in 0..2 {
            for other in 0..c {
                let along: f64 =
                    (0..n).map(|row| columns[row * n + other] * columns[row * n + c]).sum();
                (0..n).for_each(|row| columns[row * n + c] -= along * columns[row * n + other]);
            }
        }
        let left = (0..n).map(|row| columns[row * n + c].powi(2)).sum::<f64>().sqrt();
        if left > 0.5 / (n as f64).sqrt() {
            (0..n).for_each(|row| columns[row * n + c] /= left);
            return;
        }
    }
}

fn identity(n: usize) -> Vec<f64> {
    (0..n * n).map(|at| f64::from(u8::from(at / n == at % n))).collect()
}

/// A B, each row by row.
fn times(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let mut product = vec![0.0; n * n];
    for row in 0..n {
        for k in 0..n {
            let factor = a[row * n + k];
            (0..n).for_each(|c| product[row * n + c] += factor * b[k * n + c]);
        }
    }
    product
}

/// Aᵀ B.
fn transposed_times(a: &[f64], b: &[f64], n: usize) -> Vec<f64> {
    let entry = |at: usize| (0..n).map(|k| a[k * n + at / n] * b[k * n + at % n]).sum();
    (0..n * n).map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn repeated(factor: &[f64], times: usize) -> Vec<f64> {
        factor.repeat(times)
    }

    #[test]
    fn a_product_too_small_or_too_large_for_a_number_has_its_logarithm() {
        // Upper triangular: the eigenvalues are the products of the diagonals.
        for scale in [1e-20, 1.0, 1e20] {
            let factor = [0.5, 3.0, -1.0, 0.0, 0.9, 7.0, 0.0, 0.0, 0.1].map(|x| x * scale);
            let log = log_spectral_radius(&repeated(&factor, 100), 3);
            assert!((log - 100.0 * (0.9 * scale).ln()).abs() < 1e-9, "{log}");
        }
    }

    #[test]
    fn a_complex_pair_leads_with_its_modulus() {
        // A rotation by 1 that shrinks by 0.7, beside a decay by 0.3, in axes that are not orthogonal.
        let (s, c) = (0.7 * 1f64.sin(), 0.7 * 1f64.cos());
        let factor = [c, -s, 5.0, s, c, -2.0, 0.0, 0.0, 0.3];
        let log = log_spectral_radius(&repeated(&factor, 30), 3);
        assert!((log - 30.0 * 0.7f64.ln()).abs() < 1e-10, "{log}");
    }

    #[test]
    fn what_leads_apart_from_the_rest_is_seen() {
        let factor = [0.5, 0.0, 0.0, 0.0, 0.6, 0.0, 0.0, 0.0, 0.999];
        let log = log_spectral_radius(&repeated(&factor, 7), 3);
        assert!((log - 7.0 * 0.999f64.ln()).abs() < 1e-12);
    }

    #[test]
    fn eigenvalues_of_almost_one_size_are_told_from_all_together() {
        let factor = [0.9, 1.0, 0.0, 0.0, 0.9 + 1e-7, 1.0, 0.0, 0.0, 0.9 - 1e-7];
        let log = log_spectral_radius(&repeated(&factor, 2), 3);
        assert!((log - 2.0 * 0.9f64.ln()).abs() < 1e-4, "{log}");
    }

    #[test]
    fn of_one_component_it_is_the_product() {
        assert!((log_spectral_radius(&[-2.0, 0.25, 3.0], 1) - 1.5f64.ln()).abs() < 1e-15);
        assert!(log_spectral_radius(&[0.0, 2.0], 1) < -700.0);
    }

    #[test]
    fn a_singular_factor_leaves_what_it_leaves() {
        let factors = [1.0, 1.0, 1.0, 1.0, 0.5, 0.0, 0.0, 0.25];
        let log = log_spectral_radius(&factors, 2);
        assert!((log - 0.75f64.ln()).abs() < 1e-12, "{log}");
    }
}
