//! What lies between eigensync and whoever uses it: a [`Problem`] is what keeps a command from running,
//! [`text`] makes anything readable, [`files`] opens what may be read at all, and a [`Watch`] is told how
//! the work goes on. Nothing here says anything by itself.

pub mod files;
mod problem;
mod stages;
pub mod text;
mod watch;

pub use problem::{Problem, Result, nearest};
pub use stages::Stages;
pub use watch::{Bar, Progress, Stage, Watch};
