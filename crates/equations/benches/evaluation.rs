//! Speed of programs on one thread, beside a loop in Rust over the same numbers.
//!
//! Named operation/fixture/size, the size being numbers of a run; elements are evaluations of one
//! number. All is compiled for the instructions that the build is for:
//! `RUSTFLAGS=-Ctarget-feature=+avx2` gives it more than the baseline.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use equations::{Description, Kind, Program, Registers, System};

fn lorenz() -> Program {
    let description = Description {
        kind: Kind::Flow,
        components: vec!["x", "y", "z"],
        equations: vec![("x", "(y - x)*alpha"), ("y", "x*(r - z) - y"), ("z", "x*y - z*b")],
        parameters: vec![("alpha", 10.0), ("r", 35.0), ("b", 8.0 / 3.0)],
        ..Description::default()
    };
    Program::new(&System::read(&description).expect("sound equations"))
}

fn of_x(formula: &str) -> Program {
    let description = Description {
        kind: Kind::Coupling,
        components: vec!["x"],
        equations: vec![("x", formula)],
        ..Description::default()
    };
    Program::new(&System::read(&description).expect("a sound formula"))
}

fn native([x, y, z]: [&[f64]; 3], [dx, dy, dz]: [&mut [f64]; 3]) {
    let length = x.len();
    let (y, z) = (&y[..length], &z[..length]);
    let (dx, dy, dz) = (&mut dx[..length], &mut dy[..length], &mut dz[..length]);
    let (alpha, r, b) = black_box((10.0, 35.0, 8.0 / 3.0));
    for k in 0..length {
        dx[k] = (y[k] - x[k]) * alpha;
        dy[k] = x[k] * (r - z[k]) - y[k];
        dz[k] = x[k] * y[k] - z[k] * b;
    }
}

fn numbers(size: u32) -> Vec<f64> {
    (0..size).map(|k| 0.1 + 0.003 * f64::from(k)).collect()
}

fn time_lorenz(criterion: &mut Criterion) {
    let program = lorenz();
    let mut registers = Registers::new();
    let mut group = criterion.benchmark_group("lorenz");
    for size in [16, 64, 256, 1024] {
        let numbers = numbers(size);
        let [mut a, mut b, mut c, mut d, mut e, mut f] = [(); 6].map(|()| numbers.clone());
        group.throughput(Throughput::Elements(u64::from(size)));
        group.bench_function(format!("native/{size}"), |bencher| {
            bencher.iter(|| native([black_box(&numbers); 3], [&mut a, &mut b, &mut c]));
        });
        group.bench_function(format!("text/{size}"), |bencher| {
            bencher.iter(|| {
                let x = [black_box(numbers.as_slice()); 3];
                program.evaluate(&mut registers, &x, &mut [&mut a, &mut b, &mut c]);
            });
        });
        group.bench_function(format!("text with tangent/{size}"), |bencher| {
            bencher.iter(|| {
                let x = [black_box(numbers.as_slice()); 3];
                let to: [&mut [&mut [f64]]; 2] =
                    [&mut [&mut a, &mut b, &mut c], &mut [&mut d, &mut e, &mut f]];
                program.linearise(&mut registers, [&x, &x], to);
            });
        });
    }
}

fn time_functions(criterion: &mut Criterion) {
    let size = 256;
    let x = numbers(size);
    let mut to = x.clone();
    let mut registers = Registers::new();
    let mut group = criterion.benchmark_group("elementary");
    group.throughput(Throughput::Elements(u64::from(size)));
    for formula in ["exp(x)", "log(x)", "sin(x)", "cos(x)", "tanh(x)", "x^2.5", "tan(x)"] {
        let program = of_x(formula);
        group.bench_function(format!("{formula}/{size}"), |bencher| {
            bencher.iter(|| program.evaluate(&mut registers, &[black_box(&x)], &mut [&mut to]));
        });
    }
}

fn quick() -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(400))
        .sample_size(20)
}

criterion_group! {
    name = benches;
    config = quick();
    targets = time_lorenz, time_functions
}
criterion_main!(benches);
