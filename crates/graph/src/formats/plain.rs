//! The commonest line of a large file: two whole numbers and perhaps one value more, in plain ASCII.
//!
//! Readers try this first and leave every other line, and whatever is wrong in one, to the code that
//! knows the format and its errors: nothing is accepted here that would not be accepted there.

/// Digits of a number that surely fits 64 bits.
const MAX_DIGITS: usize = 18;

/// Two whole numbers and what follows them.
pub(crate) struct Plain<'a> {
    pub(crate) first: u64,
    pub(crate) second: u64,
    /// The value after them, without blanks around it.
    pub(crate) value: Option<&'a str>,
}

/// The parts of a line of two whole numbers without superfluous zeros and at most one value more,
/// separated by blanks and tabs and, where the format has them, single commas.
pub(crate) fn plain(text: &str, commas: bool) -> Option<Plain<'_>> {
    let bytes = text.as_bytes();
    let (first, end) = whole_number(bytes, skip_blanks(bytes, 0))?;
    let start = separator(bytes, end, commas)?;
    let (second, end) = whole_number(bytes, start)?;
    if skip_blanks(bytes, end) == bytes.len() {
        return Some(Plain { first, second, value: None });
    }
    let start = separator(bytes, end, commas)?;
    let end = start + bytes[start..].iter().take_while(|&&byte| is_of_number(byte)).count();
    let is_last = end > start && skip_blanks(bytes, end) == bytes.len();
    is_last.then(|| Plain { first, second, value: Some(&text[start..end]) })
}

/// A number, and where it ends.
fn whole_number(bytes: &[u8], start: usize) -> Option<(u64, usize)> {
    let mut number = 0;
    let mut end = start;
    while let Some(digit) = bytes.get(end).filter(|byte| byte.is_ascii_digit()) {
        if end - start == MAX_DIGITS {
            return None;
        }
        number = 10 * number + u64::from(digit - b'0');
        end += 1;
    }
    let has_zeros = bytes.get(start) == Some(&b'0') && end - start > 1;
    (end > start && !has_zeros).then_some((number, end))
}

/// Where the value behind a separator begins; none where there is no separator.
fn separator(bytes: &[u8], start: usize, commas: bool) -> Option<usize> {
    let mut end = skip_blanks(bytes, start);
    if commas && bytes.get(end) == Some(&b',') {
        end = skip_blanks(bytes, end + 1);
    }
    (end > start).then_some(end)
}

fn skip_blanks(bytes: &[u8], start: usize) -> usize {
    start + bytes[start..].iter().take_while(|&&byte| byte == b' ' || byte == b'\t').count()
}

fn is_of_number(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'+' | b'-')
}

#[cfg(test)]
mod tests {
    use super::plain;

    fn parts(text: &str, commas: bool) -> Option<(u64, u64, Option<&str>)> {
        plain(text, commas).map(|plain| (plain.first, plain.second, plain.value))
    }

    #[test]
    fn two_numbers_and_a_value_are_taken_apart() {
        assert_eq!(parts("1 2", false), Some((1, 2, None)));
        assert_eq!(parts(" 10\t0 -1.5e-3 ", false), Some((10, 0, Some("-1.5e-3"))));
        assert_eq!(parts("1,2 , 3", true), Some((1, 2, Some("3"))));
    }

    #[test]
    fn every_other_line_is_left_to_the_format() {
        for line in ["", "1", "1 ", "01 2", "1 2 3 4", "a 2", "1 2 #", "1,,2", "1 2,", "1\u{a0}2"] {
            assert_eq!(parts(line, true), None, "{line}");
        }
        assert_eq!(parts("1,2", false), None);
        assert_eq!(parts("1234567890123456789 2", false), None);
    }
}
