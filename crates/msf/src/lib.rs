//! Master stability function Λ(σ), its stable set, and the transitions that follow from it: at which ε which
//! modes change their stability, and which are unstable in between.
//!
//! Λ(σ) is the largest Lyapunov exponent of `δẏ = [DF(s) − σ DH] δy`, ṡ = F(s). A mode of the network
//! with eigenvalue λ at coupling ε has σ = −ελ and is damped where Λ(σ) < 0. Nothing here knows a
//! graph.
//!
//! Source: L. M. Pecora & T. L. Carroll, PRL 80, 2109 (1998).

mod attractors;
mod class;
mod curve;
mod error;
mod exact;
mod fit;
mod held_against;
mod isolated;
mod look;
mod origin;
mod range;
mod reach;
mod refinement;
mod region;
mod request;
mod rest;
mod seeds;
mod stable_region;
mod step;
mod stretches;
mod transitions;
mod work;
mod zero;
mod zeros;

pub use attractors::Attractor;
pub use class::Class;
pub use curve::{Looked, MasterStability};
pub use error::MsfError;
pub use isolated::Isolated;
pub use reach::reach;
pub use refinement::{Advance, Refinement};
pub use request::{Node, Request};
pub use seeds::ISOLATED_ORBITS;
pub use stable_region::{End, Interval, StableRegion};
pub use stretches::{Decided, KnownModes, Others, Stability, Stretch};
pub use transitions::{Eigenspace, Transition, coupling_at, transition_at};
pub use work::{master_stability, master_stability_with};
pub use zero::Zero;
