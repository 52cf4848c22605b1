//! `machine.json`: on what a run was measured. What a system does not tell is left empty.

use std::fs;
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

use crate::root;

/// The machine, its compilers, and the commit that was measured.
#[derive(Serialize)]
pub struct Machine {
    date: String,
    commit: Option<String>,
    /// Whether files differed from the commit.
    dirty: Option<bool>,
    processor: Option<String>,
    cores: usize,
    /// The core that everything ran on.
    core: u16,
    caches: Vec<String>,
    instruction_sets: Vec<String>,
    system: Option<String>,
    /// Over 1, 5 and 15 minutes, when the run began: should be near 0.
    load_average: Option<String>,
    rustc: Option<String>,
    cpp_compiler: Option<String>,
    python: Option<String>,
}

impl Machine {
    /// This machine, now.
    pub fn here(core: u16) -> Self {
        let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let changes = first_lines("git", &["status", "--porcelain"]);
        Self {
            date: today(),
            commit: first_line("git", &["rev-parse", "HEAD"]),
            dirty: changes.map(|changes| !changes.is_empty()),
            processor: field(&cpuinfo, "model name").map(str::to_owned),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            core,
            caches: caches(),
            instruction_sets: instruction_sets(field(&cpuinfo, "flags").unwrap_or_default()),
            system: first_line("uname", &["-srm"]),
            load_average: fs::read_to_string("/proc/loadavg")
                .ok()
                .map(|load| load.split(' ').take(3).collect::<Vec<_>>().join(" ")),
            rustc: first_line("rustc", &["--version"]),
            cpp_compiler: first_line("c++", &["--version"]),
            python: first_line("python3", &["--version"]),
        }
    }

    /// Programs that wanted a core over the last minute before the run.
    pub fn load(&self) -> Option<f64> {
        self.load_average.as_ref()?.split(' ').next()?.parse().ok()
    }

    /// `DATE-COMMIT`, of a run's folder.
    pub fn folder_name(&self) -> String {
        let commit = self.commit.as_deref().unwrap_or("nocommit");
        format!("{}-{}", self.date, &commit[..commit.len().min(8)])
    }
}

/// The value of the first `name : value`.
fn field<'a>(cpuinfo: &'a str, name: &str) -> Option<&'a str> {
    cpuinfo
        .lines()
        .filter_map(|line| line.split_once(':'))
        .find(|(key, _)| key.trim() == name)
        .map(|(_, value)| value.trim())
}

/// Of all that a processor can do, what bears on floating-point loops.
fn instruction_sets(flags: &str) -> Vec<String> {
    let bears =
        |flag: &str| ["sse2", "avx", "avx2", "fma"].contains(&flag) || flag.starts_with("avx512");
    flags.split(' ').filter(|flag| bears(flag)).map(str::to_owned).collect()
}

/// Caches of the first core, such as `L1 Data 32K`.
fn caches() -> Vec<String> {
    let folder = "/sys/devices/system/cpu/cpu0/cache";
    let part = |index: usize, name: &str| {
        let text = fs::read_to_string(format!("{folder}/index{index}/{name}")).ok()?;
        Some(text.trim().to_owned())
    };
    let cache = |index| {
        let (level, kind, size) =
            (part(index, "level")?, part(index, "type")?, part(index, "size")?);
        Some(format!("L{level} {kind} {size}"))
    };
    (0..).map_while(cache).collect()
}

fn first_line(program: &str, args: &[&str]) -> Option<String> {
    first_lines(program, args)?.lines().next().map(str::to_owned)
}

/// What a program says, if it is there and succeeds.
fn first_lines(program: &str, args: &[&str]) -> Option<String> {
    let output = Command::new(program).args(args).current_dir(root()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Today in UTC, as 2023-11-05.
fn today() -> String {
    const SECONDS_PER_DAY: u64 = 86_400;
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    date(now.as_secs() / SECONDS_PER_DAY)
}

/// The Gregorian date so many days after 1970-01-01.
fn date(mut days: u64) -> String {
    let is_leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let mut year = 1970;
    while days >= 365 + u64::from(is_leap(year)) {
        days -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    format!("{year}-{month:02}-{:02}", days + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_follow_the_calendar() {
        assert_eq!(date(0), "1970-01-01");
        assert_eq!(date(59), "1970-03-01");
        assert_eq!(date(11_016), "2000-02-29");
        assert_eq!(date(20_453), "2025-12-31");
        assert_eq!(date(20_454), "2026-01-01");
    }

    #[test]
    fn the_processor_is_read_from_its_first_core() {
        let cpuinfo =
            "processor\t: 0\nmodel name\t: A\nflags\t\t: fpu sse2 avx512f aes\n\nmodel name\t: B\n";
        assert_eq!(field(cpuinfo, "model name"), Some("A"));
        assert_eq!(instruction_sets(field(cpuinfo, "flags").unwrap()), ["sse2", "avx512f"]);
    }
}
