//! The table of claims, and numbers as people read them.

use comfy_table::presets::UTF8_BORDERS_ONLY;
use comfy_table::{ContentArrangement, Table};
use eigensync::Agreement;
use eigensync::numbers::{four_digits, two_digits};
use serde_json::Value;

use claims::Judged;
use user::text::one_line;

/// Lists with more entries are abridged.
const LONG_LIST: usize = 8;
/// Width of tables in files, which no terminal says.
const WIDTH: u16 = 170;

/// claim | paper | obtained | tolerance | verdict.
pub fn claims(claims: &[Judged]) -> String {
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_width(WIDTH);
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
        let name = claim.sentence();
        table.add_row([name, paper, obtained, claim.tolerance.clone(), claim.verdict.to_string()]);
    }
    table.to_string()
}

/// How prediction and simulation agree at each ε.
pub fn agreement<'a>(of: impl IntoIterator<Item = (f64, &'a Agreement)>) -> Option<String> {
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_width(WIDTH);
    table.set_header([
        "ε",
        "linear correlation",
        "rank correlation",
        "adjusted Rand index",
        "regions alike",
    ]);
    let shown = |value: Option<f64>| value.map_or_else(|| "none".into(), |x| format!("{x:.3}"));
    let mut is_empty = true;
    for (epsilon, agreement) in of {
        is_empty = false;
        let regions = agreement.regions.as_ref().map(|regions| {
            let alike = regions.agreement;
            format!("{} of {}", alike.n_same_verdict, alike.n_regions)
        });
        table.add_row([
            four_digits(epsilon),
            shown(agreement.correlation.map(|correlation| correlation.pearson)),
            shown(agreement.correlation.map(|correlation| correlation.spearman)),
            shown(agreement.rand_index),
            regions.unwrap_or_default(),
        ]);
    }
    (!is_empty).then(|| table.to_string())
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
