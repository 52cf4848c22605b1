//! Whether the values of several seeds fall into two groups, so far apart that a mean would be of
//! neither, as where seeds settle on different attractors.
//!
//! Values are cut at their widest gap. It counts where it is many times the scatter that it leaves
//! within the parts, and many times what each value is known to. Both parts must have two seeds: a single
//! one that is far off may as well have met a rare burst, and its distance is in the spread. Where
//! isolated oscillators are known to settle on several attractors less will do, and one seed is a group.

/// How far apart groups must be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    /// In units of the scatter within them, and of what each value is known to.
    scatters: f64,
    accuracies: f64,
    /// Of seeds in each.
    least: usize,
}

impl Apart {
    /// Where one attractor is all that is known. Of sets of four seeds that scatter normally one in 150
    /// shows such a gap, of six one in 1000, as the test below has it.
    pub const UNEXPECTED: Self = Self { scatters: 20.0, accuracies: 4.0, least: 2 };
    /// Where isolated oscillators settle on several.
    pub const EXPECTED: Self = Self { scatters: 3.0, accuracies: 2.0, least: 1 };
}

impl Apart {
    /// Whether two parts of these sizes are groups that are so far apart.
    pub fn counts(self, sizes: [usize; 2], gap: f64, scatter: f64, accuracy: f64) -> bool {
        sizes[0].min(sizes[1]) >= self.least
            && gap > (self.scatters * scatter).max(self.accuracies * accuracy)
    }
}

/// The two groups into which values fall that are known to `accuracy`, as positions, the smaller values
/// first; none if they do not.
pub fn groups(values: &[f64], accuracy: f64, apart: Apart) -> Option<Vec<Vec<usize>>> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let gap = |at: &usize| values[order[*at]] - values[order[*at - 1]];
    let cut = (1..order.len()).max_by(|a, b| gap(a).total_cmp(&gap(b)))?;
    let (low, high) = order.split_at(cut);
    let squares: f64 = [low, high].iter().map(|part| squares(values, part)).sum();
    let freedom = values.len() - 2;
    let scatter = if freedom > 0 { (squares / freedom as f64).sqrt() } else { 0.0 };
    let counts = apart.counts([low.len(), high.len()], gap(&cut), scatter, accuracy);
    counts.then(|| vec![low.to_vec(), high.to_vec()])
}

/// Sum of squared deviations from their mean of the values at some positions.
fn squares(values: &[f64], at: &[usize]) -> f64 {
    let mean = at.iter().map(|&k| values[k]).sum::<f64>() / at.len() as f64;
    at.iter().map(|&k| (values[k] - mean).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use rand_core::Rng;
    use rand_pcg::Pcg64;

    use super::*;

    #[test]
    fn two_groups_are_told_from_one_that_scatters() {
        let of = |values: &[f64], apart| groups(values, 0.1, apart);
        assert_eq!(
            of(&[1.0, 9.0, 1.2, 9.1], Apart::UNEXPECTED),
            Some(vec![vec![0, 2], vec![1, 3]])
        );
        assert_eq!(of(&[1.0, 1.4, 1.2, 1.1], Apart::UNEXPECTED), None);
        assert_eq!(of(&[1.0, 1.4, 1.2, 1.1], Apart::EXPECTED), None);
        // One seed alone may have burst, unless several attractors are known.
        assert_eq!(of(&[1.0, 9.0, 1.2], Apart::UNEXPECTED), None);
        assert_eq!(of(&[1.0, 9.0, 1.2], Apart::EXPECTED), Some(vec![vec![0, 2], vec![1]]));
        assert_eq!(of(&[1.0, 9.0], Apart::EXPECTED), Some(vec![vec![0], vec![1]]));
        assert_eq!(of(&[1.0, 1.2], Apart::EXPECTED), None, "known to 0.1 each");
        assert_eq!([of(&[], Apart::EXPECTED), of(&[1.0], Apart::EXPECTED)], [None, None]);
    }

    #[test]
    fn scatter_about_one_value_is_rarely_taken_for_groups() {
        let mut generator = Pcg64::new(1, 1);
        let mut uniform = || generator.next_u64() as f64 / 2f64.powi(64);
        let mut normal = || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        for n_seeds in [4, 6, 10] {
            let alarms = (0..10_000).filter(|_| {
                let values: Vec<f64> = (0..n_seeds).map(|_| normal()).collect();
                groups(&values, 0.0, Apart::UNEXPECTED).is_some()
            });
            let alarms = alarms.count();
            assert!(alarms <= if n_seeds == 4 { 70 } else { 15 }, "{alarms} of {n_seeds} seeds");
        }
    }
}
