//! The coupling function H(x) = B h(x): what a node sends, h, and how it enters the equations of the
//! node that it drives, B.

use std::sync::Arc;

use equations::{Kind, Program, System};

use crate::InstructionSet;
use crate::linearised::{Linearised, LinearisedMut};
use crate::programs;

/// A coupling function: C channels h that a node sends, and B, a sparse matrix of shape (D, C).
#[derive(Clone, Debug, PartialEq)]
pub struct Coupling {
    channels: Channels,
    gains: Vec<Gain>,
}

/// What a node sends.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Channels {
    /// Some of its components, which are read where they stand.
    Components(Vec<usize>),
    /// Functions of its components.
    Formulas(Arc<Program>),
}

/// An entry of B.
#[derive(Clone, Copy, Debug, PartialEq)]
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
        Self { channels: Channels::Components(vec![from]), gains: vec![gain] }
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
        Self { channels: Channels::Components(channels), gains }
    }

    /// H from formulas: the one of a component enters its equation, and components without one are not
    /// driven.
    ///
    /// # Panics
    /// When the system is a flow or a map.
    pub fn formulas(system: &System) -> Self {
        assert_eq!(system.kind(), Kind::Coupling, "a coupling function is no dynamics");
        let gain = |(channel, equation)| Gain { equation, channel, weight: 1.0 };
        let gains = system.with_equation().enumerate().map(gain).collect();
        Self { channels: Channels::Formulas(Arc::new(Program::new(system))), gains }
    }

    /// The entries of B, equation by equation.
    pub fn gains(&self) -> &[Gain] {
        &self.gains
    }

    /// How many signals a node sends.
    pub fn n_channels(&self) -> usize {
        match &self.channels {
            Channels::Components(components) => components.len(),
            Channels::Formulas(program) => program.n_outputs(),
        }
    }

    /// h(x) and Dh(x) δ of every number, channel by channel.
    pub fn send(&self, set: InstructionSet, at: Linearised<'_>, to: LinearisedMut<'_, '_>) {
        self.channels.send_tangents(set, at, to);
    }

    pub(crate) fn channels(&self) -> &Channels {
        &self.channels
    }

    /// The entries of DH, if they are the same at every state: equation, component, weight.
    pub(crate) fn constant_derivative(
        &self,
    ) -> Option<impl Iterator<Item = (usize, usize, f64)> + use<'_>> {
        let Channels::Components(channels) = &self.channels else { return None };
        let entry = |gain: &Gain| (gain.equation, channels[gain.channel], gain.weight);
        Some(self.gains.iter().map(entry))
    }
}

impl Channels {
    /// h(x) of every number: `x[c]` are as many numbers of component c, and `to[k]` of channel k.
    pub(crate) fn send(&self, set: InstructionSet, x: &[&[f64]], to: &mut [&mut [f64]]) {
        match self {
            Self::Components(components) => {
                for (&component, to) in components.iter().zip(to) {
                    to.copy_from_slice(x[component]);
                }
            }
            Self::Formulas(program) => {
                programs::evaluate(program, set, &x[..program.n_inputs()], to);
            }
        }
    }

    /// h(x) and Dh(x) δ of every number, in the same layout.
    pub(crate) fn send_tangents(
        &self,
        set: InstructionSet,
        at: Linearised<'_>,
        to: LinearisedMut<'_, '_>,
    ) {
        let Linearised { value, tangent } = at;
        match self {
            Self::Components(_) => {
                self.send(set, value, to.value);
                self.send(set, tangent, to.tangent);
            }
            Self::Formulas(program) => {
                let n = program.n_inputs();
                let at = Linearised { value: &value[..n], tangent: &tangent[..n] };
                programs::linearise(program, set, at, to);
            }
        }
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
        assert_eq!(*rotation.channels(), Channels::Components(vec![0, 2]));
        let entries: Vec<_> = rotation.constant_derivative().into_iter().flatten().collect();
        assert_eq!(entries, [(0, 0, 0.6), (0, 2, 0.8), (2, 0, -0.8), (2, 2, 0.6)]);
    }
}
