//! A formula that was read: its parts in an order in which each comes after those it is made of.
//!
//! So whatever walks over a formula is a loop, and no formula is too deep for it.

use std::ops::Range;

use crate::names::{Binary, Comparison, Unary};

/// The place of a part among [`Expression::parts`].
pub(crate) type Index = usize;

/// A formula. Names are `N`: as text, and later what they mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression<N = String> {
    /// What it is made of; the last part is the whole.
    pub parts: Vec<Part<N>>,
}

/// A part of a formula with its place in the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Part<N = String> {
    /// What it is.
    pub node: Node<N>,
    /// Bytes of the text that say so.
    pub at: Range<usize>,
}

/// What a part is. Operands are indices of earlier parts.
#[derive(Clone, Debug, PartialEq)]
pub enum Node<N = String> {
    /// A number.
    Number(f64),
    /// A name.
    Name(N),
    /// −a.
    Negate(Index),
    /// A function of a number.
    Unary(Unary, Index),
    /// An operation on two numbers.
    Binary(Binary, Index, Index),
    /// A condition: a comparison of two numbers.
    Compare(Comparison, Index, Index),
    /// Both conditions.
    And(Index, Index),
    /// At least one of the conditions.
    Or(Index, Index),
    /// Not the condition.
    Not(Index),
    /// The first number where the condition holds, and the second elsewhere.
    If(Index, Index, Index),
}

impl<N> Node<N> {
    /// Whether it is true or false rather than a number.
    pub(crate) fn is_condition(&self) -> bool {
        matches!(self, Self::Compare(..) | Self::And(..) | Self::Or(..) | Self::Not(_))
    }
}

impl<N> Expression<N> {
    /// The same formula with other names, or the first error in finding them.
    pub(crate) fn try_map<M, E>(
        &self,
        mut name: impl FnMut(&N, &Range<usize>) -> Result<M, E>,
    ) -> Result<Expression<M>, E> {
        let part = |part: &Part<N>| {
            let node = match &part.node {
                Node::Number(value) => Node::Number(*value),
                Node::Name(found) => Node::Name(name(found, &part.at)?),
                Node::Negate(a) => Node::Negate(*a),
                Node::Unary(function, a) => Node::Unary(*function, *a),
                Node::Binary(operation, a, b) => Node::Binary(*operation, *a, *b),
                Node::Compare(comparison, a, b) => Node::Compare(*comparison, *a, *b),
                Node::And(a, b) => Node::And(*a, *b),
                Node::Or(a, b) => Node::Or(*a, *b),
                Node::Not(a) => Node::Not(*a),
                Node::If(condition, a, b) => Node::If(*condition, *a, *b),
            };
            Ok(Part { node, at: part.at.clone() })
        };
        Ok(Expression { parts: self.parts.iter().map(part).collect::<Result<_, _>>()? })
    }

    /// Names that it uses, as often as it does.
    pub(crate) fn names(&self) -> impl Iterator<Item = &N> {
        self.parts.iter().filter_map(|part| match &part.node {
            Node::Name(name) => Some(name),
            _ => None,
        })
    }
}
