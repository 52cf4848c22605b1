//! Programs against the same equations written in Rust: the same bits.

use equations::{Description, Kind, Program, Registers, System};
use rand_core::Rng as _;
use rand_pcg::Pcg64Mcg;

const XYZ: [&str; 3] = ["x", "y", "z"];

fn program(equations: [&'static str; 3], parameters: &[(&'static str, f64)]) -> Program {
    let description = Description {
        components: XYZ.to_vec(),
        equations: XYZ.into_iter().zip(equations).collect(),
        parameters: parameters.to_vec(),
        ..Description::default()
    };
    Program::new(&System::read(&description).expect("sound equations"))
}

/// Evaluates a program of three components.
fn evaluate(program: &Program, x: &[Vec<f64>; 3]) -> [Vec<f64>; 3] {
    let mut to = x.clone();
    let at = x.each_ref().map(Vec::as_slice);
    let [a, b, c] = &mut to;
    program.evaluate(&mut Registers::new(), &at, &mut [a, b, c]);
    to
}

/// Evaluates a program of three components with a tangent.
fn linearise(program: &Program, x: &[Vec<f64>; 3], delta: &[Vec<f64>; 3]) -> [[Vec<f64>; 3]; 2] {
    let mut to = [x.clone(), x.clone()];
    let (at, along) = (x.each_ref().map(Vec::as_slice), delta.each_ref().map(Vec::as_slice));
    let [[a, b, c], [d, e, f]] = &mut to;
    program.linearise(&mut Registers::new(), [&at, &along], [&mut [a, b, c], &mut [d, e, f]]);
    to
}

fn random(seed: u128, count: usize) -> [Vec<f64>; 3] {
    let mut random = Pcg64Mcg::new(seed);
    let mut draw = |_| (random.next_u64() >> 11) as f64 / (1u64 << 52) as f64 * 10.0 - 10.0;
    std::array::from_fn(|_| (0..count).map(&mut draw).collect())
}

fn bits(values: &[Vec<f64>; 3]) -> [Vec<u64>; 3] {
    values.each_ref().map(|values| values.iter().map(|x| x.to_bits()).collect())
}

/// A number with a tangent, as natives have them.
#[derive(Clone, Copy)]
struct Dual(f64, f64);

/// What native flows are written in.
trait Number: Copy {
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    fn constant(value: f64) -> Self;
}

impl Number for f64 {
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn minus(self, other: Self) -> Self {
        self - other
    }
    fn times(self, other: Self) -> Self {
        self * other
    }
    fn constant(value: f64) -> Self {
        value
    }
}

impl Number for Dual {
    fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
    fn minus(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1)
    }
    fn times(self, other: Self) -> Self {
        Self(self.0 * other.0, other.1 * self.0 + self.1 * other.0)
    }
    fn constant(value: f64) -> Self {
        Self(value, 0.0)
    }
}

fn lorenz<N: Number>([x, y, z]: [N; 3]) -> [N; 3] {
    let c = N::constant;
    [
        y.minus(x).times(c(10.0)),
        x.times(c(35.0).minus(z)).minus(y),
        x.times(y).minus(z.times(c(8.0 / 3.0))),
    ]
}

fn rossler<N: Number>([x, y, z]: [N; 3]) -> [N; 3] {
    let c = N::constant;
    // −(y + z) as 0 − (y + z), which differs in the sign of zero alone.
    [c(0.0).minus(y.plus(z)), x.plus(y.times(c(0.2))), z.times(x.minus(c(9.0))).plus(c(0.2))]
}

fn hindmarsh_rose<N: Number>([x, y, z]: [N; 3]) -> [N; 3] {
    let c = N::constant;
    let x_2 = x.times(x);
    [
        y.plus(x_2.times(c(3.0).minus(x))).minus(z).plus(c(3.2)),
        c(1.0).minus(x_2.times(c(5.0))).minus(y),
        x.plus(c(1.6)).times(c(4.0)).minus(z).times(c(0.006)),
    ]
}

/// Checks values and tangents of any lengths of runs against a flow in Rust.
#[track_caller]
fn check_bits(program: &Program, flow: fn([f64; 3]) -> [f64; 3], dual: fn([Dual; 3]) -> [Dual; 3]) {
    for count in [1, 5, 16, 23, 1000] {
        let (x, delta) = (random(1, count), random(2, count));
        let (mut values, mut slopes) = (x.clone(), x.clone());
        for number in 0..count {
            let value = flow([0, 1, 2].map(|c| x[c][number]));
            let slope = dual([0, 1, 2].map(|c| Dual(x[c][number], delta[c][number])));
            for c in 0..3 {
                (values[c][number], slopes[c][number]) = (value[c], slope[c].1);
            }
        }
        assert_eq!(bits(&evaluate(program, &x)), bits(&values));
        let [of_text, tangents] = linearise(program, &x, &delta);
        assert_eq!(bits(&of_text), bits(&values));
        assert_eq!(bits(&tangents), bits(&slopes));
    }
}

fn lorenz_as_text() -> Program {
    program(
        ["(y - x)*alpha", "x*(r - z) - y", "x*y - z*b"],
        &[("alpha", 10.0), ("r", 35.0), ("b", 8.0 / 3.0)],
    )
}

#[test]
fn lorenz_as_text_has_the_bits_of_lorenz_in_rust() {
    check_bits(&lorenz_as_text(), lorenz, lorenz);
    assert_eq!(lorenz_as_text().n_operations()[0], 6);
}

#[test]
fn rossler_as_text_has_the_bits_of_rossler_in_rust() {
    let program =
        program(["-(y + z)", "x + y*a", "z*(x - c) + b"], &[("a", 0.2), ("b", 0.2), ("c", 9.0)]);
    check_bits(&program, rossler, rossler);
}

#[test]
fn hindmarsh_rose_as_text_has_the_bits_of_hindmarsh_rose_in_rust() {
    let program = program(
        ["y + x^2*(3 - x) - z + current", "1 - x^2*5 - y", "((x + 1.6)*s - z)*r"],
        &[("r", 0.006), ("s", 4.0), ("current", 3.2)],
    );
    check_bits(&program, hindmarsh_rose, hindmarsh_rose);
    // x² is computed once, and two products are within sums.
    assert_eq!(program.n_operations()[0], 11);
}

/// Checks three formulas of x, y, z.
#[track_caller]
fn check(equations: [&'static str; 3], flow: fn([f64; 3]) -> [f64; 3]) -> Program {
    let program = program(equations, &[("n", 3.0)]);
    let x = random(3, 100);
    let mut right = x.clone();
    for number in 0..100 {
        let values = flow([0, 1, 2].map(|c| x[c][number]));
        for c in 0..3 {
            right[c][number] = values[c];
        }
    }
    assert_eq!(bits(&evaluate(&program, &x)), bits(&right), "{equations:?}");
    program
}

#[test]
fn integer_powers_are_products() {
    check(["x^2", "x^3", "x^4"], |[x, ..]| [x * x, x * x * x, (x * x) * (x * x)]);
    check(["x^5", "x^-2", "x^n"], |[x, ..]| [(x * x) * (x * x) * x, 1.0 / (x * x), x * x * x]);
    check(["x^0", "x^1", "x^(1 + 1)"], |[x, ..]| [1.0, x, x * x]);
}

#[test]
fn precedence_is_that_of_mathematics() {
    check(["-x^2", "2^-2*x", "x^2^0*y"], |[x, y, _]| [-(x * x), 0.25 * x, x * y]);
    check(["x - y - z", "x/y/z", "x - (y - z)"], |[x, y, z]| [x - y - z, x / y / z, x - (y - z)]);
    check(["x + y*z", "-x*y", "2 - -x"], |[x, y, z]| [x + y * z, -x * y, 2.0 - -x]);
}

#[test]
fn branches_are_selections() {
    check(["if(x < y, x, y)", "if(x > 0 and not y > 0, 1, z)", "if(x >= 0 or y == z, x, -x)"], {
        |[x, y, z]| {
            [
                if x < y { x } else { y },
                if x > 0.0 && (y <= 0.0) { 1.0 } else { z },
                if x >= 0.0 || y == z { x } else { -x },
            ]
        }
    });
    // What is not taken may be anything.
    check(["if(x > 0, sqrt(x), 0)", "if(x != 0, y/x, 0)", "min(x, max(y, z))"], |[x, y, z]| {
        let larger = if y > z { y } else { z };
        [if x > 0.0 { x.sqrt() } else { 0.0 }, y / x, if x < larger { x } else { larger }]
    });
}

#[test]
fn nothing_is_computed_twice_and_constants_beforehand() {
    let shared = program(["x*y + z", "y*x + 1", "(x*y + z)*2"], &[]);
    assert_eq!(shared.n_operations()[0], 4);
    let folded = program(["x*(2*3 + sin(1)^2)", "if(2 > 1, x, exp(y))", "z"], &[]);
    assert_eq!(folded.n_operations()[0], 1);
    let none = program(["0", "pi", "x"], &[]);
    assert_eq!(none.n_operations(), [0, 0]);
    assert_eq!(evaluate(&none, &random(4, 3))[1], [std::f64::consts::PI; 3]);
    // Sums are not reordered, so the second cannot share x + y with the first.
    assert_eq!(program(["x + y + z", "z + y + x", "0"], &[]).n_operations()[0], 4);
}

#[test]
fn subexpressions_and_parameters_are_put_in_place() {
    let description = Description {
        components: vec!["v"],
        equations: vec![("v", "g + β*f")],
        subexpressions: vec![("g", "f - 1"), ("f", "β*v")],
        parameters: vec![("β", 3.0)],
        ..Description::default()
    };
    let mut system = System::read(&description).expect("sound equations");
    let mut to = [0.0];
    let mut value = |system: &System| {
        Program::new(system).evaluate(&mut Registers::new(), &[&[2.0]], &mut [&mut to]);
        to[0]
    };
    assert_eq!(value(&system), 5.0 + 18.0);
    system.set("β", 5.0).expect("a parameter");
    assert!(system.set("γ", 5.0).is_err() && system.set("β", f64::NAN).is_err());
    assert_eq!(value(&system), 9.0 + 50.0);
}

#[test]
fn time_is_one_more_component_that_grows() {
    for (kind, grown) in [(Kind::Flow, 1.0), (Kind::Map, 8.0)] {
        let description = Description {
            kind,
            components: vec!["x"],
            equations: vec![("x", "x*t")],
            ..Description::default()
        };
        let program = Program::new(&System::read(&description).expect("sound equations"));
        assert_eq!([program.n_inputs(), program.n_outputs()], [2, 2]);
        let [mut x, mut t] = [[0.0]; 2];
        program.evaluate(&mut Registers::new(), &[&[3.0], &[7.0]], &mut [&mut x, &mut t]);
        assert_eq!([x, t], [[21.0], [grown]]);
    }
}

#[test]
fn registers_serve_any_programs_in_turn() {
    let (small, large) = (program(["x", "1", "2"], &[]), lorenz_as_text());
    let x = random(5, 20);
    let mut registers = Registers::new();
    for program in [&small, &large, &small] {
        let mut to = x.clone();
        let at = x.each_ref().map(Vec::as_slice);
        let [a, b, c] = &mut to;
        program.evaluate(&mut registers, &at, &mut [a, b, c]);
        assert_eq!(to, evaluate(program, &x));
    }
}
