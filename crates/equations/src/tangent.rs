//! Exact derivatives: every operation once more on tangents, δ(a b) = a δb + b δa and so on.
//!
//! Tangents that are zero whatever the numbers are left out rather than computed. What has pieces has
//! the derivative of the piece that is taken: `if`, `min`, `max` and `abs`, that of x where x = 0;
//! `sign` and `floor` have none, and neither have conditions.

use crate::assemble::Assembled;
use crate::builder::{Builder, Value};
use crate::names::{Comparison, Unary};
use crate::scalar::Code;

/// An entry of the Jacobian that is not 0 everywhere.
pub(crate) struct Entry {
    pub output: usize,
    pub input: usize,
    pub slope: Value,
}

/// The tangents of outputs, in terms of tangents of inputs, which are inputs behind the others.
pub(crate) fn tangents(assembled: &mut Assembled) -> Vec<Value> {
    let n_inputs = assembled.inputs;
    let tangents = along(assembled, |input| Some(Value::Input(n_inputs + input)));
    tangents.into_iter().map(|tangent| tangent.unwrap_or(Value::Constant(0.0))).collect()
}

/// The entries of the Jacobian that are not 0 everywhere, output by output: tangents along the axes.
pub(crate) fn jacobian(assembled: &mut Assembled) -> Vec<Entry> {
    let mut entries = Vec::new();
    for input in 0..assembled.inputs {
        let axis = |other: usize| (other == input).then_some(Value::Constant(1.0));
        let column = along(assembled, axis).into_iter().enumerate();
        entries.extend(column.filter_map(|(output, slope)| match slope? {
            Value::Constant(0.0) => None,
            slope => Some(Entry { output, input, slope }),
        }));
    }
    entries.sort_by_key(|entry| (entry.output, entry.input));
    entries
}

/// The tangents of outputs along a direction of inputs; none where they are 0 whatever the numbers are.
fn along(
    assembled: &mut Assembled,
    direction: impl Fn(usize) -> Option<Value>,
) -> Vec<Option<Value>> {
    let Assembled { builder, outputs, .. } = assembled;
    // Those behind are derivatives themselves.
    let step = |output: &Value| if let Value::Step(step) = output { Some(*step) } else { None };
    let n_steps = outputs.iter().filter_map(step).max().map_or(0, |last| last + 1);
    let mut known: Vec<Option<Value>> = Vec::with_capacity(n_steps);
    let tangent_of = |value: Value, known: &[Option<Value>]| match value {
        Value::Constant(_) => None,
        Value::Input(input) => direction(input),
        Value::Step(step) => known[step],
    };
    for index in 0..n_steps {
        let step = builder.steps[index];
        let operand = |k: usize| *step.operands().get(k).unwrap_or(&Value::Constant(0.0));
        let operands = [0, 1, 2].map(operand);
        let tangents = operands.map(|operand| tangent_of(operand, &known));
        let tangent = if tangents == [None; 3] {
            None
        } else {
            tangent(builder, step.code, operands, tangents, Value::Step(index))
        };
        known.push(tangent);
    }
    outputs.iter().map(|output| tangent_of(*output, &known)).collect()
}

/// The tangent of an operation on numbers with tangents, of which at least one is not zero.
fn tangent(
    builder: &mut Builder,
    code: Code,
    [a, b, _]: [Value; 3],
    [da, db, dc]: [Option<Value>; 3],
    result: Value,
) -> Option<Value> {
    const ZERO: Value = Value::Constant(0.0);
    match code {
        Code::Add => sum(builder, da, db),
        Code::Subtract => difference(builder, da, db),
        Code::Multiply => {
            let (left, right) = (scaled(builder, db, a), scaled(builder, da, b));
            sum(builder, left, right)
        }
        Code::Divide => {
            let right = scaled(builder, db, result);
            let numerator = difference(builder, da, right)?;
            Some(builder.divide(numerator, b))
        }
        Code::Negate => Some(builder.negate(da?)),
        Code::Unary(function) => unary(builder, function, a, da?, result),
        Code::Power => {
            let of_base = da.map(|da| {
                let less = builder.subtract(b, Value::Constant(1.0));
                let power = builder.power(a, less);
                let slope = builder.multiply(b, power);
                builder.multiply(da, slope)
            });
            let of_exponent = db.map(|db| {
                let log = builder.unary(Unary::Log, a);
                let slope = builder.multiply(result, log);
                builder.multiply(db, slope)
            });
            sum(builder, of_base, of_exponent)
        }
        Code::Min | Code::Max => {
            let by = if code == Code::Min { Comparison::Less } else { Comparison::Greater };
            let condition = builder.compare(by, a, b);
            Some(builder.select(condition, da.unwrap_or(ZERO), db.unwrap_or(ZERO)))
        }
        Code::Atan2 => {
            let (left, right) = (scaled(builder, da, b), scaled(builder, db, a));
            let numerator = difference(builder, left, right)?;
            let (a_2, b_2) = (builder.multiply(a, a), builder.multiply(b, b));
            let square = builder.add(a_2, b_2);
            Some(builder.divide(numerator, square))
        }
        Code::Select => Some(builder.select(a, db.unwrap_or(ZERO), dc.unwrap_or(ZERO))),
        Code::Compare(_) | Code::And | Code::Or | Code::Not => None,
    }
}

/// f'(x) δx.
fn unary(
    builder: &mut Builder,
    function: Unary,
    x: Value,
    dx: Value,
    result: Value,
) -> Option<Value> {
    const ONE: Value = Value::Constant(1.0);
    const ZERO: Value = Value::Constant(0.0);
    let square = |builder: &mut Builder, of: Value| builder.multiply(of, of);
    Some(match function {
        Unary::Abs => {
            let negative = builder.compare(Comparison::Less, x, ZERO);
            let opposite = builder.negate(dx);
            builder.select(negative, opposite, dx)
        }
        Unary::Sign | Unary::Floor => return None,
        Unary::Sqrt => {
            let twice = builder.add(result, result);
            builder.divide(dx, twice)
        }
        Unary::Exp => builder.multiply(dx, result),
        Unary::Log => builder.divide(dx, x),
        Unary::Sin => {
            let cos = builder.unary(Unary::Cos, x);
            builder.multiply(dx, cos)
        }
        Unary::Cos => {
            let sin = builder.unary(Unary::Sin, x);
            let product = builder.multiply(dx, sin);
            builder.negate(product)
        }
        Unary::Tan => {
            let square = square(builder, result);
            let slope = builder.add(square, ONE);
            builder.multiply(dx, slope)
        }
        Unary::Asin | Unary::Acos => {
            let (below, above) = (builder.subtract(ONE, x), builder.add(x, ONE));
            let product = builder.multiply(below, above);
            let root = builder.unary(Unary::Sqrt, product);
            let slope = builder.divide(dx, root);
            if function == Unary::Asin { slope } else { builder.negate(slope) }
        }
        Unary::Atan => {
            let square = square(builder, x);
            let denominator = builder.add(square, ONE);
            builder.divide(dx, denominator)
        }
        Unary::Sinh => {
            let cosh = builder.unary(Unary::Cosh, x);
            builder.multiply(dx, cosh)
        }
        Unary::Cosh => {
            let sinh = builder.unary(Unary::Sinh, x);
            builder.multiply(dx, sinh)
        }
        Unary::Tanh => {
            let square = square(builder, result);
            let slope = builder.subtract(ONE, square);
            builder.multiply(dx, slope)
        }
    })
}

fn sum(builder: &mut Builder, a: Option<Value>, b: Option<Value>) -> Option<Value> {
    match (a, b) {
        (Some(a), Some(b)) => Some(builder.add(a, b)),
        (one, other) => one.or(other),
    }
}

fn difference(builder: &mut Builder, a: Option<Value>, b: Option<Value>) -> Option<Value> {
    match (a, b) {
        // As for a dual number of tangent zero: a zero keeps the sign it would have there.
        (a, Some(b)) => Some(builder.subtract(a.unwrap_or(Value::Constant(0.0)), b)),
        (a, None) => a,
    }
}

fn scaled(builder: &mut Builder, tangent: Option<Value>, by: Value) -> Option<Value> {
    tangent.map(|tangent| builder.multiply(tangent, by))
}
