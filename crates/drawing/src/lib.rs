//! What was found, as figures: which panels show it, in which colours, marks and numbers, as much as
//! there is room for. Plain data go to [`figures`], which draws them.
//!
//! `picture` chooses the figure and makes its files: `sweep` for the panels of the paper's Fig. 1,
//! `pairs` for matrices, `regions` for nodes in space, `atlas` for many curves on one page. `identity` gives one cluster one colour and one
//! number in all panels, `stretches` says over which ε a predicted one stays.

mod atlas;
mod cascade;
mod curve;
mod identity;
mod marks;
mod network;
mod order;
mod pairs;
mod picture;
mod regions;
mod room;
mod stretches;
mod sweep;

pub use atlas::atlas;
pub use curve::curve_alone;
pub use pairs::{distance, error_matrix};
pub use picture::{Picture, picture};
pub use room::foreseen;
