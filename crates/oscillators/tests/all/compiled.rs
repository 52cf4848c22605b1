//! Oscillators in Rust and their text.

use dynamics::lyapunov::{Integrator, Times, spectrum};
use dynamics::{Model, NodeDynamics};
use equations::Program;
use indexmap::IndexMap;
use oscillators::{find, library};

use crate::{dynamics, flow, states, tangent};

const SHORT: Times = Times {
    integrator: Integrator::Rk4,
    step: 0.01,
    transient: 5.0,
    average: 50.0,
    renormalise: 0.5,
};

#[test]
fn every_compiled_oscillator_has_a_text_with_its_bits() {
    for model in Model::all() {
        let text = find(model.name()).unwrap().equations.dynamics().unwrap();
        assert_eq!((text.components(), text.start()), (model.components(), model.start()));
        assert_eq!(spectrum(&text, &SHORT, 1).unwrap(), spectrum(&model, &SHORT, 1).unwrap());
        for state in states(&model, 100) {
            assert_eq!(flow(&text, &state), flow(&model, &state));
            for direction in 0..state.len() {
                let [text, model] = [&text as &dyn NodeDynamics, &model]
                    .map(|dynamics| tangent(dynamics, &state, direction));
                assert_eq!(text, model);
            }
        }
    }
}

#[test]
fn a_traced_flow_and_its_text_are_one_program() {
    for model in Model::all() {
        let system = find(model.name()).unwrap().equations.system().unwrap();
        assert_eq!(model.program(), Program::new(&system), "{}", model.name());
    }
}

#[test]
fn a_compiled_oscillator_and_its_text_have_the_same_parameters() {
    for model in Model::all() {
        let entry = find(model.name()).unwrap();
        let written = toml::Table::try_from(model).unwrap();
        let compiled: Vec<(String, f64)> = written[model.name()]
            .as_table()
            .unwrap()
            .iter()
            .map(|(name, value)| (name.clone(), value.as_float().unwrap()))
            .collect();
        let text: Vec<(String, f64)> = entry.equations.parameters.clone().into_iter().collect();
        assert_eq!(compiled, text);
    }
}

#[test]
fn an_oscillator_is_compiled_where_it_can_be_and_its_parameters_arrive() {
    let compiled = library().iter().filter(|entry| entry.compiled().is_some());
    assert_eq!(compiled.count(), Model::all().len());
    for entry in library() {
        assert_eq!(dynamics(entry).fused().is_some(), entry.compiled().is_some());
    }
    for (name, parameter) in [("lorenz", "r"), ("rossler", "c"), ("chen", "c"), ("henon", "a")] {
        let entry = find(name).unwrap();
        let overrides = IndexMap::from([(parameter.to_owned(), 1.25)]);
        let (with, text) = (entry.with(&overrides).unwrap(), entry.equations_with(&overrides));
        let text = text.unwrap().dynamics().unwrap();
        for state in states(&*with, 10) {
            assert_eq!(flow(&*with, &state), flow(&text, &state));
            assert_ne!(flow(&*with, &state), flow(&*dynamics(entry), &state));
        }
    }
}
