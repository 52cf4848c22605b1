//! Tests of the predictions against closed forms, invariances and second routes.

mod agreement;
mod cascade;
mod correlation;
mod distance;
mod fixtures;
mod partition;
mod regions;
