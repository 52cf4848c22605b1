//! The table of claims, and numbers as people read them.

use comfy_table::presets::UTF8_HORIZONTAL_ONLY;
use comfy_table::{ContentArrangement, Table};
use serde_json::Value;

use crate::claims::Claim;

/// claim | paper | obtained | tolerance | verdict, of several experiments.
pub fn claims<'a>(of: impl IntoIterator<Item = (&'a str, &'a [Claim])>) -> String {
    let mut table = Table::new();
    table.load_style(UTF8_HORIZONTAL_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_header(["experiment", "claim", "paper", "obtained", "tolerance", "verdict"]);
    for (id, claims) in of {
        for claim in claims {
            let name = claim.name.replace('_', " ");
            let [paper, obtained] = [&claim.paper, &claim.obtained].map(readable);
            let verdict = claim.verdict.to_string();
            table.add_row([id.to_owned(), name, paper, obtained, claim.tolerance.clone(), verdict]);
        }
    }
    table.to_string()
}

/// A value with numbers of four significant digits and clusters in braces.
pub fn readable(value: &Value) -> String {
    match value {
        Value::Null => "none".into(),
        Value::String(text) => text.clone(),
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

fn joined(list: &[Value], separator: &str) -> String {
    list.iter().map(readable).collect::<Vec<_>>().join(separator)
}

fn four_digits(number: f64) -> String {
    // A zero eigenvalue is computed as 1e-16 or so.
    if number.abs() < 1e-12 {
        return "0".into();
    }
    let digits = format!("{number:.3e}").parse::<f64>().unwrap_or(number);
    format!("{digits}")
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
    }
}
