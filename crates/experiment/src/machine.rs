//! The memory that the machine has for us.

use std::fs::read_to_string;

/// Memory that could be taken now, in bytes: what the system counts as available or, where it is less,
/// what the limit of our control group leaves. None where the system does not say.
pub fn available_memory() -> Option<u64> {
    let meminfo = read_to_string("/proc/meminfo").ok()?;
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let available = 1024 * line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?;
    Some(group_limit().map_or(available, |limit| available.min(limit)))
}

/// What the limit of the control group leaves, in both versions of Linux' control groups.
fn group_limit() -> Option<u64> {
    let number = |path: &str| read_to_string(path).ok()?.trim().parse::<u64>().ok();
    let left = |limit: &str, used: &str| Some(number(limit)?.saturating_sub(number(used)?));
    let folder = "/sys/fs/cgroup";
    let second = || left(&format!("{folder}/memory.max"), &format!("{folder}/memory.current"));
    let first = || {
        let file = |name: &str| format!("{folder}/memory/memory.{name}_in_bytes");
        left(&file("limit"), &file("usage"))
    };
    second().or_else(first)
}
