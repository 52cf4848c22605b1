//! Hierarchical networks: every node of a small weighted network becomes a community; nodes of
//! communities a and b are linked with probability factor · w_ab, w_ab the weight of the link.
//!
//! Source: Fan, Wang & Wang (2023), Sec. III B, the network of Fig. 3.

use super::blocks::Blocks;
use super::communities::check_within;
use crate::{GeneratorError, Network};

/// A random network of communities that are linked as the nodes of `backbone` are.
///
/// Links have unit weight. Node labels and groups are those of
/// [`communities`](super::communities()): community "C1" replaces the first node of the backbone.
///
/// - `size`: number of nodes n of every community, at least one.
/// - `within`: probability of a link within a community, in [0, 1].
/// - `factor`: probability of a link between communities per unit of weight, with factor · w_ab in
///   [0, 1] for every link of the backbone.
/// - `seed`: the same seed gives the same network for ever.
///
/// O(N + L), N the number of nodes and L that of the links of both networks, but for the assembly
/// of the adjacency matrix.
///
/// # Errors
/// [`GeneratorError::EmptyCommunity`], [`GeneratorError::TooManyNodes`],
/// [`GeneratorError::TooManyLinks`], [`GeneratorError::BadWithin`], [`GeneratorError::BadFactor`]
/// (negative or not finite) and [`GeneratorError::AboveOne`].
pub fn hierarchical(
    backbone: &Network,
    size: usize,
    within: f64,
    factor: f64,
    seed: u64,
) -> Result<Network, GeneratorError> {
    let mut blocks = Blocks::new(std::iter::repeat_n(size, backbone.n_nodes()), seed)?;
    check_within(within)?;
    check_factor(backbone, factor)?;
    for (first, row) in backbone.adjacency().outer_iterator().enumerate() {
        blocks.link_within(first, within)?;
        for (second, &weight) in row.iter().filter(|&(second, _)| second > first) {
            blocks.link_between(first, second, factor * weight)?;
        }
    }
    Ok(blocks.into_network())
}

/// Mean number of links of such a network; what is no probability counts as it stands.
pub fn expected_hierarchical_links(
    backbone: &Network,
    size: usize,
    within: f64,
    factor: f64,
) -> f64 {
    let n = size as f64;
    let weights: f64 = backbone.strengths().iter().sum();
    within * 0.5 * n * (n - 1.0) * backbone.n_nodes() as f64 + 0.5 * factor * weights * n * n
}

fn check_factor(backbone: &Network, factor: f64) -> Result<(), GeneratorError> {
    if !(factor.is_finite() && factor >= 0.0) {
        return Err(GeneratorError::BadFactor { factor });
    }
    for (&weight, (i, j)) in backbone.adjacency() {
        let probability = factor * weight;
        if probability > 1.0 {
            let label = |node: u32| backbone.labels()[node as usize].clone();
            let (from, to) = (label(i), label(j));
            return Err(GeneratorError::AboveOne { from, to, weight, factor, probability });
        }
    }
    Ok(())
}
