//! Equations as text, made into programs over tiles of numbers.

mod expression;
mod mistake;
mod names;
mod order;
mod parser;
mod system;
mod token;

pub use expression::{Expression, Node, Part};
pub use mistake::{Fault, Mistake, Place};
pub use names::{Binary, Comparison, Unary};
pub use parser::{MAX_BYTES, MAX_DEPTH};
pub use system::{Description, Kind, MAX_COMPONENTS, MAX_NAMES, System, Warning};
