//! The table of claims, and numbers as people read them.

use eigensync::numbers::{four_digits, two_digits};
use eigensync::{Agreement, End, Known};
use std::time::Duration;

use comfy_table::presets::UTF8_BORDERS_ONLY;
use comfy_table::{ContentArrangement, Table};
use indexmap::IndexSet;
use serde_json::Value;

use crate::claims::Claim;
use crate::output::one_line;

/// Lists with more entries are abridged.
const LONG_LIST: usize = 8;
/// Width of the table where there is no terminal that says how wide it is.
const WIDTH: u16 = 170;

/// claim | paper | obtained | tolerance | verdict, a table for each experiment under its name.
pub fn claims<'a>(of: impl IntoIterator<Item = (&'a str, &'a [Claim])>) -> String {
    let tables = of.into_iter().map(|(id, claims)| format!("{id}\n{}\n", table(claims)));
    tables.collect::<Vec<_>>().join("\n")
}

fn table(claims: &[Claim]) -> String {
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    if !table.is_tty() {
        table.set_width(WIDTH);
    }
    table.set_header(["claim", "paper", "obtained", "tolerance", "verdict"]);
    for claim in claims {
        let [paper, mut obtained] = [&claim.paper, &claim.obtained].map(readable);
        if let Some(uncertainty) = claim.uncertainty {
            obtained.push_str(&format!(" ± {}", two_digits(uncertainty)));
        }
        if let Some(runs) = claim.runs {
            obtained.push_str(&format!(", {runs}"));
        }
        if claim.refined == Some(false) {
            obtained.push_str(", not as good as asked");
        }
        let name = one_line(&claim.name).replace('_', " ");
        table.add_row([name, paper, obtained, claim.tolerance.clone(), claim.verdict.to_string()]);
    }
    table.to_string()
}

/// How prediction and simulation agree at each ε of the experiments that compare matrices.
pub fn agreement<'a>(
    of: impl IntoIterator<Item = (&'a str, f64, &'a Agreement)>,
) -> Option<String> {
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_header([
        "experiment",
        "ε",
        "linear correlation",
        "rank correlation",
        "adjusted Rand index",
        "regions alike",
    ]);
    let shown = |value: Option<f64>| value.map_or_else(|| "none".into(), |x| format!("{x:.3}"));
    let mut is_empty = true;
    for (id, epsilon, agreement) in of {
        is_empty = false;
        let regions = agreement.regions.as_ref().map(|regions| {
            let alike = regions.agreement;
            format!("{} of {}", alike.n_same_verdict, alike.n_regions)
        });
        table.add_row([
            id.to_owned(),
            four_digits(epsilon),
            shown(agreement.correlation.map(|correlation| correlation.pearson)),
            shown(agreement.correlation.map(|correlation| correlation.spearman)),
            shown(agreement.rand_index),
            regions.unwrap_or_default(),
        ]);
    }
    (!is_empty).then(|| table.to_string())
}

/// A predicted state beside what the sweep shows of it.
pub struct StateRow {
    pub id: String,
    /// The predicted range of ε, without upper end where it has none.
    pub predicted: (f64, Option<f64>),
    /// Ends of the range in which its clusters were seen.
    pub seen: [End; 2],
    /// Runs of the sweep in the predicted range, and how many of them escaped.
    pub runs: [usize; 2],
}

/// Where predicted states were seen in simulation, of so many experiments.
pub fn states(of: &[StateRow]) -> Option<String> {
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_header(["experiment", "predicted for ε", "seen from", "to", "runs that escaped"]);
    for row in of {
        let predicted = match row.predicted {
            (from, Some(to)) => format!("{} to {}", four_digits(from), four_digits(to)),
            (from, None) => format!("above {}", four_digits(from)),
        };
        let [from, to] = row.seen.each_ref().map(end);
        let escaped = match row.runs {
            [0, _] => String::new(),
            [runs, escaped] => format!("{escaped} of {runs}"),
        };
        table.add_row([row.id.clone(), predicted, from, to, escaped]);
    }
    (!of.is_empty()).then(|| table.to_string())
}

/// An end of a range as far as it is known.
fn end(end: &End) -> String {
    let limit = || end.limit.map_or_else(String::new, four_digits);
    let text = match end.bound {
        Known::Measured => {
            let mean = end.mean.map_or_else(String::new, four_digits);
            let error = end.uncertainty().map_or_else(String::new, two_digits);
            format!("{mean} ± {error}")
        }
        Known::AtMost => format!("at most {}", limit()),
        Known::AtLeast => format!("at least {}", limit()),
        Known::Groups => end.groups.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "),
        Known::Unseen => match end.of_seeds.iter().flatten().count() {
            0 => "not seen".into(),
            seen => format!("not seen in every seed, measured in {seen} of {}", end.of_seeds.len()),
        },
        Known::Escaped => "escaped".into(),
        Known::NotSwept => "not swept".into(),
    };
    match end.n_escaped {
        0 => text,
        _ if end.bound == Known::Escaped => text,
        escaped => format!("{text}, where {escaped} of {} escaped", end.of_seeds.len()),
    }
}

/// The time that an experiment took.
pub struct Times {
    pub id: String,
    pub stages: Vec<(String, Duration)>,
    pub all: Duration,
}

/// Where the time of each experiment went: its stages, and all of it.
pub fn times(of: &[Times]) -> String {
    let stages: IndexSet<&str> =
        of.iter().flat_map(|times| times.stages.iter().map(|(name, _)| name.as_str())).collect();
    let seconds = |time: Duration| format!("{:.1} s", time.as_secs_f64());
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_header(["experiment"].into_iter().chain(stages.iter().copied()).chain(["in all"]));
    for Times { id, stages: took, all } in of {
        let time = |stage: &&str| {
            let found = took.iter().find(|(name, _)| name == stage);
            found.map_or_else(String::new, |(_, time)| seconds(*time))
        };
        let times = stages.iter().map(time);
        table.add_row([id.clone()].into_iter().chain(times).chain([seconds(*all)]));
    }
    table.to_string()
}

/// A value with numbers of four significant digits and clusters in braces.
pub fn readable(value: &Value) -> String {
    match value {
        Value::Null => "none".into(),
        Value::String(text) => one_line(text).into_owned(),
        Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), four_digits),
        Value::Array(list) if list.iter().all(Value::is_array) && !list.is_empty() => {
            let inner = list.iter().filter_map(Value::as_array);
            let inner = inner.map(|list| format!("{{{}}}", joined(list, ",")));
            inner.collect::<Vec<_>>().join(" ")
        }
        Value::Array(list) if list.is_empty() => "none".into(),
        Value::Array(list) => joined(list, ", "),
        other => other.to_string(),
    }
}

/// The entries of a list, those in the middle of a long one left out.
fn joined(list: &[Value], separator: &str) -> String {
    let mut entries: Vec<String> = list.iter().map(readable).collect();
    if entries.len() > LONG_LIST {
        entries.splice(LONG_LIST / 2..entries.len() - LONG_LIST / 2, ["…".into()]);
    }
    entries.join(separator)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn values_read_as_people_write_them() {
        assert_eq!(readable(&json!(8.170_123)), "8.17");
        assert_eq!(readable(&json!([-0.0, -2.0, -14.034_567])), "0, -2, -14.03");
        assert_eq!(readable(&json!([["1", "2"], ["3", "4"]])), "{1,2} {3,4}");
        assert_eq!(readable(&json!([])), "none");
        assert_eq!(readable(&json!(17865.0)), "17865");
        assert_eq!([four_digits(1e300), two_digits(1.23e300)], ["1e300", "1.2e300"]);
    }
}
