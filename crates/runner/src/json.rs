//! Summaries as text: a key a line, a cluster a line, so that what differs between two of them can be
//! read.

use serde_json::Value;

/// Numbers of a list that stand in one line: a range, a position.
const SHORT: usize = 4;
const INDENT: &str = "  ";

/// A document; it reads back as the same value.
pub fn text(value: &Value) -> String {
    let mut text = String::new();
    write(&mut text, value, 0);
    text
}

fn write(text: &mut String, value: &Value, depth: usize) {
    match value {
        Value::Array(list) if !list.is_empty() && !is_line(list) => {
            let entries = list.iter().map(|entry| (String::new(), entry));
            block(text, ['[', ']'], entries, depth);
        }
        Value::Object(map) if !map.is_empty() => {
            let entry = |(key, value)| (format!("{}: ", Value::String(String::clone(key))), value);
            block(text, ['{', '}'], map.iter().map(entry), depth);
        }
        Value::Array(list) => {
            let entries: Vec<String> = list.iter().map(Value::to_string).collect();
            text.push_str(&format!("[{}]", entries.join(", ")));
        }
        other => text.push_str(&other.to_string()),
    }
}

/// Whether a list stands in one line: labels of a cluster do, however many, and a few numbers.
fn is_line(list: &[Value]) -> bool {
    let is_short = list.len() <= SHORT && !list.iter().any(|v| v.is_array() || v.is_object());
    is_short || list.iter().all(Value::is_string)
}

fn block<'a>(
    text: &mut String,
    [open, close]: [char; 2],
    entries: impl Iterator<Item = (String, &'a Value)>,
    depth: usize,
) {
    text.push(open);
    for (at, (key, value)) in entries.enumerate() {
        text.push_str(if at == 0 { "\n" } else { ",\n" });
        text.push_str(&INDENT.repeat(depth + 1));
        text.push_str(&key);
        write(text, value, depth + 1);
    }
    text.push('\n');
    text.push_str(&INDENT.repeat(depth));
    text.push(close);
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_cluster_is_a_line_and_an_eigenvalue_is_a_line() {
        let value = json!({
            "epsilon": [1.0, null],
            "clusters": [["1", "2"], ["3", "\"\n"]],
            "eigenvalues": [0.0, -1.5, -2.0, -3.0, -1e-300],
            "empty": [{}, []],
        });
        let expected = r#"{
  "epsilon": [1.0, null],
  "clusters": [
    ["1", "2"],
    ["3", "\"\n"]
  ],
  "eigenvalues": [
    0.0,
    -1.5,
    -2.0,
    -3.0,
    -1e-300
  ],
  "empty": [
    {},
    []
  ]
}"#;
        assert_eq!(text(&value), expected);
        assert_eq!(serde_json::from_str::<Value>(expected).unwrap(), value);
    }
}
