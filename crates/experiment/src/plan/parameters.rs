//! Every parameter that a run used, in the words of experiment files: what the file says, the defaults
//! for what it leaves out, and what `--quick` made of the times.

use dynamics::NodeDynamics;
use serde_json::{Value, json};

use eigensync::Study;

use super::Node;
use crate::spec::{Experiment, NetworkSpec};

/// The resolved experiment; keys that have no effect in it are null.
pub fn of(experiment: &Experiment, study: &Study, node: &Node) -> Value {
    let mut parameters = serde_json::to_value(experiment).unwrap_or_default();
    let mut set = |pointer: &str, value: Value| {
        if let Some((table, key)) = pointer.rsplit_once('/')
            && let Some(table) = parameters.pointer_mut(table)
        {
            table[key] = value;
        }
    };
    if let NetworkSpec::File(spec) = &experiment.network {
        set("/network/file/format", json!(spec.format()));
    }
    set("/spectrum/modes", json!(study.modes.wanted()));
    set("/spectrum/tolerance", json!(study.modes.tolerance()));
    set("/msf/transient", json!(study.msf.times.transient));
    set("/msf/average", json!(study.msf.times.average));
    set("/msf/relative_error", json!(study.msf.refinement.relative_error));
    set("/msf/refinement_rounds", json!(study.msf.refinement.max_rounds));
    if let Some(sweep) = &study.sweep {
        set("/sweep/transient", json!(sweep.schedule.transient));
        set("/sweep/average", json!(sweep.schedule.average));
        set("/sweep/component", json!(node.model.components()[sweep.observables.component]));
        set("/sweep/pairs", json!(sweep.observables.pairs));
        if sweep.method == dynamics::Method::Rk4 {
            set("/sweep/tolerance", Value::Null);
        }
    }
    parameters
}
