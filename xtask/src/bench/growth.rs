//! How times grow with size: exponents p of t ∝ nᵖ, fitted to benchmarks named operation/fixture/size.
//!
//! Least squares of ln t against ln n, over three sizes or more that span a factor of a hundred.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::criterion::Benchmark;
use super::large::digits;

/// The growth of one operation on one fixture.
#[derive(Debug, PartialEq)]
struct Growth {
    /// Operation and fixture.
    name: String,
    /// Sizes, ascending, with their times in seconds.
    times: Vec<(f64, f64)>,
    exponent: f64,
    standard_error: f64,
}

/// `growth.csv`, none where no operation was timed at enough sizes.
pub fn to_csv(benchmarks: &[Benchmark]) -> Option<String> {
    let mut csv = String::from("benchmark,smallest,largest,exponent,standard_error\n");
    let fitted = fit_all(benchmarks);
    for Growth { name, times, exponent, standard_error } in &fitted {
        let (smallest, largest) = (times[0].0, times[times.len() - 1].0);
        writeln!(csv, "{name},{smallest},{largest},{exponent:.3},{standard_error:.3}")
            .expect("a string can always grow");
    }
    (!fitted.is_empty()).then_some(csv)
}

fn fit_all(benchmarks: &[Benchmark]) -> Vec<Growth> {
    let mut times: BTreeMap<&str, Vec<(f64, f64)>> = BTreeMap::new();
    for benchmark in benchmarks {
        if let Some((name, size)) = benchmark.id.rsplit_once('/')
            && let Ok(size) = size.parse()
        {
            times.entry(name).or_default().push((size, benchmark.best));
        }
    }
    times.into_iter().filter_map(|(name, times)| fit(name, times)).collect()
}

fn fit(name: &str, mut times: Vec<(f64, f64)>) -> Option<Growth> {
    times.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (smallest, largest) = (times.first()?.0, times.last()?.0);
    if times.len() < 3 || largest < 100.0 * smallest {
        return None;
    }
    let logs: Vec<(f64, f64)> = times.iter().map(|(size, time)| (size.ln(), time.ln())).collect();
    let n = logs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n;
    let (x_mean, y_mean) = (mean(|log| log.0), mean(|log| log.1));
    let squares: f64 = logs.iter().map(|(x, _)| (x - x_mean).powi(2)).sum();
    let exponent = logs.iter().map(|(x, y)| (x - x_mean) * (y - y_mean)).sum::<f64>() / squares;
    let residual = |(x, y): &(f64, f64)| (y - y_mean - exponent * (x - x_mean)).powi(2);
    let variance = logs.iter().map(residual).sum::<f64>() / (n - 2.0);
    let standard_error = (variance / squares).sqrt();
    Some(Growth { name: name.to_owned(), times, exponent, standard_error })
}

/// A table with a row for each operation on each fixture: seconds at each size, and the exponent;
/// none where no operation was timed at enough sizes.
pub fn markdown(benchmarks: &[Benchmark]) -> Option<String> {
    let fitted = fit_all(benchmarks);
    if fitted.is_empty() {
        return None;
    }
    let mut sizes: Vec<f64> = fitted.iter().flat_map(|g| g.times.iter().map(|t| t.0)).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    let heads: Vec<String> = sizes.iter().map(|size| format!(" {size:.0e} |")).collect();
    let mut table = format!("| seconds at a size of |{} exponent |\n", heads.concat());
    writeln!(table, "| --- |{} ---: |", " ---: |".repeat(sizes.len()))
        .expect("a string can always grow");
    for Growth { name, times, exponent, standard_error } in fitted {
        let at = |size: &f64| times.iter().find(|(of, _)| of == size).map(|(_, time)| *time);
        let cells: Vec<String> = sizes
            .iter()
            .map(|size| at(size).map_or(" |".into(), |time| format!(" {} |", digits(time))))
            .collect();
        writeln!(table, "| {name} |{} {exponent:.2} ± {standard_error:.2} |", cells.concat())
            .expect("a string can always grow");
    }
    Some(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timed(id: &str, best: f64) -> Benchmark {
        Benchmark { id: id.into(), mean: best, standard_error: 0.0, best, throughput: None }
    }

    #[test]
    fn a_power_law_has_its_exponent_and_no_error() {
        let times =
            [100.0f64, 1000.0, 10_000.0].map(|n| timed(&format!("sum/ring/{n}"), n.powf(1.5)));
        let [growth] = &fit_all(&times)[..] else { panic!("one operation") };
        assert!((growth.exponent - 1.5).abs() < 1e-12 && growth.standard_error < 1e-12);
        assert_eq!(to_csv(&times).unwrap().lines().nth(1), Some("sum/ring,100,10000,1.500,0.000"));
    }

    #[test]
    fn too_few_sizes_or_too_near_ones_have_no_exponent() {
        let few = [timed("sum/ring/100", 1.0), timed("sum/ring/10000", 2.0)];
        let near = ["simulate/a/1", "simulate/a/2", "simulate/a/16"].map(|id| timed(id, 1.0));
        assert_eq!(to_csv(&few), None);
        assert_eq!(to_csv(&near), None);
        assert_eq!(to_csv(&[timed("peak/avx2", 1.0)]), None);
    }
}
