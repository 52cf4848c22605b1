//! The coupling function H(x) = B h(x): what a node sends, h, and how it enters the equations of the
//! node that it drives, B.

use serde::{Deserialize, Serialize};

/// A linear coupling function: h are C components of the driving node, its channels, and B a sparse
/// matrix of shape (D, C).
///
/// DH is B at the columns of the components that h reads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coupling {
    channels: Vec<usize>,
    gains: Vec<Gain>,
}

/// An entry of B.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gain {
    /// Component whose equation it enters (from 0).
    pub equation: usize,
    /// Channel that enters (from 0).
    pub channel: usize,
    /// Weight with which it does.
    pub weight: f64,
}

impl Coupling {
    /// One component of the driving node enters the equation of one of the driven node, with weight 1.
    pub fn pair(from: usize, to: usize) -> Self {
        let gain = Gain { equation: to, channel: 0, weight: 1.0 };
        Self { channels: vec![from], gains: vec![gain] }
    }

    /// H(x) = M x for a matrix M, row by row: `rows[d][c]` is the weight with which component c enters
    /// equation d. Channels are the components with a weight.
    pub fn matrix(rows: &[Vec<f64>]) -> Self {
        let n_components = rows.iter().map(Vec::len).max().unwrap_or(0);
        let weight = |d: usize, c: usize| rows[d].get(c).copied().unwrap_or(0.0);
        let is_read = |&c: &usize| (0..rows.len()).any(|d| weight(d, c) != 0.0);
        let channels: Vec<usize> = (0..n_components).filter(is_read).collect();
        let entries = (0..rows.len()).flat_map(|d| (0..channels.len()).map(move |k| (d, k)));
        let gain = |(equation, channel): (usize, usize)| Gain {
            equation,
            channel,
            weight: weight(equation, channels[channel]),
        };
        let gains = entries.map(gain).filter(|gain| gain.weight != 0.0).collect();
        Self { channels, gains }
    }

    /// The component that each channel reads.
    pub fn channels(&self) -> &[usize] {
        &self.channels
    }

    /// The entries of B, equation by equation.
    pub fn gains(&self) -> &[Gain] {
        &self.gains
    }

    /// The entries of DH: equation, component, weight.
    pub fn derivative(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        self.gains.iter().map(|gain| (gain.equation, self.channels[gain.channel], gain.weight))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_with_one_entry_is_a_pair() {
        let rows = vec![vec![0.0; 3], vec![1.0, 0.0, 0.0], vec![0.0; 3]];
        assert_eq!(Coupling::matrix(&rows), Coupling::pair(0, 1));
    }

    #[test]
    fn a_matrix_has_a_channel_for_each_component_that_it_reads() {
        let rotation = Coupling::matrix(&[vec![0.6, 0.0, 0.8], vec![0.0; 3], vec![-0.8, 0.0, 0.6]]);
        assert_eq!(rotation.channels(), [0, 2]);
        let entries: Vec<_> = rotation.derivative().collect();
        assert_eq!(entries, [(0, 0, 0.6), (0, 2, 0.8), (2, 0, -0.8), (2, 2, 0.6)]);
    }
}
