//! Oscillators as text: somebody's own, as they stand in an experiment file, and a [`library()`] of known
//! ones, a file each, with source and published values.
//!
//! ```
//! use dynamics::NodeDynamics;
//! use indexmap::IndexMap;
//!
//! let rossler = oscillators::find("rossler")?;
//! assert_eq!(rossler.equations.to_string().lines().next(), Some("dx/dt = -(y + z)"));
//! let dynamics = rossler.with(&IndexMap::from([("c".into(), 5.7)]))?;
//! assert_eq!(dynamics.components(), ["x", "y", "z"]);
//!
//! let unknown = oscillators::find("roessler").unwrap_err();
//! assert_eq!(unknown.nearest.as_deref(), Some("rossler"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod entry;
mod equations;
mod error;
mod library;

pub use self::entry::{Behaviour, Entry, Kind, Published};
pub use self::equations::Equations;
pub use self::error::{EquationsError, NoSuchOscillator, ParameterError};
pub use self::library::{find, library};
