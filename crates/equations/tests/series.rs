//! Series of solutions against closed forms, and against differences of what programs give.

use equations::{Coefficients, Description, Kind, Program, Registers, SlopeValue, System};

fn program(components: &[&'static str], equations: Vec<(&'static str, &'static str)>) -> Program {
    let description = Description {
        kind: Kind::Flow,
        components: components.to_vec(),
        equations,
        ..Description::default()
    };
    Program::new(&System::read(&description).unwrap())
}

/// Coefficients of every register up to an order, of a solution from one state.
fn series(program: &Program, start: &[f64], order: usize) -> Coefficients<1> {
    let series = program.series().expect("these equations have series");
    let mut of = Coefficients::<1>::new(series.n_registers(), order + 1);
    for (c, x) in start.iter().enumerate() {
        of.of_mut(c)[0] = [*x];
    }
    for k in 0..order {
        series.order(k, &mut of);
        for (c, &output) in series.outputs().iter().enumerate() {
            let rate = of.of(output)[k][0];
            of.of_mut(c)[k + 1] = [rate / (k + 1) as f64];
        }
    }
    series.order(order, &mut of);
    of
}

/// x at a time.
type Solution = fn(f64) -> f64;

fn at(coefficients: &[[f64; 1]], time: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, [c]| sum * time + c)
}

#[test]
fn solutions_that_are_known_have_their_series() {
    let cases: [(&'static str, f64, Solution); 4] = [
        ("x", 1.0, f64::exp),
        ("1 + x^2", 0.0, f64::tan),
        ("1 - x^2", 0.0, f64::tanh),
        ("-x^2", 1.0, |t| 1.0 / (1.0 + t)),
    ];
    for (rate, start, solution) in cases {
        let of = series(&program(&["x"], vec![("x", rate)]), &[start], 24);
        for time in [0.0, 0.1, -0.2, 0.3] {
            let [found, exact] = [at(of.of(0), time), solution(time)];
            assert!((found - exact).abs() < 1e-12, "{rate} at {time}: {found} for {exact}");
        }
    }
}

/// With x = 1/2 + t and y = 3/2 − t every formula becomes a function of time, whose series the output
/// has, and whose derivatives along x and y the entries of the Jacobian have.
#[test]
fn every_function_has_the_series_of_its_values_and_slopes() {
    let formulas = [
        "x*y",
        "x/y",
        "3/x",
        "x^7*y^-3",
        "(x*y)^2.5",
        "x^y",
        "2^x",
        "y^(x - 3)",
        "x^-1.5",
        "sqrt(x + y^2)",
        "exp(x*y - 2)",
        "log(x*y)",
        "sin(x*y)",
        "cos(x*y)",
        "sin(x)*cos(x)",
        "tan(x/2)",
        "asin(x/10)",
        "acos(y/10)",
        "atan(x*y)",
        "atan2(x, y)",
        "atan2(x, 2)",
        "atan2(-1, y)",
        "sinh(x - y)",
        "cosh(x - y)",
        "tanh(x - y)",
        "exp(sin(x*y) + tanh(y)/x)",
        "2 - (x - y)/4 + 3*x - (1 - y)*5",
        "x*(2 - y) - y*(x + 1)/7",
    ];
    const TIME: f64 = 0.02;
    for formula in formulas {
        let program = program(&["x", "y", "z"], vec![("x", "1"), ("y", "-1"), ("z", formula)]);
        let of = series(&program, &[0.5, 1.5, 0.0], 16);
        let known = program.series().unwrap();
        let state = [0.5 + TIME, 1.5 - TIME, 0.0];
        let [value, along_x, along_y] = direct(&program, state);
        let found = at(of.of(known.outputs()[2]), TIME);
        assert!((found - value).abs() < 1e-12 * (1.0 + value.abs()), "{formula}: {found}, {value}");
        for (input, exact) in [(0, along_x), (1, along_y)] {
            let slope = known.slopes().iter().find(|s| s.output == 2 && s.input == input);
            let found = match slope.map(|slope| slope.value) {
                None => 0.0,
                Some(SlopeValue::Constant(value)) => value,
                Some(SlopeValue::Series(register)) => at(of.of(register), TIME),
            };
            let allowed = 1e-11 * (1.0 + exact.abs());
            assert!((found - exact).abs() < allowed, "{formula}, {input}: {found} for {exact}");
        }
    }
}

/// z' with its derivatives along x and y.
fn direct(program: &Program, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let state = [[x; 2], [y; 2], [z; 2]];
    let tangent = [[1.0, 0.0], [0.0, 1.0], [0.0; 2]];
    let [x, delta] = [&state, &tangent].map(|of| of.iter().map(|x| &x[..]).collect::<Vec<_>>());
    let (mut to, mut to_delta) = ([[0.0; 2]; 3], [[0.0; 2]; 3]);
    let [mut a, mut b] =
        [&mut to, &mut to_delta].map(|of| of.iter_mut().map(|x| &mut x[..]).collect::<Vec<_>>());
    program.linearise(&mut Registers::new(), [&x, &delta], [&mut a, &mut b]);
    [to[2][0], to_delta[2][0], to_delta[2][1]]
}

#[test]
fn equations_with_pieces_have_no_series() {
    for formula in ["abs(x)", "if(x > 0, 1, x)", "max(x, 1)", "sign(x)", "floor(x)"] {
        assert!(program(&["x"], vec![("x", formula)]).series().is_none(), "{formula}");
    }
    // What a piece does not depend on is no piece.
    assert!(program(&["x"], vec![("x", "abs(-3)*x")]).series().is_some());
}

#[test]
fn every_lane_has_the_bits_of_a_solution_by_itself() {
    let program = program(
        &["x", "y", "z"],
        vec![("x", "10*(y - x)"), ("y", "x*(28 - z) - y"), ("z", "x*y - z*sin(x)^2")],
    );
    let known = program.series().unwrap();
    let mut of = Coefficients::<16>::new(known.n_registers(), 9);
    let starts: Vec<[f64; 3]> =
        (0..16).map(|lane| [1.0 + 0.1 * f64::from(lane), 2.0, 20.0 - f64::from(lane)]).collect();
    for c in 0..3 {
        of.of_mut(c)[0] = std::array::from_fn(|lane| starts[lane][c]);
    }
    for k in 0..8 {
        known.order(k, &mut of);
        for (c, &output) in known.outputs().iter().enumerate() {
            let rate = of.of(output)[k];
            of.of_mut(c)[k + 1] = rate.map(|rate| rate / (k + 1) as f64);
        }
    }
    for (lane, start) in starts.iter().enumerate() {
        let alone = series(&program, start, 8);
        for c in 0..3 {
            let here: Vec<f64> = of.of(c).iter().map(|lanes| lanes[lane]).collect();
            assert_eq!(here, alone.of(c).as_flattened());
        }
    }
}
