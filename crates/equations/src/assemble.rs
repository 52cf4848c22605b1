//! From a system to operations: each formula once, parts before what is made of them.

use crate::builder::{Builder, Value};
use crate::expression::{Expression, Node};
use crate::symbol::Symbol;
use crate::system::{Kind, System};

/// A system as operations.
pub(crate) struct Assembled {
    pub builder: Builder,
    /// Components, and time if it enters.
    pub inputs: usize,
    /// What comes of each formula, and of time if it enters.
    pub outputs: Vec<Value>,
}

/// Puts the formulas of a system in a row.
pub(crate) fn assemble(system: &System) -> Assembled {
    let n_components = system.components().count();
    let mut builder = Builder::default();
    let parameters: Vec<f64> = system.parameters().map(|(_, value)| value).collect();
    let mut known = vec![None; system.subexpressions.len()];
    let time = Value::Input(n_components);
    let value_of = |symbol: &Symbol, known: &[Option<Value>]| match symbol {
        Symbol::Component(c) => Value::Input(*c),
        Symbol::Parameter(p) => Value::Constant(parameters[*p]),
        Symbol::Time => time,
        Symbol::Pi => Value::Constant(std::f64::consts::PI),
        Symbol::Subexpression(s) => known[*s].expect("subexpressions are in order"),
    };
    for &s in &system.order {
        let formula = &system.subexpressions[s];
        known[s] = Some(formula_in(&mut builder, formula, |symbol| value_of(symbol, &known)));
    }
    let mut outputs: Vec<Value> = system
        .equations
        .iter()
        .map(|(_, formula)| formula_in(&mut builder, formula, |symbol| value_of(symbol, &known)))
        .collect();
    if system.has_time() {
        let one = Value::Constant(1.0);
        outputs.push(if system.kind() == Kind::Map { builder.add(time, one) } else { one });
    }
    Assembled { builder, inputs: n_components + usize::from(system.has_time()), outputs }
}

fn formula_in(
    builder: &mut Builder,
    formula: &Expression<Symbol>,
    value_of: impl Fn(&Symbol) -> Value,
) -> Value {
    let mut values: Vec<Value> = Vec::with_capacity(formula.parts.len());
    for part in &formula.parts {
        let value = match &part.node {
            Node::Number(value) => Value::Constant(*value),
            Node::Name(symbol) => value_of(symbol),
            Node::Negate(a) => builder.negate(values[*a]),
            Node::Unary(function, a) => builder.unary(*function, values[*a]),
            Node::Binary(operation, a, b) => builder.binary(*operation, values[*a], values[*b]),
            Node::Compare(comparison, a, b) => builder.compare(*comparison, values[*a], values[*b]),
            Node::And(a, b) => builder.and(values[*a], values[*b]),
            Node::Or(a, b) => builder.or(values[*a], values[*b]),
            Node::Not(a) => builder.not(values[*a]),
            Node::If(condition, a, b) => builder.select(values[*condition], values[*a], values[*b]),
        };
        values.push(value);
    }
    *values.last().expect("a formula has parts")
}
