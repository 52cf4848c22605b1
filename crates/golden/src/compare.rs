//! Summaries as they lie in folders.

use std::path::Path;

use serde_json::Value;
use user::{Problem, Result, files};

use crate::{Comparison, compare_summaries};

/// Compares the summary of a results folder with that of golden outputs; none without a golden one.
pub fn compare(results: &Path, golden: &Path) -> Result<Option<Comparison>> {
    let Some(expected) = golden_summary(golden)? else { return Ok(None) };
    let obtained = read(&results.join("summary.json"))?;
    Ok(Some(compare_summaries(&expected, &obtained)))
}

/// The summary of golden outputs; none where there are none.
pub fn golden_summary(golden: &Path) -> Result<Option<Value>> {
    let path = golden.join("summary.json");
    path.exists().then(|| read(&path)).transpose()
}

fn read(path: &Path) -> Result<Value> {
    let text = files::open(path).and_then(std::io::read_to_string).map_err(|error| {
        Problem::from_error("cannot be read", error).in_file(path).hint("`eigensync run` writes it")
    })?;
    serde_json::from_str(&text)
        .map_err(|error| Problem::from_error("is not JSON", error).in_file(path))
}
