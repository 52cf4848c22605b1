//! Tests of the predictions against closed forms, invariances and second routes.

mod agreement;
mod cascade;
mod cascade_tree;
mod correlation;
mod distance;
mod equitability;
mod fixtures;
mod labels;
mod large;
#[path = "../../benches/clusters/fixtures.rs"]
mod large_fixtures;
mod partition;
mod planted;
mod refinement;
mod regions;
mod robustness;
mod stable_set;
