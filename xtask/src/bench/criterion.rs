//! What criterion leaves behind, in `NAME/new/` of its folder: `benchmark.json` (identity and
//! throughput), `estimates.json` (mean and its standard error) and `sample.json` (each sample).

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::Value;

use super::read as read_file;

/// A benchmark and its times, in seconds an iteration.
#[derive(Clone, Debug, PartialEq)]
pub struct Benchmark {
    /// Operation, fixture and size, parted by slashes.
    pub id: String,
    pub mean: f64,
    pub standard_error: f64,
    /// The shortest of the samples.
    pub best: f64,
    /// How much one iteration does, and of what: elements or bytes.
    pub throughput: Option<(f64, String)>,
}

impl Benchmark {
    /// Elements a second in the best sample.
    pub fn best_rate(&self) -> Result<f64, String> {
        match &self.throughput {
            Some((elements, unit)) if unit == "Elements" => Ok(elements / self.best),
            _ => Err(format!("the benchmark `{}` does not say how many elements it does", self.id)),
        }
    }
}

/// A program that runs benchmarks.
pub struct Program {
    pub name: String,
    pub executable: PathBuf,
    /// Folder of its package, in which cargo would run it.
    pub package: PathBuf,
}

/// The programs of benchmarks that cargo says it has built, from its messages (one JSON a line).
pub fn programs(messages: &str) -> Vec<Program> {
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let benchmark = |message: Value| {
        let is_benchmark = message["reason"] == "compiler-artifact"
            && message["target"]["kind"].as_array()?.iter().any(|kind| kind == "bench");
        is_benchmark.then_some(())?;
        Some(Program {
            name: message["target"]["name"].as_str()?.to_owned(),
            executable: message["executable"].as_str()?.into(),
            package: Path::new(message["manifest_path"].as_str()?).parent()?.to_owned(),
        })
    };
    messages.filter_map(benchmark).collect()
}

/// All benchmarks in criterion's folder, by name.
pub fn read(home: &Path) -> Result<Vec<Benchmark>, String> {
    let mut benchmarks = Vec::new();
    let mut folders = vec![home.to_owned()];
    while let Some(folder) = folders.pop() {
        let entries = fs::read_dir(&folder)
            .map_err(|error| format!("{} cannot be read: {error}", folder.display()))?;
        folders.extend(entries.flatten().map(|entry| entry.path()).filter(|path| path.is_dir()));
        if folder.ends_with("new") && folder.join("benchmark.json").exists() {
            let text = |name| read_file(&folder.join(name));
            let [identity, estimates, samples] =
                [text("benchmark.json")?, text("estimates.json")?, text("sample.json")?];
            let benchmark = parse(&identity, &estimates, &samples)
                .map_err(|error| format!("{} is not understood: {error}", folder.display()))?;
            benchmarks.push(benchmark);
        }
    }
    benchmarks.sort_by(|a, b| a.id.cmp(&b.id));
    Ok(benchmarks)
}

fn parse(identity: &str, estimates: &str, samples: &str) -> Result<Benchmark, serde_json::Error> {
    const NANOSECOND: f64 = 1e-9;
    let identity: Identity = serde_json::from_str(identity)?;
    let Estimates { mean } = serde_json::from_str(estimates)?;
    let samples: Samples = serde_json::from_str(samples)?;
    let times = samples.times.iter().zip(&samples.iters).map(|(time, iters)| time / iters);
    let throughput = identity.throughput.into_iter().flatten().next();
    Ok(Benchmark {
        id: identity.full_id,
        mean: mean.point_estimate * NANOSECOND,
        standard_error: mean.standard_error * NANOSECOND,
        best: times.fold(f64::INFINITY, f64::min) * NANOSECOND,
        throughput: throughput.map(|(unit, amount)| (amount, unit)),
    })
}

#[derive(Deserialize)]
struct Identity {
    full_id: String,
    /// One entry: the unit with the amount.
    throughput: Option<std::collections::BTreeMap<String, f64>>,
}

#[derive(Deserialize)]
struct Estimates {
    mean: Estimate,
}

#[derive(Deserialize)]
struct Estimate {
    point_estimate: f64,
    standard_error: f64,
}

/// Samples of a benchmark: so many iterations took so many nanoseconds.
#[derive(Deserialize)]
struct Samples {
    iters: Vec<f64>,
    times: Vec<f64>,
}

/// Every benchmark, a line each; the last two columns are empty without a throughput.
pub fn to_csv(benchmarks: &[Benchmark]) -> String {
    let mut csv = String::from("benchmark,mean_s,standard_error_s,best_s,per_s,unit\n");
    for benchmark in benchmarks {
        let Benchmark { id, mean, standard_error, best, throughput } = benchmark;
        let (rate, unit) = match throughput {
            Some((amount, unit)) => (format!("{:.4e}", amount / mean), unit.as_str()),
            None => Default::default(),
        };
        writeln!(csv, "{id},{mean:.6e},{standard_error:.1e},{best:.6e},{rate},{unit}")
            .expect("a string can always grow");
    }
    csv
}

/// What [`to_csv`] wrote, without throughputs.
pub fn from_csv(text: &str) -> Result<Vec<Benchmark>, String> {
    let benchmark = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let seconds = |field: usize| fields.get(field)?.parse().ok();
        Some(Benchmark {
            id: fields[0].to_owned(),
            mean: seconds(1)?,
            standard_error: seconds(2)?,
            best: seconds(3)?,
            throughput: None,
        })
    };
    let read = |line| benchmark(line).ok_or_else(|| format!("all.csv: no benchmark: {line}"));
    text.lines().skip(1).map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const IDENTITY: &str = r#"{"group_id":"simulate","function_id":"communities90",
        "value_str":"16","throughput":{"Elements":1440},"full_id":"simulate/communities90/16",
        "directory_name":"simulate/communities90/16","title":"simulate/communities90/16"}"#;
    const ESTIMATES: &str = r#"{"mean":{"confidence_interval":{"confidence_level":0.95,
        "lower_bound":1.0,"upper_bound":3.0},"point_estimate":2000.0,"standard_error":10.0},
        "slope":null}"#;
    const SAMPLES: &str = r#"{"sampling_mode":"Linear","iters":[1.0,2.0],"times":[2500.0,3000.0]}"#;

    #[test]
    fn a_benchmark_is_read_in_seconds_with_its_rate() {
        let benchmark = parse(IDENTITY, ESTIMATES, SAMPLES).unwrap();
        assert_eq!(benchmark.id, "simulate/communities90/16");
        assert_eq!((benchmark.mean, benchmark.standard_error), (2000.0 * 1e-9, 10.0 * 1e-9));
        let rate = benchmark.best_rate().unwrap();
        assert!((rate / 0.96e9 - 1.0).abs() < 1e-12, "1440 in 1500 ns is not {rate} a second");
    }

    #[test]
    fn a_benchmark_without_throughput_has_times_but_no_rate() {
        let identity = r#"{"full_id":"msf/hindmarsh_rose/121","throughput":null}"#;
        let benchmark = parse(identity, ESTIMATES, SAMPLES).unwrap();
        assert!(benchmark.best_rate().is_err());
        let csv = to_csv(std::slice::from_ref(&benchmark));
        let [read] = &from_csv(&csv).unwrap()[..] else { panic!("one line, one benchmark") };
        assert_eq!(read.id, benchmark.id);
        assert!((read.best / benchmark.best - 1.0).abs() < 1e-12, "{} s", read.best);
        assert_eq!(
            csv.lines().nth(1),
            Some("msf/hindmarsh_rose/121,2.000000e-6,1.0e-8,1.500000e-6,,")
        );
    }

    #[test]
    fn only_benchmarks_among_the_messages_of_cargo_are_run() {
        let messages = r#"{"reason":"compiler-artifact","manifest_path":"/w/a/Cargo.toml","target":{"kind":["lib"],"name":"a"},"executable":null}
not a message
{"reason":"compiler-artifact","manifest_path":"/w/a/Cargo.toml","target":{"kind":["bench"],"name":"speed"},"executable":"/w/target/speed-1"}
{"reason":"build-finished","success":true}"#;
        let programs = programs(messages);
        assert_eq!(programs.len(), 1);
        assert_eq!(programs[0].name, "speed");
        assert_eq!(programs[0].package, Path::new("/w/a"));
    }
}
