//! Speed of programs on one thread, beside loops in Rust over the same numbers.
//!
//! Named operation/fixture/size, the size being numbers of a run; elements are evaluations of one
//! number. Programs are compiled for the baseline and for AVX-512 where there is.

use std::hint::black_box;
use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use equations::{Description, Kind, Program, Registers, System};

const SIZES: [usize; 4] = [16, 64, 256, 1024];

type Group<'a> = BenchmarkGroup<'a, WallTime>;

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

/// Vector instructions that work is compiled for, as crates that run programs do it.
#[allow(unsafe_code)]
mod set {
    #[derive(Clone, Copy)]
    pub enum Set {
        Baseline,
        Best,
    }

    impl Set {
        pub fn name(self) -> &'static str {
            match self {
                Self::Baseline => "baseline",
                Self::Best => "best",
            }
        }

        pub fn run(self, work: &mut impl FnMut()) {
            match self {
                Self::Baseline => work(),
                Self::Best => best(work),
            }
        }
    }

    #[cfg(target_arch = "x86_64")]
    fn best(work: &mut impl FnMut()) {
        if is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw")
        {
            // SAFETY: the processor has been asked for every feature that the function enables.
            unsafe { with_avx512(work) };
        } else {
            work();
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
    fn with_avx512(work: &mut impl FnMut()) {
        work();
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn best(work: &mut impl FnMut()) {
        work();
    }
}
use set::Set;

fn time(group: &mut Group<'_>, name: &str, size: usize, set: Set, mut work: impl FnMut()) {
    group.throughput(Throughput::Elements(size as u64));
    group.bench_function(format!("{name}/{}/{size}", set.name()), |bencher| {
        bencher.iter(|| set.run(&mut work));
    });
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
    let mut registers = Registers::new();
    let mut group = criterion.benchmark_group("lorenz");
    for (set, size) in [Set::Best, Set::Baseline].into_iter().flat_map(|s| SIZES.map(|n| (s, n))) {
        let numbers: Vec<f64> = (0..size).map(|k| 0.1 + 0.003 * k as f64).collect();
        let [mut a, mut b, mut c, mut d, mut e, mut f] = [(); 6].map(|()| numbers.clone());
        time(
            &mut group,
            "native",
            size,
            set,
            #[inline(always)]
            || {
                let x = black_box(numbers.as_slice());
                native([x, x, x], [&mut a, &mut b, &mut c]);
            },
        );
        time(
            &mut group,
            "text",
            size,
            set,
            #[inline(always)]
            || {
                let x = black_box(numbers.as_slice());
                program.evaluate(&mut registers, &[x, x, x], &mut [&mut a, &mut b, &mut c]);
            },
        );
        time(
            &mut group,
            "text with tangent",
            size,
            set,
            #[inline(always)]
            || {
                let x = black_box(numbers.as_slice());
                let to: [&mut [&mut [f64]]; 2] =
                    [&mut [&mut a, &mut b, &mut c], &mut [&mut d, &mut e, &mut f]];
                program.linearise(&mut registers, [&[x, x, x], &[x, x, x]], to);
            },
        );
    }
}

fn time_functions(criterion: &mut Criterion) {
    let size = 256;
    let x: Vec<f64> = (0..size).map(|k| 0.1 + 0.003 * k as f64).collect();
    let mut to = x.clone();
    let mut registers = Registers::new();
    let mut group = criterion.benchmark_group("elementary");
    for formula in ["exp(x)", "log(x)", "sin(x)", "cos(x)", "tanh(x)", "x^2.5", "tan(x)"] {
        let program = of_x(formula);
        for set in [Set::Best, Set::Baseline] {
            time(
                &mut group,
                formula,
                size,
                set,
                #[inline(always)]
                || {
                    program.evaluate(&mut registers, &[black_box(&x)], &mut [&mut to]);
                },
            );
        }
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
