//! Every parameter that a run used, in the words of experiment files: what the file says, the defaults
//! for what it leaves out, and what `--quick` made of the times.

use dynamics::lyapunov::takes_series;
use dynamics::{Adaptive, AdaptiveOrder, Method};
use serde_json::{Value, json};

use eigensync::Study;

use crate::spec::{Experiment, MethodKind, NetworkSpec, SweepSpec};

/// The resolved experiment; keys that have no effect in it are null.
pub fn of(experiment: &Experiment, study: &Study) -> Value {
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
    let msf::Node { dynamics, coupling } = &study.node;
    let has_series = takes_series(dynamics.as_ref(), coupling, &study.msf.times);
    let by = match has_series {
        _ if dynamics.is_map() => "iterate",
        true => "taylor",
        false => "rk4",
    };
    set("/msf/method", json!(by));
    if !has_series {
        set("/msf/tolerance", Value::Null);
    }
    set("/msf/step", json!(study.msf.times.step));
    set("/msf/renormalise", json!(study.msf.times.renormalise));
    set("/msf/transient", json!(study.msf.times.transient));
    set("/msf/average", json!(study.msf.times.average));
    set("/msf/relative_error", json!(study.msf.refinement.relative_error));
    set("/msf/refinement_rounds", json!(study.msf.refinement.max_rounds));
    if let Some(sweep) = &study.sweep {
        set("/sweep/transient", json!(sweep.schedule.transient));
        set("/sweep/average", json!(sweep.schedule.average));
        let components = study.node.dynamics.components();
        set("/sweep/component", json!(components[sweep.observables.component]));
        set("/sweep/method", json!(method(sweep.method)));
        set("/sweep/step", json!(sweep.schedule.step));
        set("/sweep/stride", json!(sweep.schedule.stride));
        set("/sweep/pairs", json!(sweep.observables.pairs));
        let spec = experiment.sweep.as_ref();
        let has_tolerance = matches!(sweep.method, Method::Adaptive(_))
            || (sweep.method != Method::Iterate && spec.is_some_and(SweepSpec::is_auto));
        let tolerance = spec.filter(|_| has_tolerance).map(SweepSpec::tolerance);
        set("/sweep/tolerance", json!(tolerance));
    }
    parameters
}

/// The integrator by the name that experiment files call it, `auto` by what it has chosen.
pub fn method(method: Method) -> MethodKind {
    match method {
        Method::Rk4 => MethodKind::Rk4,
        Method::Dop853 => MethodKind::Rk8,
        Method::Iterate => MethodKind::Iterate,
        Method::Adaptive(Adaptive { order: AdaptiveOrder::Five, .. }) => MethodKind::Dopri5,
        Method::Adaptive(Adaptive { order: AdaptiveOrder::Eight, .. }) => MethodKind::Dop853,
    }
}
