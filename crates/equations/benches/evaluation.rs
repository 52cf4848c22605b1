//! Speed of programs on one thread, beside loops in Rust over the same numbers.
//!
//! Named operation/fixture/size, the size being numbers of a run; elements are evaluations of one
//! number. Programs are compiled for the baseline and for what the processor has.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use equations::{Description, Kind, Program, Registers, System};

const SIZES: [usize; 4] = [16, 64, 256, 1024];

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

fn numbers(size: usize) -> Vec<f64> {
    (0..size).map(|k| 0.1 + 0.003 * k as f64).collect()
}

/// Work compiled for the most instructions that this crate's users compile for.
#[allow(unsafe_code)]
mod best {
    /// Runs it for AVX-512 where there is, and as it is elsewhere.
    pub fn run(work: impl FnMut()) {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
            {
                // SAFETY: the processor has been asked for every feature that the function enables.
                return unsafe { with_avx512(work) };
            }
        }
        run_plain(work);
    }

    pub fn run_plain(mut work: impl FnMut()) {
        work();
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
    fn with_avx512(mut work: impl FnMut()) {
        work();
    }
}

#[inline(always)]
fn native(x: [&[f64]; 3], to: [&mut [f64]; 3]) {
    let [dx, dy, dz] = to;
    let length = x[0].len();
    let [x, y, z] = x.map(|x| &x[..length]);
    let (dx, dy, dz) = (&mut dx[..length], &mut dy[..length], &mut dz[..length]);
    let (alpha, r, b) = black_box((10.0, 35.0, 8.0 / 3.0));
    for k in 0..length {
        dx[k] = (y[k] - x[k]) * alpha;
        dy[k] = x[k] * (r - z[k]) - y[k];
        dz[k] = x[k] * y[k] - z[k] * b;
    }
}

fn time_lorenz(criterion: &mut Criterion) {
    let program = lorenz();
    for size in SIZES {
        let x = numbers(size);
        let [mut dx, mut dy, mut dz] = [x.clone(), x.clone(), x.clone()];
        let mut registers = Registers::new();
        let mut group = criterion.benchmark_group("evaluate");
        group.throughput(Throughput::Elements(size as u64));
        group.bench_function(format!("lorenz/native/{size}"), |bencher| {
            bencher.iter(|| {
                best::run(
                    #[inline(always)]
                    || {
                        let x = black_box(x.as_slice());
                        native([x, x, x], [&mut dx, &mut dy, &mut dz]);
                    },
                )
            });
        });
        group.bench_function(format!("lorenz/text/{size}"), |bencher| {
            bencher.iter(|| {
                best::run(
                    #[inline(always)]
                    || {
                        let x = black_box(x.as_slice());
                        program.evaluate(
                            &mut registers,
                            &[x, x, x],
                            &mut [&mut dx, &mut dy, &mut dz],
                        );
                    },
                )
            });
        });
        group.bench_function(format!("lorenz/text baseline/{size}"), |bencher| {
            bencher.iter(|| {
                best::run_plain(
                    #[inline(always)]
                    || {
                        let x = black_box(x.as_slice());
                        program.evaluate(
                            &mut registers,
                            &[x, x, x],
                            &mut [&mut dx, &mut dy, &mut dz],
                        );
                    },
                )
            });
        });
        let [mut ex, mut ey, mut ez] = [x.clone(), x.clone(), x.clone()];
        group.bench_function(format!("lorenz/text with tangent/{size}"), |bencher| {
            bencher.iter(|| {
                best::run(
                    #[inline(always)]
                    || {
                        let x = black_box(x.as_slice());
                        let to: [&mut [&mut [f64]]; 2] =
                            [&mut [&mut dx, &mut dy, &mut dz], &mut [&mut ex, &mut ey, &mut ez]];
                        program.linearise(&mut registers, [&[x, x, x], &[x, x, x]], to);
                    },
                )
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
    group.throughput(Throughput::Elements(size as u64));
    for formula in ["exp(x)", "log(x)", "sin(x)", "cos(x)", "tanh(x)", "x^2.5", "tan(x)"] {
        let program = of_x(formula);
        group.bench_function(format!("{formula}/{size}"), |bencher| {
            bencher.iter(|| {
                best::run(
                    #[inline(always)]
                    || {
                        program.evaluate(&mut registers, &[black_box(&x)], &mut [&mut to]);
                    },
                )
            });
        });
        group.bench_function(format!("{formula} baseline/{size}"), |bencher| {
            bencher.iter(|| {
                best::run_plain(
                    #[inline(always)]
                    || {
                        program.evaluate(&mut registers, &[black_box(&x)], &mut [&mut to]);
                    },
                )
            });
        });
    }
}

fn quick() -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600))
        .sample_size(20)
}

criterion_group! {
    name = benches;
    config = quick();
    targets = time_lorenz, time_functions
}
criterion_main!(benches);
