//! scratch
#[allow(dead_code)]
#[path = "fixture.rs"]
mod fixture;
use graph::{CouplingMatrix, Normalization};
use spectra::*;
use std::time::Instant;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let (name, n, kind, modes, tol) =
        (&a[1], a[2].parse().unwrap(), &a[3], &a[4], a[5].parse().unwrap());
    let t = Instant::now();
    let net = fixture::named(name, n);
    let w = CouplingMatrix::new(
        &net,
        if kind == "norm" { Normalization::Normalized } else { Normalization::Laplacian },
    );
    drop(net);
    let build = t.elapsed();
    for s in &a[6..] {
        let solver = match s.as_str() {
            "auto" => SolverChoice::Auto,
            "arpack" => SolverChoice::Arpack,
            "cheb" => SolverChoice::Chebyshev,
            "si" => SolverChoice::ShiftInvert,
            "dense" => SolverChoice::Dense,
            _ => panic!(),
        };
        let modes = if let Some(c) = modes.strip_prefix('>') {
            Modes::Above(c.parse().unwrap())
        } else {
            Modes::Leading(modes.parse().unwrap())
        };
        let t = Instant::now();
        let verbose = std::env::var("V").is_ok();
        let r = leading_modes_with(
            &w,
            &Request { modes, solver, tolerance: tol, ..Request::default() },
            &|p| {
                if verbose {
                    eprintln!("{:.2} {p:?}", t.elapsed().as_secs_f64())
                }
            },
        );
        let secs = t.elapsed().as_secs_f64();
        match r {
            Ok(s) => println!(
                "{name} n={} {:?} t={secs:.2}s (build {:.1}) products={} res={:.1e} modes={} last={:.12} {:?} ev={:?}",
                w.n_nodes(),
                s.solver,
                build.as_secs_f64(),
                s.products,
                s.residuals.iter().fold(0.0f64, |a, &b| a.max(b)),
                s.eigenvalues.len(),
                s.eigenvalues[s.eigenvalues.len() - 1],
                s.verification,
                s.eigenspaces.iter().map(|e| e.len()).take(20).collect::<Vec<_>>()
            ),
            Err(e) => println!("{name} {solver:?} t={secs:.2}s {e}"),
        }
    }
    let hwm = std::fs::read_to_string("/proc/self/status").unwrap();
    println!("{}", hwm.lines().find(|l| l.starts_with("VmHWM")).unwrap());
}
