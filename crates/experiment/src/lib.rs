//! Experiment files, and the plans that they make.
//!
//! [`spec`] is what a file says, [`load`] reads it with errors that name line, column and key, and
//! [`plan`](fn@plan) makes of it what will be done, so that nothing can go wrong later for a reason that could
//! have been seen now. Nothing here computes more than a look at what it will cost.

mod hashes;
pub mod load;
mod machine;
mod plan;
mod shapes;
pub mod spec;

pub use hashes::plan_hash;
pub use plan::{
    AtlasPlan, Memory, Node, Pair, Plan, Planned, QUICK, Recorded, System, Text, method, node_of,
    plan, plan_hash_of, plan_of,
};

use std::path::Path;

/// Whether a text is an experiment file, or what is wrong with it in the words that a user sees.
/// Nothing that it names is looked for.
///
/// # Errors
/// What is wrong with it.
pub fn check_syntax(text: &str) -> Result<(), String> {
    let parsed = load::parse::<spec::Experiment>(text, Path::new("experiment.toml"));
    parsed.map(drop).map_err(|problem| problem.to_string())
}
