//! Communities: nodes of communities a and b are linked with probability p_ab, independently.
//!
//! Source: P. W. Holland, K. B. Laskey & S. Leinhardt, Soc. Networks 5, 109 (1983), stochastic
//! block model; with two probabilities, A. Condon & R. M. Karp, Random Struct. Algorithms 18, 116
//! (2001), planted partition.

use super::blocks::Blocks;
use crate::{GeneratorError, Network};

/// With which probability two nodes are linked, by their communities.
#[derive(Clone, Debug, PartialEq)]
pub enum LinkProbability {
    /// One probability within communities and one between them.
    Uniform {
        /// Within a community, in [0, 1].
        within: f64,
        /// Between two communities, in [0, 1].
        between: f64,
    },
    /// p_ab for each pair of communities, shape (K, K), symmetric, in [0, 1].
    Matrix(Vec<Vec<f64>>),
}

/// A random network of communities with links of unit weight.
///
/// Nodes are numbered community by community and labelled "1", "2", …; the communities are the
/// groups "C1", "C2", …. The network may have isolated nodes and several components.
///
/// - `sizes`: number of nodes of each of the K communities, at least one.
/// - `seed`: the same seed gives the same network for ever. A matrix with two distinct values and
///   the uniform probabilities equal to them give different networks of the same distribution.
///
/// O(N + L) for L links with uniform probabilities, O(N + L + K²) with a matrix, but for the
/// assembly of the adjacency matrix.
///
/// # Errors
/// [`GeneratorError::NoCommunities`], [`GeneratorError::EmptyCommunity`],
/// [`GeneratorError::TooManyNodes`], [`GeneratorError::TooManyLinks`]; for the probabilities
/// [`GeneratorError::BadWithin`], [`GeneratorError::BadBetween`],
/// [`GeneratorError::WrongRowCount`], [`GeneratorError::WrongRowLength`],
/// [`GeneratorError::BadEntry`] and [`GeneratorError::NotSymmetric`].
pub fn communities(
    sizes: &[usize],
    probability: &LinkProbability,
    seed: u64,
) -> Result<Network, GeneratorError> {
    let mut blocks = Blocks::new(sizes.iter().copied(), seed)?;
    match probability {
        LinkProbability::Uniform { within, between } => {
            check_within(*within)?;
            if !is_probability(*between) {
                return Err(GeneratorError::BadBetween { value: *between });
            }
            for index in 0..sizes.len() {
                blocks.link_within(index, *within)?;
            }
            blocks.link_all_between(*between)?;
        }
        LinkProbability::Matrix(rows) => {
            check_matrix(rows, sizes.len())?;
            for (first, row) in rows.iter().enumerate() {
                blocks.link_within(first, row[first])?;
                for second in first + 1..sizes.len() {
                    blocks.link_between(first, second, row[second])?;
                }
            }
        }
    }
    Ok(blocks.into_network())
}

/// Mean number of links of such a network, in O(K) or, with a matrix, O(K²); what is no probability
/// counts as it stands.
pub fn expected_links(sizes: &[usize], probability: &LinkProbability) -> f64 {
    let n: Vec<f64> = sizes.iter().map(|&size| size as f64).collect();
    let within = |n: f64| 0.5 * n * (n - 1.0);
    match probability {
        LinkProbability::Uniform { within: p, between } => {
            let inside: f64 = n.iter().copied().map(within).sum();
            let all = within(n.iter().sum());
            p * inside + between * (all - inside)
        }
        LinkProbability::Matrix(rows) => {
            let entry = |a: usize, b: usize| rows.get(a).and_then(|row| row.get(b)).unwrap_or(&0.0);
            let row = |a: usize| {
                let between: f64 = (a + 1..n.len()).map(|b| entry(a, b) * n[a] * n[b]).sum();
                entry(a, a) * within(n[a]) + between
            };
            (0..n.len()).map(row).sum()
        }
    }
}

pub(super) fn check_within(value: f64) -> Result<(), GeneratorError> {
    if is_probability(value) { Ok(()) } else { Err(GeneratorError::BadWithin { value }) }
}

fn is_probability(value: f64) -> bool {
    (0.0..=1.0).contains(&value)
}

fn check_matrix(rows: &[Vec<f64>], n_communities: usize) -> Result<(), GeneratorError> {
    if rows.len() != n_communities {
        return Err(GeneratorError::WrongRowCount { n_rows: rows.len(), n_communities });
    }
    for (index, row) in rows.iter().enumerate() {
        let (row_number, length) = (index + 1, row.len());
        if length != n_communities {
            return Err(GeneratorError::WrongRowLength { row: row_number, length, n_communities });
        }
        if let Some(column) = row.iter().position(|&value| !is_probability(value)) {
            let value = row[column];
            return Err(GeneratorError::BadEntry { row: row_number, column: column + 1, value });
        }
        // Rows above this one have been checked, and are as long.
        if let Some(column) = (0..index).find(|&column| row[column] != rows[column][index]) {
            return Err(GeneratorError::NotSymmetric {
                row: row_number,
                column: column + 1,
                value: row[column],
                transposed: rows[column][index],
            });
        }
    }
    Ok(())
}
