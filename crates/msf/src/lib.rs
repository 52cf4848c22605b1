//! Master stability function Λ(σ), its stable set and the critical couplings.

mod stable_region;

pub use stable_region::{Interval, StableRegion};
