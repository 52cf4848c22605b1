//! What a name in a formula means, once that is known.

/// What a name means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symbol {
    Component(usize),
    Subexpression(usize),
    Parameter(usize),
    Time,
    Pi,
}
