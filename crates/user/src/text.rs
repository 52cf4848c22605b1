//! Texts as people can read them: names, labels and titles come from files and may hold anything.

use std::borrow::Cow;
use std::path::Path;

/// Longest line that is printed, in characters: beyond it nobody reads.
pub const MOST_CHARS: usize = 2000;
/// Longest word of a message, in characters, and how much is left of a longer one.
const LONGEST_WORD: usize = 300;
const OF_LONG_WORD: usize = 100;
/// Most lines of a message.
const MOST_LINES: usize = 60;

/// A text whose commands to the terminal are written out: names and titles come from files, and a
/// terminal obeys what it is sent.
pub fn printable(text: &str) -> Cow<'_, str> {
    let obeyed = |c: char| is_command(c) && c != '\n' && c != '\t';
    if !text.contains(obeyed) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        if obeyed(c) {
            safe.extend(c.escape_unicode());
        } else {
            safe.push(c);
        }
    }
    Cow::Owned(safe)
}

/// A text in one line: names of files, labels and titles may have line breaks, after which the rest
/// would read as something that we say.
pub fn one_line(text: &str) -> Cow<'_, str> {
    if !text.contains(is_command) {
        return Cow::Borrowed(text);
    }
    let written_out = |c: char| match is_command(c) {
        true => c.escape_default().to_string(),
        false => c.to_string(),
    };
    Cow::Owned(text.chars().map(written_out).collect())
}

/// A path in one line.
pub fn shown(path: impl AsRef<Path>) -> String {
    one_line(&path.as_ref().display().to_string()).into_owned()
}

/// Whether a character is not shown but obeyed: control characters, and those that turn the direction
/// of the text after them, so that it reads as something else (Unicode Standard Annex 9).
pub fn is_command(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let breaks = matches!(c, '\u{2028}' | '\u{2029}');
    c.is_control() || turns || breaks
}

/// A message of a length that is read: names come from files and may have megabytes.
pub fn readable(text: &str) -> String {
    let mut lines: Vec<String> = text.split('\n').take(MOST_LINES).map(readable_line).collect();
    if text.split('\n').nth(MOST_LINES).is_some() {
        lines.push("…".into());
    }
    lines.join("\n")
}

fn readable_line(line: &str) -> String {
    let mut short = String::new();
    for word in line.split_inclusive(' ') {
        match word.char_indices().nth(LONGEST_WORD) {
            Some(_) => short.push_str(&format!("{}… ", start(word, OF_LONG_WORD))),
            None => short.push_str(word),
        }
    }
    cut(short.trim_end_matches(' '), MOST_CHARS).into_owned()
}

/// The first so many characters of a line.
pub fn cut(line: &str, most: usize) -> Cow<'_, str> {
    match line.char_indices().nth(most) {
        Some(_) => Cow::Owned(format!("{}…", start(line, most))),
        None => Cow::Borrowed(line),
    }
}

/// The first characters of a text.
fn start(text: &str, n_chars: usize) -> &str {
    text.char_indices().nth(n_chars).map_or(text, |(end, _)| &text[..end])
}

/// The shortest text that reads back as the same number.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_written_out() {
        assert_eq!(printable("ε\tx\n"), "ε\tx\n");
        assert_eq!(printable("\u{1b}[2J\u{9b}1m\r"), "\\u{1b}[2J\\u{9b}1m\\u{d}");
        assert_eq!(printable("a\u{202e}b\u{2066}"), "a\\u{202e}b\\u{2066}");
    }

    #[test]
    fn names_with_line_breaks_are_shown_in_one_line() {
        assert_eq!(one_line("ε b"), "ε b");
        assert_eq!(one_line("a\nerror: b\t\u{1b}[2J"), "a\\nerror: b\\t\\u{1b}[2J");
        assert_eq!(shown(Path::new("a\r\nb")), "a\\r\\nb");
    }

    #[test]
    fn messages_of_megabytes_are_cut_and_keep_their_hints() {
        let text = readable(&format!("key `{}` is bad\nhint: none", "k".repeat(1_000_000)));
        assert!(text.starts_with("key `kkk") && text.ends_with("… is bad\nhint: none"), "{text}");
        assert!(text.len() < 200);
        assert!(readable(&"word ".repeat(100_000)).len() < 2100);
        assert_eq!(readable(&"line\n".repeat(100_000)).lines().count(), MOST_LINES + 1);
    }
}
