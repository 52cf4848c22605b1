//! How well two distances over the same pairs of nodes agree: Pearson's r, the linear correlation,
//! and Spearman's ρ, the linear correlation of the ranks.
//!
//! ```text
//! r = Σ (x − x̄)(y − ȳ) / √(Σ (x − x̄)² Σ (y − ȳ)²),    ρ = r of the ranks, ties at their mean rank.
//! ```
//!
//! r = 1 where y = a + b x with b > 0, as δx_ij ∝ δe_ij would have it, and ρ = 1 where y increases
//! with x at all. Pairs of N nodes are not independent of one another: neither number comes with a
//! significance here.
//!
//! Source: Spearman, Am. J. Psychol. 15, 72 (1904); Kendall, Biometrika 33, 239 (1945), for ties.

/// The correlation of two quantities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// Pearson's r, between −1 and 1.
    pub pearson: f64,
    /// Spearman's ρ, between −1 and 1.
    pub spearman: f64,
}

/// The correlation of two symmetric distances over the pairs i < j of nodes, each asked for once a
/// pair: δx_ij with δe_ij. O(N² log N), memory O(N²).
///
/// None where it is not defined, as [`pearson`] has it: with fewer than three nodes, for example,
/// or where the one is the same for all pairs.
pub fn correlation_of_pairs(
    n_nodes: usize,
    one: impl Fn(usize, usize) -> f64,
    other: impl Fn(usize, usize) -> f64,
) -> Option<Correlation> {
    let (one, other) = (over_pairs(n_nodes, one), over_pairs(n_nodes, other));
    Some(Correlation { pearson: pearson(&one, &other)?, spearman: spearman(&one, &other)? })
}

/// Pearson's r of two samples, between −1 and 1.
///
/// None where it is not defined: fewer than two values, all values of a sample equal, or a value
/// that is not finite.
///
/// # Panics
/// If the samples differ in length.
pub fn pearson(x: &[f64], y: &[f64]) -> Option<f64> {
    check_lengths(x, y);
    let (x, y) = (unit_deviations(x)?, unit_deviations(y)?);
    let r: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum();
    Some(r.clamp(-1.0, 1.0))
}

/// Spearman's ρ of two samples, between −1 and 1: [`pearson`] of their ranks, equal values at the
/// mean of the ranks they share. O(n log n).
///
/// None as [`pearson`] has it.
///
/// # Panics
/// If the samples differ in length.
pub fn spearman(x: &[f64], y: &[f64]) -> Option<f64> {
    check_lengths(x, y);
    let is_finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
    if is_finite(x) && is_finite(y) { pearson(&ranks(x), &ranks(y)) } else { None }
}

fn check_lengths(x: &[f64], y: &[f64]) {
    assert_eq!(x.len(), y.len(), "samples of {} and {} values", x.len(), y.len());
}

fn over_pairs(n_nodes: usize, distance: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let pairs = (0..n_nodes).flat_map(|i| (i + 1..n_nodes).map(move |j| (i, j)));
    pairs.map(|(i, j)| distance(i, j)).collect()
}

/// (x − x̄) / ‖x − x̄‖, if all values are finite and some differ.
fn unit_deviations(values: &[f64]) -> Option<Vec<f64>> {
    let is_constant = values.windows(2).all(|pair| pair[0] == pair[1]);
    if is_constant || !values.iter().all(|value| value.is_finite()) {
        return None;
    }
    // Values of the order of one: their squares neither overflow nor vanish.
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let scaled: Vec<f64> = values.iter().map(|value| value / largest).collect();
    let mean = scaled.iter().sum::<f64>() / scaled.len() as f64;
    let deviations: Vec<f64> = scaled.iter().map(|value| value - mean).collect();
    let norm = deviations.iter().map(|d| d * d).sum::<f64>().sqrt();
    Some(deviations.into_iter().map(|d| d / norm).collect())
}

/// Ranks from 1, equal values at their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_unstable_by(|&i, &j| values[i].total_cmp(&values[j]));
    let mut ranks = vec![0.0; values.len()];
    let mut start = 0;
    for ties in order.chunk_by(|&i, &j| values[i] == values[j]) {
        let end = start + ties.len();
        let mean = 0.5 * (start + 1 + end) as f64;
        ties.iter().for_each(|&i| ranks[i] = mean);
        start = end;
    }
    ranks
}
