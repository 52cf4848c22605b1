//! Elementary functions against correctly rounded ones (core-math), over the whole range of doubles.
//!
//! They are called as anybody calls them, as programs, so that lanes are those of a program.

use equations::{Description, Kind, Program, Registers, System};
use rand_core::Rng as _;
use rand_pcg::Pcg64Mcg;

/// A formula of x, and of y where it has two.
struct Function(Program);

impl Function {
    fn new(formula: &'static str) -> Self {
        let description = Description {
            kind: Kind::Coupling,
            components: vec!["x", "y"],
            equations: vec![("x", formula)],
            ..Description::default()
        };
        Self(Program::new(&System::read(&description).expect("a sound formula")))
    }

    fn of(&self, x: &[f64], y: &[f64]) -> Vec<f64> {
        let mut to = vec![0.0; x.len()];
        self.0.evaluate(&mut Registers::new(), &[x, y], &mut [&mut to]);
        to
    }

    fn at(&self, x: f64) -> f64 {
        self.of(&[x], &[0.0])[0]
    }
}

/// How many doubles lie between two, both of which may be anything.
fn distance(a: f64, b: f64) -> u64 {
    if a.is_nan() || b.is_nan() {
        return if a.is_nan() == b.is_nan() { 0 } else { u64::MAX };
    }
    let place = |x: f64| {
        let bits = x.abs().to_bits() as i64;
        if x.is_sign_negative() { -bits } else { bits }
    };
    place(a).abs_diff(place(b))
}

fn count() -> usize {
    if std::env::var_os("EIGENSYNC_LONG_TESTS").is_some() {
        return 10_000_000;
    }
    100_000 // Ten million wait for the variable.
}

struct Random(Pcg64Mcg);

impl Random {
    fn bits(&mut self) -> f64 {
        f64::from_bits(self.0.next_u64())
    }

    fn within(&mut self, from: f64, to: f64) -> f64 {
        let unit = (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        from + (to - from) * unit
    }

    /// Any double, or one of a range, or one of any small size in that range.
    fn argument(&mut self, from: f64, to: f64) -> f64 {
        match self.0.next_u64() % 4 {
            0 => self.bits(),
            1 => self.within(from, to) * f64::from_bits((963 + self.0.next_u64() % 60) << 52),
            _ => self.within(from, to),
        }
    }
}

/// Checks a function of one number over all doubles, most of them from a range.
#[track_caller]
fn check(formula: &'static str, right: fn(f64) -> f64, [from, to]: [f64; 2], at_most: u64) {
    let function = Function::new(formula);
    let mut random = Random(Pcg64Mcg::new(7));
    let (mut worst, mut at, mut off) = (0, 0.0, 0);
    for _ in 0..count() / 1000 {
        let x: Vec<f64> = (0..1000).map(|_| random.argument(from, to)).collect();
        for (x, value) in x.iter().zip(function.of(&x, &x)) {
            let distance = distance(value, right(*x));
            off += usize::from(distance > 0);
            if distance > worst {
                (worst, at) = (distance, *x);
            }
        }
    }
    println!("{formula}: at most {worst} ulp (at {at:e}), {off} of {} not the nearest", count());
    assert!(worst <= at_most, "{formula} is {worst} ulp off at {at:e}");
}

#[test]
fn exp_is_within_one_ulp() {
    check("exp(x)", core_math::exp, [-750.0, 720.0], 1);
    check("exp(x)", core_math::exp, [-1.0, 1.0], 1);
}

#[test]
fn log_is_within_one_ulp() {
    check("log(x)", core_math::log, [0.0, 3.0], 1);
    check("log(x)", core_math::log, [0.9, 1.1], 1);
}

#[test]
fn sin_is_within_one_ulp() {
    check("sin(x)", core_math::sin, [-10.0, 10.0], 1);
    check("sin(x)", core_math::sin, [-3e6, 3e6], 1);
    check("sin(x)", core_math::sin, [-1e22, 1e22], 1);
}

#[test]
fn cos_is_within_one_ulp() {
    check("cos(x)", core_math::cos, [-10.0, 10.0], 1);
    check("cos(x)", core_math::cos, [-3e6, 3e6], 1);
    check("cos(x)", core_math::cos, [-1e22, 1e22], 1);
}

#[test]
fn tanh_is_within_one_ulp() {
    check("tanh(x)", core_math::tanh, [-22.0, 22.0], 1);
    check("tanh(x)", core_math::tanh, [-1.0, 1.0], 1);
}

#[test]
fn the_rarer_functions_are_those_of_libm() {
    check("sqrt(x)", f64::sqrt, [0.0, 10.0], 0);
    check("floor(x)", f64::floor, [-10.0, 10.0], 0);
    check("tan(x)", libm::tan, [-10.0, 10.0], 0);
    check("asin(x)", libm::asin, [-1.0, 1.0], 0);
    check("acos(x)", libm::acos, [-1.0, 1.0], 0);
    check("atan(x)", libm::atan, [-10.0, 10.0], 0);
    check("sinh(x)", libm::sinh, [-20.0, 20.0], 0);
    check("cosh(x)", libm::cosh, [-20.0, 20.0], 0);
}

#[test]
fn powers_are_within_one_ulp() {
    let function = Function::new("x^y");
    let mut random = Random(Pcg64Mcg::new(8));
    let (mut worst, mut at, mut off) = (0, (0.0, 0.0), 0);
    for _ in 0..count() / 1000 {
        let pair = |random: &mut Random| match random.0.next_u64() % 5 {
            0 => (random.bits(), random.bits()),
            1 => (random.bits(), random.within(-2.0, 2.0)),
            2 => (random.within(0.5, 2.0), random.within(-1100.0, 1100.0)),
            3 => (1.0 + random.within(-1e-6, 1e-6), random.within(-1e9, 1e9)),
            _ => (random.within(-9.0, 9.0), random.within(-40.0, 40.0).round()),
        };
        let (x, y): (Vec<f64>, Vec<f64>) = (0..1000).map(|_| pair(&mut random)).unzip();
        for ((x, y), value) in x.iter().zip(&y).zip(function.of(&x, &y)) {
            let distance = distance(value, core_math::pow(*x, *y));
            off += usize::from(distance > 0);
            if distance > worst {
                (worst, at) = (distance, (*x, *y));
            }
        }
    }
    println!("x^y: at most {worst} ulp (at {at:?}), {off} of {} not the nearest", count());
    assert!(worst <= 1, "x^y is {worst} ulp off at {at:?}");
}

const INF: f64 = f64::INFINITY;

/// Values with their bits; anything that is no number is as good as any other.
#[track_caller]
fn check_exact(formula: &'static str, values: &[(f64, f64)]) {
    let function = Function::new(formula);
    for (x, right) in values {
        let value = function.at(*x);
        let same = value.to_bits() == right.to_bits() || value.is_nan() && right.is_nan();
        assert!(same, "{formula} of {x} is {value}, not {right}");
    }
}

#[test]
fn special_values_are_exact() {
    let tiny = f64::from_bits(1);
    check_exact(
        "exp(x)",
        &[(0.0, 1.0), (-0.0, 1.0), (INF, INF), (-INF, 0.0), (f64::NAN, f64::NAN)],
    );
    check_exact("exp(x)", &[(tiny, 1.0), (710.0, INF), (1e300, INF), (-746.0, 0.0), (-1e300, 0.0)]);
    check_exact("log(x)", &[(0.0, -INF), (-0.0, -INF), (1.0, 0.0), (INF, INF), (-INF, f64::NAN)]);
    check_exact("log(x)", &[(-1.0, f64::NAN), (-tiny, f64::NAN), (f64::NAN, f64::NAN)]);
    check_exact("log(x)", &[(tiny, core_math::log(tiny)), (f64::MAX, core_math::log(f64::MAX))]);
    for (formula, at_zero) in [("sin(x)", 0.0), ("tanh(x)", 0.0)] {
        check_exact(formula, &[(0.0, at_zero), (-0.0, -at_zero), (tiny, tiny), (-tiny, -tiny)]);
        check_exact(formula, &[(f64::NAN, f64::NAN), (1e-310, 1e-310)]);
    }
    check_exact("sin(x)", &[(INF, f64::NAN), (-INF, f64::NAN)]);
    check_exact(
        "cos(x)",
        &[(0.0, 1.0), (-0.0, 1.0), (tiny, 1.0), (INF, f64::NAN), (-INF, f64::NAN)],
    );
    check_exact("tanh(x)", &[(INF, 1.0), (-INF, -1.0), (25.0, 1.0), (-1e300, -1.0)]);
    check_exact("abs(x)", &[(-0.0, 0.0), (-INF, INF), (-2.5, 2.5), (f64::NAN, f64::NAN)]);
    check_exact("sign(x)", &[(-2.0, -1.0), (tiny, 1.0), (0.0, 0.0), (-0.0, -0.0), (-INF, -1.0)]);
    check_exact("sign(x)", &[(f64::NAN, f64::NAN)]);
    check_exact(
        "floor(x)",
        &[(-0.0, -0.0), (-0.5, -1.0), (0.5, 0.0), (-INF, -INF), (-1e300, -1e300)],
    );
    check_exact("min(x, 1)", &[(2.0, 1.0), (-2.0, -2.0), (f64::NAN, f64::NAN)]);
    check_exact("max(1, x)", &[(2.0, 2.0), (-2.0, 1.0), (f64::NAN, f64::NAN)]);
}

#[test]
fn sin_and_cos_of_huge_arguments_are_right() {
    // 6381956970095103 · 2^797 is the double nearest to a multiple of π/2 relative to its size.
    let nearest = 6_381_956_970_095_103.0 * f64::from_bits((1023 + 797) << 52);
    for x in [1e22, nearest, f64::MAX, 1_048_576.0, 1_048_577.0, 1e300, 1e15] {
        for x in [x, -x] {
            assert!(distance(Function::new("sin(x)").at(x), core_math::sin(x)) <= 1, "sin {x}");
            assert!(distance(Function::new("cos(x)").at(x), core_math::cos(x)) <= 1, "cos {x}");
        }
    }
}

#[test]
fn special_powers_are_those_of_ieee_754() {
    let function = Function::new("x^y");
    let numbers = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        2.0,
        -2.0,
        3.0,
        -3.0,
        0.5,
        -0.5,
        2.5,
        -2.5,
        INF,
        -INF,
        f64::NAN,
        1e300,
        -1e300,
        1e-300,
        1e-310,
        -1e-310,
        4_503_599_627_370_497.0,
        9_007_199_254_740_993.0,
        4_503_599_627_370_495.5,
    ];
    for x in numbers {
        for y in numbers {
            let (value, right) = (function.of(&[x], &[y])[0], core_math::pow(x, y));
            // Zeros have signs.
            let same =
                distance(value, right) <= 1 && value.is_sign_negative() == right.is_sign_negative();
            assert!(same || value.is_nan() && right.is_nan(), "{x}^{y} is {value}, not {right}");
        }
    }
}

#[test]
fn lanes_and_lengths_of_runs_change_no_bit() {
    let formula = "exp(x) + log(abs(x)) + sin(x) + cos(y) + tanh(x) + abs(x)^y";
    let function = Function::new(formula);
    let mut random = Random(Pcg64Mcg::new(9));
    let x: Vec<f64> = (0..200).map(|_| random.argument(-3e6, 3e6)).collect();
    let y: Vec<f64> = (0..200).map(|_| random.argument(-3.0, 3.0)).collect();
    let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    let all = bits(function.of(&x, &y));
    for length in [1, 2, 3, 7, 15, 16, 17, 33, 200] {
        let runs = x.chunks(length).zip(y.chunks(length));
        let parts: Vec<f64> = runs.flat_map(|(x, y)| function.of(x, y)).collect();
        assert_eq!(bits(parts), all, "runs of {length}");
    }
}

/// FNV-1a over bits; anything that is no number counts as the same.
fn digest(values: &[f64]) -> u64 {
    let bits = |x: &f64| if x.is_nan() { 0 } else { x.to_bits() };
    let mix = |digest: u64, byte: u8| (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    values.iter().flat_map(|x| bits(x).to_le_bytes()).fold(0xcbf2_9ce4_8422_2325, mix)
}

#[test]
fn bits_are_the_same_on_every_machine_for_ever() {
    // Printed by this test; a change would change every result that such a function is part of.
    const PINNED: [(&str, u64); 16] = [
        ("exp(x)", 0xf31a_97ed_42d5_0d2b),
        ("log(x)", 0xdd61_72ab_d88a_6d30),
        ("sin(x)", 0x3bbc_d64d_ebb0_dca0),
        ("cos(x)", 0xb0d2_56d3_a888_a0c0),
        ("tanh(x)", 0x4148_6a7e_3909_9337),
        ("x^y", 0xc2fa_cfa1_13eb_9790),
        ("abs(x)^y", 0x0242_215e_5513_f58d),
        ("tan(x)", 0x194e_923b_b588_ab63),
        ("asin(x/9)", 0x047f_ada7_68b4_a209),
        ("acos(x/9)", 0x16d2_3b8e_2251_50f8),
        ("atan(x)", 0x9187_cc18_fcec_2bfd),
        ("atan2(x, y)", 0x4eab_ec51_f307_5e37),
        ("sinh(x)", 0x0054_1f13_bf0d_4f9e),
        ("cosh(x)", 0xea81_96af_cb81_af0b),
        ("floor(x)", 0x8cdf_d43a_92de_3d3f),
        ("min(sign(x), y)", 0xe5af_0876_db29_7500),
    ];
    let mut random = Random(Pcg64Mcg::new(10));
    let x: Vec<f64> = (0..20_000).map(|_| random.argument(-9.0, 9.0)).collect();
    let y: Vec<f64> = (0..20_000).map(|_| random.within(-9.0, 9.0)).collect();
    let digests = PINNED.map(|(formula, _)| (formula, digest(&Function::new(formula).of(&x, &y))));
    assert_eq!(digests, PINNED, "{digests:#x?}");
}
