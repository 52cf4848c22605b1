//! Whether orbits from different initial states have settled on different attractors: exponents at one
//! σ then fall into groups, far apart against the scatter within them.
//!
//! A gap counts that is twenty times the scatter within the groups that it leaves, pooled over all σ
//! looked at, and ten times both the largest standard error of an exponent by itself, from its blocks,
//! and 1/T, within which an average over a time T knows a periodic orbit. Exponents that scatter normally about one value show
//! such a gap in less than one of 10⁴ rounds, as the test below has it; slow convergence widens the
//! errors of the blocks first.

use dynamics::Estimate;

use crate::{Isolated, StableRegion};

/// One of several attractors.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Attractor {
    /// Orbits that have settled on it, of those tried.
    pub orbits: usize,
    /// How many were tried.
    pub of: usize,
    /// σ at which the attractors were told apart.
    pub told_at: f64,
    /// Λ there.
    pub lambda: Estimate,
    /// Λ(0).
    pub isolated: Estimate,
    /// What Λ(0) says.
    pub state: Isolated,
    /// Where Λ < 0, as far as was looked.
    pub stable: StableRegion,
}

/// How far apart groups must be, against the error of each exponent by itself.
const FAR: f64 = 10.0;
/// The same against the scatter within groups, which is small by the choice of the widest gap.
const FAR_IN_SCATTER: f64 = 20.0;

/// Exponents at one σ, each of an orbit of its own.
pub(crate) struct Column<'a> {
    /// σ.
    pub sigma: f64,
    /// The exponents.
    pub exponents: &'a [Estimate],
}

/// Where the orbits of some column have fallen into groups: the σ with the widest gap.
pub(crate) fn split(columns: &[Column<'_>], floor: f64) -> Option<f64> {
    let cuts: Vec<Cut> =
        columns.iter().filter_map(|column| Cut::widest(column.exponents)).collect();
    let freedom: usize = cuts.iter().map(|cut| cut.freedom).sum();
    if freedom == 0 {
        return None;
    }
    let scatter = (cuts.iter().map(|cut| cut.squares).sum::<f64>() / freedom as f64).sqrt();
    let of_its_own =
        |c: &Column<'_>| c.exponents.iter().map(|e| e.standard_error).fold(0.0, f64::max);
    columns
        .iter()
        .filter_map(|column| {
            let cut = Cut::widest(column.exponents)?;
            let least = (FAR_IN_SCATTER * scatter).max(FAR * of_its_own(column).max(floor));
            (cut.gap > least).then_some((cut.gap / least, column.sigma))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, sigma)| sigma)
}

/// Exponents at one σ by group: their places, the largest group first. One group where no gap counts.
pub(crate) fn groups(exponents: &[Estimate], floor: f64) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..exponents.len()).collect();
    order.sort_by(|&a, &b| exponents[a].mean.total_cmp(&exponents[b].mean));
    let largest = exponents.iter().map(|e| e.standard_error).fold(floor, f64::max);
    let is_near = |a: &usize, b: &usize| exponents[*b].mean - exponents[*a].mean <= FAR * largest;
    let mut groups: Vec<Vec<usize>> = order.chunk_by(is_near).map(<[usize]>::to_vec).collect();
    groups.sort_by_key(|group| std::cmp::Reverse(group.len()));
    groups
}

/// Values cut in two at their widest gap.
struct Cut {
    gap: f64,
    /// Sum of squared deviations within the two parts, with its degrees of freedom.
    squares: f64,
    freedom: usize,
}

impl Cut {
    fn widest(exponents: &[Estimate]) -> Option<Self> {
        let mut values: Vec<f64> = exponents.iter().map(|e| e.mean).collect();
        values.sort_by(f64::total_cmp);
        let gap = |k: &usize| values[*k] - values[*k - 1];
        let at = (1..values.len()).max_by(|a, b| gap(a).total_cmp(&gap(b)))?;
        let (low, high) = values.split_at(at);
        let squares = |part: &[f64]| {
            let mean = part.iter().sum::<f64>() / part.len() as f64;
            part.iter().map(|x| (x - mean).powi(2)).sum::<f64>()
        };
        Some(Self {
            gap: gap(&at),
            squares: squares(low) + squares(high),
            freedom: values.len().saturating_sub(2),
        })
    }
}

#[cfg(test)]
mod tests {
    use rand_core::Rng;
    use rand_pcg::Pcg64;

    use super::*;

    /// About normal: the sum of twelve uniform numbers.
    fn normal(generator: &mut Pcg64) -> f64 {
        (0..12).map(|_| generator.next_u64() as f64 / 2f64.powi(64)).sum::<f64>() - 6.0
    }

    fn columns(values: &[Vec<Estimate>]) -> Vec<Column<'_>> {
        values.iter().map(|exponents| Column { sigma: 1.0, exponents }).collect()
    }

    #[test]
    fn scatter_about_one_value_is_no_alarm_in_ten_thousand_rounds() {
        let mut generator = Pcg64::new(1, 1);
        // The worst case: blocks that say nothing of the scatter between orbits.
        let mut draw = || Estimate { mean: normal(&mut generator), standard_error: 0.0 };
        for shape in [(8, 4), (1, 16)] {
            let alarms = (0..10_000).filter(|_| {
                let values: Vec<Vec<Estimate>> =
                    (0..shape.0).map(|_| (0..shape.1).map(|_| draw()).collect()).collect();
                split(&columns(&values), 0.0).is_some()
            });
            assert_eq!(alarms.count(), 0, "{shape:?}");
        }
    }

    #[test]
    fn two_attractors_are_told_apart_and_one_is_not() {
        let at = |mean: f64| Estimate { mean, standard_error: 1e-3 };
        let two = [vec![at(0.1), at(-0.2), at(0.1005), at(-0.2003)]];
        assert_eq!(split(&columns(&two), 1e-4), Some(1.0));
        assert_eq!(
            groups(&two[0], 1e-4),
            [[1, 3], [0, 2]].map(|g: [usize; 2]| {
                let mut g = g.to_vec();
                g.sort_by(|&a, &b| two[0][a].mean.total_cmp(&two[0][b].mean));
                g
            })
        );
        let one = [vec![at(0.100), at(0.102), at(0.099), at(0.103)]];
        assert_eq!(split(&columns(&one), 1e-4), None);
        assert_eq!(groups(&one[0], 1e-4).len(), 1);
    }

    #[test]
    fn periodic_orbits_in_other_phases_are_one_attractor() {
        // Each block covers whole periods, so that it knows nothing of an error of 1/T.
        let at = |mean: f64| Estimate { mean, standard_error: 1e-9 };
        assert_eq!(split(&columns(&[vec![at(0.0), at(1e-4), at(2e-9), at(1e-4)]]), 1e-4), None);
    }
}
