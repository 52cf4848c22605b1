//! The coupling function H: one component of the driving node enters one equation of the driven one.

use serde::Serialize;

/// H(x) with a single non-zero entry: component `from` of x enters the equation of component `to`.
///
/// It is linear, so DH has the same single entry, 1 in row `to`, column `from`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Coupling {
    /// Component that is read from the driving node (from 0).
    pub from: usize,
    /// Component whose equation it enters (from 0).
    pub to: usize,
}
