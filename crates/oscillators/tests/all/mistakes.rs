//! What is answered to equations that are none, and to names that nobody has.

use equations::Place;
use indexmap::IndexMap;
use oscillators::{Equations, EquationsError, ParameterError, find};

fn read(text: &str) -> Equations {
    toml::from_str(text).unwrap()
}

/// Equations of a flow of two components, with a box of initial states.
fn begun(start: &str) -> Result<dynamics::Text, EquationsError> {
    read(&format!("flow = {{ x = 'vel', vel = '-x' }}\nstart = {{ {start} }}")).dynamics()
}

#[test]
fn one_kind_of_equations_is_given() {
    let none = read("start = { x = [0, 1] }").dynamics().unwrap_err();
    assert_eq!(none, EquationsError::NoEquations);
    let both = read("flow = { x = 'x' }\nmap = { x = 'x' }\nstart = { x = [0, 1] }");
    assert_eq!(both.dynamics().unwrap_err(), EquationsError::FlowAndMap);
    assert!(both.system().unwrap_err().remedy().is_some());
}

#[test]
fn every_component_and_no_other_name_has_an_interval_to_begin_in() {
    let missing = EquationsError::NoStart { component: "vel".into() };
    assert_eq!(begun("x = [0, 1]").unwrap_err(), missing);
    let stranger = begun("x = [0, 1], velo = [0, 1]").unwrap_err();
    assert_eq!(stranger.remedy().as_deref(), Some("`vel`?"));
    assert_eq!(stranger.to_string(), "`start` names `velo`, but the components are x, vel");
    let time = begun("x = [0, 1], vel = [0, 1], t = [0, 1]").unwrap_err();
    assert!(time.remedy().unwrap().contains("time begins at 0"));
}

#[test]
fn an_interval_is_finite_and_in_order_and_may_be_a_point() {
    for wrong in ["[1, 0]", "[nan, 1]", "[0, nan]", "[-inf, 0]", "[inf, inf]", "[-1e308, 1e308]"] {
        let error = begun(&format!("x = [0, 1], vel = {wrong}")).unwrap_err();
        assert!(
            matches!(&error, EquationsError::BadStart { component, .. } if component == "vel"),
            "{wrong}: {error}"
        );
    }
    assert!(begun("x = [2, 2], vel = [-1e300, 1e300]").is_ok());
}

#[test]
fn a_mistake_in_a_formula_keeps_its_place() {
    let error = read("flow = { x = 'a*f' }\nwhere = { f = 'x + spede' }\nparameters = { a = 1, speed = 2 }\nstart = { x = [0, 1] }")
        .dynamics()
        .unwrap_err();
    assert_eq!(error.remedy().as_deref(), Some("`speed`?"));
    let EquationsError::Mistake(mistake) = error else { panic!("{error}") };
    assert_eq!(mistake.place, Place::Subexpression("f".into()));
    assert_eq!(mistake.at, Some(4..9));
}

#[test]
fn other_keys_are_refused_and_texts_come_back_as_they_were() {
    let unknown = "flow = { x = 'x' }\nstart = { x = [0, 1] }\nbegin = 1";
    assert!(toml::from_str::<Equations>(unknown).is_err());
    for entry in oscillators::library() {
        let text = toml::to_string(&entry.equations).unwrap();
        assert_eq!(toml::from_str::<Equations>(&text).unwrap(), entry.equations, "{text}");
    }
}

#[test]
fn equations_in_another_order_are_others() {
    let [one, other] = ["x = 'y', y = 'x'", "y = 'x', x = 'y'"]
        .map(|flow| read(&format!("flow = {{ {flow} }}\nstart = {{ x = [0, 1], y = [0, 1] }}")));
    assert_eq!(one, one.clone());
    assert_ne!(one, other);
}

#[test]
fn unknown_oscillators_and_parameters_are_answered_with_the_nearest() {
    let unknown = find("lorentz").unwrap_err();
    assert_eq!(unknown.nearest.as_deref(), Some("lorenz"));
    assert!(unknown.to_string().contains("chua, chua_cubic"), "{unknown}");
    let with = |oscillator: &str, name: &str, value| {
        let overrides = IndexMap::from([(name.to_owned(), value)]);
        find(oscillator).unwrap().with(&overrides).unwrap_err()
    };
    let error = with("lorenz", "alhpa", 1.0);
    let ParameterError::Unknown { nearest, .. } = &error else { panic!("{error}") };
    assert_eq!(nearest.as_deref(), Some("alpha"));
    assert_eq!(error.to_string(), "`lorenz` has no parameter `alhpa`; it has alpha, r, b");
    let error = with("henon_heiles", "a", 1.0);
    assert_eq!(error.to_string(), "`henon_heiles` has no parameter `a`; it has none");
    for (oscillator, parameter) in [("lorenz", "r"), ("chen", "a")] {
        let error = with(oscillator, parameter, f64::NAN);
        assert!(matches!(error, ParameterError::NotFinite { .. }), "{error}");
    }
}
