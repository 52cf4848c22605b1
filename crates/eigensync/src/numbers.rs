//! Numbers in words, with as many digits as mean something.

/// Relative errors below this are not said.
pub(crate) const EXACT: f64 = 1e-7;

/// A number as people write it, whatever its size.
pub fn plain(number: f64) -> String {
    let size = number.abs();
    if number == 0.0 || (1e-4..1e7).contains(&size) || !number.is_finite() {
        format!("{number}")
    } else {
        format!("{number:e}")
    }
}

/// A number with four significant digits, counts whole.
pub fn four_digits(number: f64) -> String {
    if number == 0.0 {
        return "0".into();
    }
    if number.abs() < 1e-4 {
        return format!("{number:.1e}");
    }
    // Counts are shown whole.
    if number.fract() == 0.0 && number.abs() < 1e15 {
        return format!("{number}");
    }
    written(format!("{number:.3e}").parse::<f64>().unwrap_or(number))
}

/// A number with three significant digits.
pub fn three_digits(number: f64) -> String {
    let digits = format!("{number:.2e}").parse::<f64>().unwrap_or(number);
    format!("{digits}")
}

/// A number with two significant digits.
pub fn two_digits(number: f64) -> String {
    if number != 0.0 && number.abs() < 1e-5 {
        return format!("{number:.1e}");
    }
    written(format!("{number:.1e}").parse::<f64>().unwrap_or(number))
}

/// A number in full, unless it is so large that nobody would count its zeros.
fn written(number: f64) -> String {
    if number.is_finite() && number.abs() >= 1e15 {
        format!("{number:e}")
    } else {
        format!("{number}")
    }
}

/// A number with six significant digits.
pub fn six_digits(number: f64) -> String {
    written(format!("{number:.5e}").parse::<f64>().unwrap_or(number))
}

/// A number with its standard error; six digits alone where these are beyond doubt.
pub fn with_error(value: f64, error: f64) -> String {
    if error <= EXACT * value.abs() {
        return six_digits(value);
    }
    format!("{} ± {}", four_digits(value), two_digits(error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_that_no_digit_shows_is_not_said() {
        assert_eq!(with_error(1.678_754_3, 2e-11), "1.67875");
        assert_eq!(with_error(8.1723, 0.0123), "8.172 ± 0.012");
    }

    #[test]
    fn numbers_of_any_size_are_short() {
        let numbers = [0.0, -0.01, 2.5, 1e6, 1e300, 1e-300, f64::NAN];
        let texts = ["0", "-0.01", "2.5", "1000000", "1e300", "1e-300", "NaN"];
        assert_eq!(numbers.map(plain), texts);
    }
}
