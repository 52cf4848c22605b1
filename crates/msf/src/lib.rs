//! Master stability function Λ(σ), its stable set, and the critical couplings that follow from it.
//!
//! Λ(σ) is the largest Lyapunov exponent of `δẏ = [DF(s) − σ DH] δy`, ṡ = F(s). A mode of the network
//! with eigenvalue λ at coupling ε has σ = −ελ and is damped where Λ(σ) < 0. Nothing here knows a
//! graph.
//!
//! Source: L. M. Pecora & T. L. Carroll, PRL 80, 2109 (1998).

mod attractors;
mod critical;
mod curve;
mod error;
mod fit;
mod isolated;
mod origin;
mod reach;
mod refinement;
mod rest;
mod stable_region;
mod step;
mod zero;
mod zeros;

pub use attractors::Attractor;
pub use critical::{CriticalCoupling, critical_couplings};
pub use curve::{MasterStability, Node, Request, master_stability, master_stability_with};
pub use error::MsfError;
pub use isolated::Isolated;
pub use reach::reach;
pub use refinement::{Advance, Refinement};
pub use stable_region::{End, Interval, StableRegion};
pub use zero::Zero;
