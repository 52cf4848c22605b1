//! What is said on standard output and standard error. A reader that has gone, as by
//! `eigensync list | head -1`, is no error; a disk that is full is one, and the exit status tells it.

use std::borrow::Cow;
use std::fmt::Arguments;
use std::io::{ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// `println!` that neither panics nor lets control characters through.
macro_rules! say {
    ($($text:tt)*) => { $crate::output::line(format_args!($($text)*)) };
}
pub(crate) use say;

/// `eprintln!` that neither panics nor lets control characters through.
macro_rules! tell {
    ($($text:tt)*) => { $crate::output::note(format_args!($($text)*)) };
}
pub(crate) use tell;

/// Whether something could not be said on standard output to a reader who is still there.
static LOST: AtomicBool = AtomicBool::new(false);

/// Prints a line on standard output.
pub fn line(text: Arguments<'_>) {
    let text = text.to_string();
    keep_track(writeln!(std::io::stdout(), "{}", printable(&text)));
}

/// Prints a line on standard error; there is nobody to tell if that fails.
pub fn note(text: Arguments<'_>) {
    let text = text.to_string();
    let _ = writeln!(std::io::stderr(), "{}", printable(&text));
}

/// Whether all that was said on standard output has arrived, or its reader has gone.
pub fn arrived() -> bool {
    keep_track(std::io::stdout().flush());
    !LOST.load(Ordering::Relaxed)
}

fn keep_track(result: std::io::Result<()>) {
    if result.is_err_and(|error| error.kind() != ErrorKind::BrokenPipe) {
        LOST.store(true, Ordering::Relaxed);
    }
}

/// A text whose control characters, but for ends of lines and tabs, are written out: names and titles
/// come from files, and a terminal obeys what it is sent.
pub fn printable(text: &str) -> Cow<'_, str> {
    let obeyed = |c: char| c.is_control() && c != '\n' && c != '\t';
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_written_out() {
        assert_eq!(printable("ε\tx\n"), "ε\tx\n");
        assert_eq!(printable("\u{1b}[2J\u{9b}1m\r"), "\\u{1b}[2J\\u{9b}1m\\u{d}");
    }
}
