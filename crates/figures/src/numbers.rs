//! Numbers as labels, with as many digits as they need to be told from their neighbours.

use super::label::Label;

/// Values to three significant digits, or as many more, up to nine, as tell neighbours apart.
pub fn told_apart(values: &[f64]) -> Vec<Label> {
    let label = |k: usize| {
        let neighbours = [k.checked_sub(1), Some(k + 1)];
        let neighbours: Vec<f64> =
            neighbours.into_iter().flatten().filter_map(|j| values.get(j).copied()).collect();
        let differs = |digits: &usize| {
            neighbours.iter().all(|&other| number(other, *digits) != number(values[k], *digits))
        };
        number(values[k], (3..=9).find(differs).unwrap_or(9))
    };
    (0..values.len()).map(label).collect()
}

/// A number to so many significant digits, without zeros at its end.
pub(super) fn number(value: f64, digits: usize) -> Label {
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').expect("this notation has an exponent");
    let exponent: i32 = exponent.parse().expect("an exponent is a whole number");
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text.to_string(),
    };
    if (-3..5).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return Label::text(trimmed(&format!("{value:.decimals$}")));
    }
    let mantissa = trimmed(mantissa);
    let base = if mantissa == "1" { "10".into() } else { format!("{mantissa}×10") };
    Label::text(base).superscript(&exponent.to_string())
}

/// A whole number with a comma before every three digits.
pub fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped_by_thousands() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1,000", "1,234,567"]);
    }

    #[test]
    fn neighbours_differ_and_nothing_has_digits_that_it_does_not_need() {
        let texts = |values: &[f64], expected: &[&str]| {
            assert_eq!(
                told_apart(values),
                expected.iter().copied().map(Label::text).collect::<Vec<_>>()
            );
        };
        texts(&[14174.2, 233.4, 8.0], &["14174", "233", "8"]);
        texts(&[3.7912, 1.08312, 1.08107, 1.0], &["3.79", "1.083", "1.081", "1"]);
    }
}
