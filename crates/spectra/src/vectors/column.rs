//! Single vectors: sums that keep their accuracy, and Gram–Schmidt against an orthonormal set.

/// Length of the blocks in which scalar products are summed.
const BLOCK: usize = 256;

/// Σ_i a_i b_i, summed in halves, so that the rounding error grows with log N and not with N.
///
/// In a plain sum over N = 20,000 nodes the error of ‖(1, 1, …)/√N‖² alone is 4·10⁻¹³. The order of
/// summation depends on the length only.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "lengths of a scalar product");
    if a.len() <= BLOCK {
        return block_dot(a, b);
    }
    let (a_low, a_high) = a.split_at(a.len() / 2);
    let (b_low, b_high) = b.split_at(b.len() / 2);
    dot(a_low, b_low) + dot(a_high, b_high)
}

/// Σ_i a_i b_i in four partial sums, which a processor can add up side by side.
fn block_dot(a: &[f64], b: &[f64]) -> f64 {
    let (a_fours, a_rest) = a.as_chunks::<4>();
    let (b_fours, b_rest) = b.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (a, b) in a_fours.iter().zip(b_fours) {
        for lane in 0..4 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a_i, b_i)| a_i * b_i).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// The 2-norm.
pub(crate) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// Divides a vector by its 2-norm, and returns that.
pub(crate) fn normalise(a: &mut [f64]) -> f64 {
    let length = norm(a);
    for a_i in a {
        *a_i /= length;
    }
    length
}

/// y += c x.
pub(crate) fn add_scaled(c: f64, x: &[f64], y: &mut [f64]) {
    for (y_i, x_i) in y.iter_mut().zip(x) {
        *y_i += c * x_i;
    }
}

/// Removes from y its components along an orthonormal set.
pub(crate) fn project_out(set: &[Vec<f64>], y: &mut [f64]) {
    for q in set {
        add_scaled(-dot(q, y), q, y);
    }
}

/// Makes a vector orthogonal to an orthonormal set and of unit norm; returns the fraction of its
/// length that was orthogonal before.
///
/// The second round of Gram–Schmidt removes what rounding left after the first.
pub(crate) fn orthonormalise_against(set: &[Vec<f64>], vector: &mut [f64]) -> f64 {
    normalise(vector);
    if set.is_empty() {
        return 1.0;
    }
    project_out(set, vector);
    let kept = normalise(vector);
    project_out(set, vector);
    normalise(vector);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_norm_of_a_long_constant_vector_is_exact_to_rounding() {
        for n in [1, 5, 257, 20_000, 1_000_003] {
            let a = vec![0.1; n];
            let exact = 0.1 * (n as f64).sqrt();
            assert!((norm(&a) - exact).abs() < 4.0 * f64::EPSILON * exact, "{n}");
        }
    }

    #[test]
    fn a_vector_becomes_orthogonal_even_when_little_of_it_was() {
        let q = vec![0.6, 0.8, 0.0];
        let mut vector = vec![3.0, 4.0, 1e-9];
        let kept = orthonormalise_against(std::slice::from_ref(&q), &mut vector);
        assert!((kept - 2e-10).abs() < 1e-15, "{kept}");
        assert!(dot(&q, &vector).abs() < 1e-16 && (vector[2] - 1.0).abs() < 1e-15);
    }
}
