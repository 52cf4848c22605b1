//! Small linear systems by Gaussian elimination with partial pivoting, in place.

/// Solves A X = B for B, both row by row: A of shape (n, n), B of shape (n, m). None where A is singular.
pub(super) fn solve(a: &mut [f64], b: &mut [f64], n: usize) -> Option<()> {
    let m = b.len() / n;
    for pivot in 0..n {
        let largest = (pivot..n)
            .max_by(|&i, &j| a[i * n + pivot].abs().total_cmp(&a[j * n + pivot].abs()))?;
        if largest != pivot {
            (0..n).for_each(|c| a.swap(pivot * n + c, largest * n + c));
            (0..m).for_each(|c| b.swap(pivot * m + c, largest * m + c));
        }
        let by = a[pivot * n + pivot];
        if by == 0.0 || !by.is_finite() {
            return None;
        }
        for row in pivot + 1..n {
            let factor = a[row * n + pivot] / by;
            if factor == 0.0 {
                continue;
            }
            let (above, below) = a.split_at_mut(row * n);
            for c in pivot..n {
                below[c] -= factor * above[pivot * n + c];
            }
            let (above, below) = b.split_at_mut(row * m);
            for c in 0..m {
                below[c] -= factor * above[pivot * m + c];
            }
        }
    }
    for row in (0..n).rev() {
        for c in 0..m {
            let known: f64 = (row + 1..n).map(|k| a[row * n + k] * b[k * m + c]).sum();
            b[row * m + c] = (b[row * m + c] - known) / a[row * n + row];
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_whose_first_pivot_is_zero_is_solved() {
        let a = [0.0, 2.0, 1.0, 1.0, 1.0, 1.0, 4.0, 0.0, 1.0];
        let b = [7.0, 1.0, 6.0, 1.0, 7.0, 1.0];
        let (mut lu, mut x) = (a, b);
        solve(&mut lu, &mut x, 3).unwrap();
        for row in 0..3 {
            for c in 0..2 {
                let sum: f64 = (0..3).map(|k| a[row * 3 + k] * x[k * 2 + c]).sum();
                assert!((sum - b[row * 2 + c]).abs() < 1e-14, "{x:?}");
            }
        }
    }

    #[test]
    fn a_singular_matrix_is_none() {
        assert_eq!(solve(&mut [1.0, 2.0, 2.0, 4.0], &mut [1.0, 1.0], 2), None);
    }
}
