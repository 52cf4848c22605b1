//! Clusters under one threshold for many sets of unstable modes: one pass over the pairs of nodes
//! instead of one a set.
//!
//! With eigenspaces b = 0, 1, …, projectors P_b and the factors c_d of `distance`, a pair's running
//! sums and its distance under a set of m modes that fills the runs [s, e) of eigenspaces are
//!
//! ```text
//! S_b = Σ_{a<b} c_{d_a} ‖P_a(e_i − e_j)‖,    m δe_ij = Σ_runs (S_e − S_s).
//! ```
//!
//! The sets of a cascade have few runs (one where the stable set is σ > σ_c), so that a pair costs
//! O(modes + sets) where one set after the other costs O(modes · sets). Differences of running sums
//! round otherwise than the distance itself: a pair whose m δe_ij is closer to the threshold than
//! rounding can account for is decided by [`EigenvectorDistance`]'s own sum, so that the clusters
//! are the same in every case.

use std::ops::Range;

use spectra::RealModes;

use crate::disjoint_sets::DisjointSetFamilies;
use crate::metric::Block;
use crate::modes::{check_threshold, chosen_eigenspaces, transverse};
use crate::progress::{Progress, go_on};
use crate::{ClusteringError, EigenvectorDistance, Partition, mean_over_bases};

/// Nodes side by side in one panel.
const LANES: usize = 8;

/// Sets of their own may look at one component for so many steps of the pass: measured, and of no
/// consequence but for the time.
const STEPS: usize = 8;

/// [`EigenvectorDistance::clusters_within`] for each of these sets of unstable modes.
///
/// Sets are taken one by one while cells settle most pairs at once, as in large networks with few
/// modes, and the rest in one pass once they have cost about half as much as the pass would. For
/// sets of few runs O(N² (modes + sets)) at most; memory O(N · (modes + sets)). Reports each set.
///
/// # Errors
/// Those of [`EigenvectorDistance::new`] and [`EigenvectorDistance::clusters_within`].
pub(crate) fn clusters_of_each(
    spectrum: &RealModes<'_>,
    sets: &[&[usize]],
    threshold: f64,
    progress: Progress<'_>,
) -> Result<Vec<Partition>, ClusteringError> {
    check_threshold(threshold)?;
    let n_nodes = spectrum.eigenvectors[0].len();
    let pass = (spectrum.eigenvalues.len() + sets.len()).saturating_mul(n_nodes * n_nodes / 2);
    let mut work = pass / STEPS;
    let mut found = Vec::new();
    for modes in sets {
        let distance = EigenvectorDistance::of(spectrum, modes)?;
        let Some(clusters) = distance.clusters_with_work(threshold, &mut work)? else { break };
        found.push(clusters);
        go_on(progress(1))?;
    }
    let rest = &sets[found.len()..];
    if !rest.is_empty() {
        found.extend(in_one_pass(spectrum, rest, threshold)?);
        go_on(progress(rest.len() as u64))?;
    }
    Ok(found)
}

/// The same without a look at the cost.
fn in_one_pass(
    spectrum: &RealModes<'_>,
    sets: &[&[usize]],
    threshold: f64,
) -> Result<Vec<Partition>, ClusteringError> {
    let chosen: Vec<Vec<usize>> =
        sets.iter().map(|modes| chosen_eigenspaces(spectrum, modes)).collect::<Result<_, _>>()?;
    let panels = Panels::new(spectrum, &chosen);
    let sets: Vec<Set> = chosen.iter().map(|spaces| panels.set(spaces, threshold)).collect();
    let mut families = DisjointSetFamilies::new(panels.n_nodes, sets.len());
    let mut sums = vec![[0.0; LANES]; panels.blocks.len() + 1];
    let n_panels = panels.n_nodes.div_ceil(LANES);
    // The first nodes with all others first: what becomes one set does so early.
    for (first, panel) in (0..n_panels).flat_map(|a| (a..n_panels).map(move |b| (a, b))) {
        for i in (first * LANES..panels.n_nodes).take(LANES) {
            panels.running_sums(i, panel, &mut sums);
            link(&panels, &sets, i, panel, &sums, &mut families);
        }
    }
    Ok((0..sets.len()).map(|set| Partition::from_roots(&families.roots(set))).collect())
}

/// One set of unstable modes.
struct Set {
    /// Runs of blocks.
    runs: Vec<Range<usize>>,
    n_modes: usize,
    threshold: f64,
    /// m · threshold, against which differences of running sums stand.
    limit: f64,
    /// How much these differences may be off, relative to the limit and the last running sum.
    rounding: f64,
}

impl Set {
    /// m δe of node i and those of the panel.
    #[inline]
    fn total(&self, sums: &[[f64; LANES]]) -> [f64; LANES] {
        // The commonest case, σ > σ_c, without a subtraction.
        if let [Range { start: 0, end }] = self.runs[..] {
            return sums[end];
        }
        let mut total = [0.0; LANES];
        for run in &self.runs {
            let (start, end) = (&sums[run.start], &sums[run.end]);
            for lane in 0..LANES {
                total[lane] += end[lane] - start[lane];
            }
        }
        total
    }
}

/// Joins node i, in every set, with the later nodes of the panel that are within the threshold.
fn link(
    panels: &Panels,
    sets: &[Set],
    i: usize,
    panel: usize,
    sums: &[[f64; LANES]],
    families: &mut DisjointSetFamilies,
) {
    let last = sums.last().expect("there is a sum of nothing");
    let largest = last.iter().copied().fold(0.0, f64::max);
    for (number, set) in sets.iter().enumerate() {
        let total = set.total(sums);
        let doubt = set.rounding * (largest + set.limit);
        let (sure, possible) = (set.limit - doubt, set.limit + doubt);
        let is_any_near = total.iter().fold(false, |any, &total| any | (total <= possible));
        if !is_any_near || families.is_one_set(number) {
            continue;
        }
        for lane in (0..LANES).filter(|&lane| total[lane] <= possible) {
            let j = panel * LANES + lane;
            if j <= i || j >= panels.n_nodes || families.are_joined(number, i, j) {
                continue;
            }
            if total[lane] < sure || panels.distance(set, i, j) <= set.threshold {
                families.join(number, i, j);
            }
        }
    }
}

/// The unstable eigenspaces of all sets, with the components of eight nodes side by side.
struct Panels<'a> {
    spectrum: &'a RealModes<'a>,
    n_nodes: usize,
    /// Numbers of the eigenspaces, ascending.
    spaces: Vec<usize>,
    /// Of factor c_d.
    blocks: Vec<Block>,
    width: usize,
    /// Shape (panels, width); not a number beyond the last node.
    values: Vec<[f64; LANES]>,
}

impl<'a> Panels<'a> {
    fn new(spectrum: &'a RealModes<'a>, chosen: &[Vec<usize>]) -> Self {
        let mut spaces = chosen.concat();
        spaces.sort_unstable();
        spaces.dedup();
        let modes: Vec<usize> =
            spaces.iter().flat_map(|&space| spectrum.eigenspaces[space].clone()).collect();
        let n_nodes = spectrum.eigenvectors[0].len();
        let component = |mode: usize, node: usize| {
            spectrum.eigenvectors[mode].get(node).copied().unwrap_or(f64::NAN)
        };
        let lanes = |panel, mode| std::array::from_fn(|lane| component(mode, panel * LANES + lane));
        let values = (0..n_nodes.div_ceil(LANES))
            .flat_map(|panel| modes.iter().map(move |&mode| lanes(panel, mode)))
            .collect();
        Self {
            spectrum,
            n_nodes,
            blocks: blocks(spectrum, &spaces),
            spaces,
            width: modes.len(),
            values,
        }
    }

    /// The set of modes that fills these eigenspaces, in ascending order.
    fn set(&self, spaces: &[usize], threshold: f64) -> Set {
        let place = |space| self.spaces.binary_search(space).expect("panels hold every eigenspace");
        let places: Vec<usize> = spaces.iter().map(place).collect();
        let runs: Vec<Range<usize>> =
            places.chunk_by(|a, b| a + 1 == *b).map(|run| run[0]..run[run.len() - 1] + 1).collect();
        let eigenspaces = &self.spectrum.eigenspaces;
        let n_modes = spaces.iter().map(|&space| transverse(&eigenspaces[space]).len()).sum();
        // Every sum rounds once a block and, against the distance's own, a few times more.
        let rounding = 4.0 * (runs.len() * (self.blocks.len() + 8)) as f64 * f64::EPSILON;
        Set { runs, n_modes, threshold, limit: threshold * n_modes as f64, rounding }
    }

    /// S_b of node i and those of the panel, length blocks + 1.
    fn running_sums(&self, i: usize, panel: usize, sums: &mut [[f64; LANES]]) {
        let own = &self.values[i / LANES * self.width..][..self.width];
        let others = &self.values[panel * self.width..][..self.width];
        let mut sum = [0.0; LANES];
        sums[0] = sum;
        for (block, after) in self.blocks.iter().zip(&mut sums[1..]) {
            let columns = block.columns.clone();
            let norm = norms(&own[columns.clone()], i % LANES, &others[columns]);
            for lane in 0..LANES {
                sum[lane] += block.factor * norm[lane];
            }
            *after = sum;
        }
    }

    /// δe_ij, digit by digit as [`EigenvectorDistance::between`] has it.
    fn distance(&self, set: &Set, i: usize, j: usize) -> f64 {
        let vectors = &self.spectrum.eigenvectors;
        let difference = |mode: usize| (vectors[mode][i] - vectors[mode][j]).abs();
        let mut sum = 0.0;
        for block in set.runs.iter().cloned().flatten() {
            let columns = self.spectrum.eigenspaces[self.spaces[block]].clone();
            let block = Block { columns, factor: self.blocks[block].factor / set.n_modes as f64 };
            sum += block.factor * block.norm(difference);
        }
        sum
    }
}

fn blocks(spectrum: &RealModes<'_>, spaces: &[usize]) -> Vec<Block> {
    let mut start = 0;
    spaces
        .iter()
        .map(|&space| {
            let space = &spectrum.eigenspaces[space];
            let columns = start..start + space.len();
            start = columns.end;
            Block { columns, factor: mean_over_bases(transverse(space).len()) }
        })
        .collect()
}

/// ‖P_b(e_i − e_j)‖ of the node in one lane of its panel and all nodes of another panel.
fn norms(own: &[[f64; LANES]], lane: usize, others: &[[f64; LANES]]) -> [f64; LANES] {
    if let ([own], [others]) = (own, others) {
        return others.map(|other| (own[lane] - other).abs());
    }
    let mut squares = [0.0; LANES];
    for (own, others) in own.iter().zip(others) {
        for (square, other) in squares.iter_mut().zip(others) {
            *square += (own[lane] - other) * (own[lane] - other);
        }
    }
    squares.map(f64::sqrt)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use spectra::{Eigenspace, Solver, Spectrum};

    use super::*;

    /// Eigenspaces of these dimensions over any components, in the first one of zero sum: the
    /// distance asks for no more.
    fn spectrum(n_nodes: usize, dimensions: &[usize], components: &[f64]) -> Spectrum {
        let n_modes: usize = dimensions.iter().sum();
        let mut eigenvectors = vec![vec![1.0 / (n_nodes as f64).sqrt(); n_nodes]];
        let mut components = components.iter().copied().cycle();
        eigenvectors.extend((1..n_modes).map(|_| components.by_ref().take(n_nodes).collect()));
        for zero_mode in &mut eigenvectors[1..dimensions[0]] {
            let mean = zero_mode.iter().sum::<f64>() / n_nodes as f64;
            zero_mode.iter_mut().for_each(|v| *v -= mean);
        }
        let mut end = 0;
        let eigenspaces = dimensions.iter().map(|d| {
            end += d;
            end - d..end
        });
        let eigenvalues: Vec<f64> = (0..n_modes).map(|k| -(k as f64)).collect();
        Spectrum {
            eigenspaces: Eigenspace::divided(
                &eigenvalues,
                eigenvectors,
                &vec![0.0; n_modes],
                &eigenspaces.collect::<Vec<_>>(),
                f64::NEG_INFINITY,
            ),
            tolerance: 1e-10,
            solver: Solver::Dense,
            cutoff: None,
            products: 0,
            verification: spectra::Verification::Dense,
        }
    }

    /// The modes of these eigenspaces.
    fn modes(spectrum: &Spectrum, is_unstable: &[bool]) -> Vec<usize> {
        let spaces = spectrum.real_modes().eigenspaces.into_iter().zip(is_unstable);
        let unstable = spaces.filter(|(_, unstable)| **unstable);
        unstable.flat_map(|(space, _)| transverse(&space)).collect()
    }

    fn one_by_one(spectrum: &Spectrum, sets: &[&[usize]], threshold: f64) -> Vec<Partition> {
        let distance = |modes: &&[usize]| EigenvectorDistance::new(spectrum, modes).unwrap();
        sets.iter().map(|m| distance(m).clusters_within(threshold).unwrap()).collect()
    }

    #[test]
    fn a_pair_exactly_at_the_threshold_is_linked() {
        // |v_i − v_j| = 1/4, 1/2, … in one mode after the other: δe = (1/4) (m + 1)/2.
        let components: Vec<f64> =
            (1..=3).flat_map(|k| [0.0, 0.25 * f64::from(k), 100.0]).collect();
        let spectrum = spectrum(3, &[1, 1, 1, 1], &components);
        let sets: [&[usize]; 3] = [&[1], &[1, 2], &[1, 2, 3]];
        for (threshold, expected) in
            [(0.2499, [3, 3, 3]), (0.25, [2, 3, 3]), (0.375, [2, 2, 3]), (0.5, [2, 2, 2])]
        {
            let found = in_one_pass(&spectrum.real_modes(), &sets, threshold).unwrap();
            assert_eq!(found.iter().map(Partition::n_clusters).collect::<Vec<_>>(), expected);
        }
    }

    #[test]
    fn no_unstable_mode_makes_one_cluster() {
        let spectrum = spectrum(20, &[1, 2], &[0.0, 1.0]);
        let found = in_one_pass(&spectrum.real_modes(), &[&[], &[1, 2]], 0.0).unwrap();
        assert_eq!((found[0].n_clusters(), found[1].n_clusters()), (1, 2));
    }

    proptest! {
        #[test]
        fn one_pass_is_one_set_after_the_other(
            n_nodes in 1usize..40,
            dimensions in prop::collection::vec(1usize..4, 1..8),
            components in prop::collection::vec(-0.5..0.5, 300),
            unstable in prop::collection::vec(prop::collection::vec(any::<bool>(), 8), 0..12),
            threshold in 0.0..0.6,
        ) {
            let spectrum = spectrum(n_nodes, &dimensions, &components);
            let sets: Vec<_> = unstable.iter().map(|u| modes(&spectrum, u)).collect();
            let sets: Vec<&[usize]> = sets.iter().map(|modes| &modes[..]).collect();
            let expected = one_by_one(&spectrum, &sets, threshold);
            prop_assert_eq!(&in_one_pass(&spectrum.real_modes(), &sets, threshold).unwrap(), &expected);
            prop_assert_eq!(&clusters_of_each(&spectrum.real_modes(), &sets, threshold, crate::QUIET).unwrap(), &expected);
        }

        // Components in tenths round in every sum, and distances often equal the threshold but
        // for that.
        #[test]
        fn one_pass_decides_ties_as_one_set_after_the_other_does(
            n_nodes in 1usize..30,
            dimensions in prop::collection::vec(1usize..3, 1..8),
            tenths in prop::collection::vec(-2i8..3, 200),
            unstable in prop::collection::vec(prop::collection::vec(any::<bool>(), 8), 0..12),
            threshold in 0u8..5,
        ) {
            let components: Vec<f64> = tenths.into_iter().map(|t| f64::from(t) / 10.0).collect();
            let spectrum = spectrum(n_nodes, &dimensions, &components);
            let sets: Vec<_> = unstable.iter().map(|u| modes(&spectrum, u)).collect();
            let sets: Vec<&[usize]> = sets.iter().map(|modes| &modes[..]).collect();
            let threshold = f64::from(threshold) / 10.0;
            let expected = one_by_one(&spectrum, &sets, threshold);
            prop_assert_eq!(in_one_pass(&spectrum.real_modes(), &sets, threshold).unwrap(), expected);
        }
    }
}
