//! Derivatives of programs against dual numbers that walk over the formula, and against differences.

use equations::{
    Binary, Comparison, Description, Expression, Kind, Node, Program, Registers, System, Unary,
};

/// Formulas of x, y, z with every function and every kind of piece.
const FORMULAS: [&str; 46] = [
    "x + y - z",
    "x*y*z",
    "x/y",
    "3/x",
    "x/3",
    "-x*y",
    "2 - x",
    "x^2 + y^3 + z^4",
    "x^7*y^-3",
    "x^16 + x^17/1e6",
    "(x*y)^2.5",
    "x^y",
    "2^x",
    "y^(x - z)",
    "x^-1.5",
    "abs(x - y)",
    "abs(y - x)",
    "sign(x - 1)*y",
    "floor(3*x)*y",
    "min(x, y*z)",
    "max(x, y*z)",
    "min(x, 1)",
    "max(1, y)",
    "sqrt(x + y)",
    "exp(x*y - z)",
    "log(x*z)",
    "sin(x*y)",
    "cos(x*y)",
    "sin(x)*cos(x)",
    "tan(x/2)",
    "asin(x/10)",
    "acos(y/10)",
    "atan(x*y)",
    "atan2(x, y)",
    "atan2(x, 2)",
    "atan2(-1, z)",
    "sinh(x - y)",
    "cosh(x - y)",
    "tanh(x - y)",
    "if(x < y, x^2, y*z)",
    "if(x > y and z > 1, sin(x), 3)",
    "if(not (x >= y or z != 2), 1, x*y)",
    "if(x <= 1, sqrt(abs(x)), if(x == y, 0, exp(z)))",
    "exp(sin(x*y) + tanh(z)/x)",
    "x*pi + t*y",
    "exp(-(x - y)^2/(2*z^2))",
];

/// A number and its derivative.
type Dual = [f64; 2];

fn unary(function: Unary, [x, dx]: Dual) -> Dual {
    let (value, slope) = match function {
        Unary::Abs => (x.abs(), x.signum()),
        Unary::Sign => (x.signum(), 0.0),
        Unary::Floor => (x.floor(), 0.0),
        Unary::Sqrt => (x.sqrt(), 0.5 / x.sqrt()),
        Unary::Exp => (x.exp(), x.exp()),
        Unary::Log => (x.ln(), x.recip()),
        Unary::Sin => (x.sin(), x.cos()),
        Unary::Cos => (x.cos(), -x.sin()),
        Unary::Tan => (x.tan(), x.cos().powi(-2)),
        Unary::Asin => (x.asin(), (1.0 - x * x).sqrt().recip()),
        Unary::Acos => (x.acos(), -(1.0 - x * x).sqrt().recip()),
        Unary::Atan => (x.atan(), (1.0 + x * x).recip()),
        Unary::Sinh => (x.sinh(), x.cosh()),
        Unary::Cosh => (x.cosh(), x.sinh()),
        Unary::Tanh => (x.tanh(), x.cosh().powi(-2)),
    };
    [value, slope * dx]
}

fn binary(operation: Binary, [a, da]: Dual, [b, db]: Dual) -> Dual {
    match operation {
        Binary::Add => [a + b, da + db],
        Binary::Subtract => [a - b, da - db],
        Binary::Multiply => [a * b, da * b + a * db],
        Binary::Divide => [a / b, da / b - a * db / (b * b)],
        Binary::Power if db == 0.0 => [a.powf(b), b * a.powf(b - 1.0) * da],
        Binary::Power => [a.powf(b), a.powf(b) * (db * a.ln() + b * da / a)],
        Binary::Min => {
            if a < b {
                [a, da]
            } else {
                [b, db]
            }
        }
        Binary::Max => {
            if a > b {
                [a, da]
            } else {
                [b, db]
            }
        }
        Binary::Atan2 => [a.atan2(b), (da * b - a * db) / (a * a + b * b)],
    }
}

fn compare(comparison: Comparison, a: f64, b: f64) -> bool {
    match comparison {
        Comparison::Less => a < b,
        Comparison::LessOrEqual => a <= b,
        Comparison::Greater => a > b,
        Comparison::GreaterOrEqual => a >= b,
        Comparison::Equal => a == b,
        Comparison::NotEqual => a != b,
    }
}

/// A condition: it is 1 or 0, and does not move.
fn condition(holds: bool) -> Dual {
    [f64::from(u8::from(holds)), 0.0]
}

/// Walks over a formula. `values` are x, y, z, t.
fn walk(formula: &Expression, at: usize, values: [Dual; 4]) -> Dual {
    let of = |part: &usize| walk(formula, *part, values);
    match &formula.parts[at].node {
        Node::Number(value) => [*value, 0.0],
        Node::Name(name) => match name.as_str() {
            "x" => values[0],
            "y" => values[1],
            "z" => values[2],
            "t" => values[3],
            "pi" => [std::f64::consts::PI, 0.0],
            other => panic!("{other} is no name of the formulas"),
        },
        Node::Negate(a) => of(a).map(|x| -x),
        Node::Unary(function, a) => unary(*function, of(a)),
        Node::Binary(operation, a, b) => binary(*operation, of(a), of(b)),
        Node::Compare(by, a, b) => condition(compare(*by, of(a)[0], of(b)[0])),
        Node::And(a, b) => condition(of(a)[0] == 1.0 && of(b)[0] == 1.0),
        Node::Or(a, b) => condition(of(a)[0] == 1.0 || of(b)[0] == 1.0),
        Node::Not(a) => condition(of(a)[0] == 0.0),
        Node::If(condition, a, b) => {
            if of(condition)[0] == 1.0 {
                of(a)
            } else {
                of(b)
            }
        }
    }
}

fn program(formula: &'static str) -> Program {
    let description = Description {
        kind: Kind::Flow,
        components: vec!["x", "y", "z"],
        equations: vec![("x", formula), ("y", "0*t"), ("z", "0")],
        ..Description::default()
    };
    Program::new(&System::read(&description).expect(formula))
}

/// The formula and its derivative at one state along one direction.
fn linearise(program: &Program, x: [f64; 4], delta: [f64; 4]) -> Dual {
    let mut to = [[[0.0]; 4]; 2];
    let (at, along) = (x.map(|x| [x]), delta.map(|x| [x]));
    let [at, along] = [&at, &along].map(|state| state.each_ref().map(<[f64; 1]>::as_slice));
    let [values, slopes] = &mut to;
    let [mut values, mut slopes] =
        [values, slopes].map(|to| to.each_mut().map(<[f64; 1]>::as_mut_slice));
    program.linearise(&mut Registers::new(), [&at, &along], [&mut values, &mut slopes]);
    [values[0][0], slopes[0][0]]
}

/// States in all orders of x, y, z, and directions along axes and across.
fn cases() -> Vec<([f64; 4], [f64; 4])> {
    let states =
        [[0.7, 1.9, 1.3, 0.4], [2.3, 0.6, 0.8, -1.0], [1.1, 1.7, 2.6, 3.0], [3.1, 2.2, 0.3, 0.0]];
    let directions = [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [0.6, -1.3, 0.9, 0.2],
    ];
    states.iter().flat_map(|state| directions.map(|direction| (*state, direction))).collect()
}

#[test]
fn derivatives_are_those_of_dual_numbers() {
    for text in FORMULAS {
        let (program, formula) = (program(text), Expression::read(text).expect(text));
        for (x, delta) in cases() {
            let values = std::array::from_fn(|k| [x[k], delta[k]]);
            let right = walk(&formula, formula.parts.len() - 1, values);
            let found = linearise(&program, x, delta);
            for k in 0..2 {
                let error = (found[k] - right[k]).abs();
                assert!(
                    error <= 2e-14 * (1.0 + right[k].abs()),
                    "{text} at {x:?} along {delta:?}: {found:?}, not {right:?}"
                );
            }
        }
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    let h = 1e-5;
    for text in FORMULAS {
        let program = program(text);
        for (x, delta) in cases() {
            let moved = |by: f64| std::array::from_fn(|k| x[k] + by * delta[k]);
            let value = |x: [f64; 4]| linearise(&program, x, delta)[0];
            let difference = (value(moved(h)) - value(moved(-h))) / (2.0 * h);
            let slope = linearise(&program, x, delta)[1];
            let error = (slope - difference).abs();
            let size = 1.0 + slope.abs() + value(x).abs();
            assert!(
                error <= 2e-7 * size,
                "{text} at {x:?} along {delta:?}: {slope}, not {difference}"
            );
        }
    }
}

#[test]
fn constant_exponents_need_no_logarithm() {
    // At negative x a logarithm would be no number.
    for (text, slope) in [("x^3", 12.0), ("x^17", 17.0 * 65_536.0), ("x^-2", 0.25), ("x^0", 0.0)] {
        let [_, found] = linearise(&program(text), [-2.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]);
        assert!((found - slope).abs() <= 1e-12 * slope, "{text}: {found}");
    }
}

#[test]
fn what_is_not_taken_does_not_reach_the_derivative() {
    let text = "if(x > 0, sqrt(x), -x)";
    let [value, slope] = linearise(&program(text), [-2.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]);
    assert_eq!([value, slope], [2.0, -1.0]);
}

#[test]
fn derivatives_share_what_values_compute() {
    // δx cos x, −(δx sin x), a product with sin x and one with cos x that is added to it, and 0 δt: neither
    // function is called once more.
    let [values, both] = program("sin(x)*cos(x)").n_operations();
    assert_eq!([values, both - values], [4, 6]);
    // δx exp x, and 0 δt.
    let [values, both] = program("exp(x)").n_operations();
    assert_eq!([values, both - values], [2, 2]);
}
