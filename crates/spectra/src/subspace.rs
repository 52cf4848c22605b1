//! How far apart two subspaces of node space are, whatever bases they are given by.

/// The largest distance of a unit vector of one orthonormalised basis from the span of the other,
/// both ways: 0 for equal spans, 1 where one holds a vector orthogonal to the other.
///
/// - `one`, `other`: bases, a vector of length N each; they need not be orthonormal.
///
/// This is how printed eigenvectors, rounded and of an arbitrary basis, are compared with computed
/// ones: by their eigenspace.
pub fn subspace_distance(one: &[impl AsRef<[f64]>], other: &[impl AsRef<[f64]>]) -> f64 {
    let (one, other) = (orthonormal(one), orthonormal(other));
    let farthest = |vectors: &[Vec<f64>], basis: &[Vec<f64>]| {
        vectors.iter().map(|v| norm(&without(v, basis))).fold(0.0, f64::max)
    };
    farthest(&one, &other).max(farthest(&other, &one))
}

/// Modified Gram–Schmidt.
fn orthonormal(vectors: &[impl AsRef<[f64]>]) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for vector in vectors {
        let rest = without(vector.as_ref(), &basis);
        let length = norm(&rest);
        basis.push(rest.iter().map(|x| x / length).collect());
    }
    basis
}

/// What is left of a vector without its part in the span of an orthonormal basis.
fn without(vector: &[f64], basis: &[Vec<f64>]) -> Vec<f64> {
    let mut rest = vector.to_vec();
    for unit in basis {
        let overlap: f64 = rest.iter().zip(unit).map(|(a, b)| a * b).sum();
        rest.iter_mut().zip(unit).for_each(|(a, b)| *a -= overlap * b);
    }
    rest
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_spans_are_no_distance_apart_in_any_basis() {
        let one = [vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0]];
        let other = [vec![3.0, 4.0, 0.0], vec![1.0, -1.0, 0.0]];
        assert!(subspace_distance(&one, &other) < 1e-15);
    }

    #[test]
    fn a_line_at_an_angle_is_the_sine_of_it_away() {
        let distance = subspace_distance(&[vec![1.0, 0.0]], &[vec![2.0, 2.0]]);
        assert!((distance - 0.5f64.sqrt()).abs() < 1e-15);
        let orthogonal = subspace_distance(&[vec![1.0, 0.0]], &[vec![0.0, 1.0]]);
        assert_eq!(orthogonal, 1.0);
    }

    #[test]
    fn a_basis_that_lacks_a_dimension_is_seen() {
        let plane = [vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0]];
        assert_eq!(subspace_distance(&plane, &plane[..1]), 1.0);
    }
}
