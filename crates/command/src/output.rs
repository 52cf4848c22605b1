//! What is said on standard output and standard error. A reader that has gone, as by
//! `eigensync list | head -1`, is no error; a disk that is full is one, and the exit status tells it.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use user::text::{MOST_CHARS, cut, printable, readable};

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

/// `tell!` for errors, which are said in any case.
macro_rules! complain {
    ($($text:tt)*) => { $crate::output::error(format_args!($($text)*)) };
}
pub(crate) use complain;

/// Whether only errors are wanted on standard error.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Whether something could not be said on standard output to a reader who is still there.
static LOST: AtomicBool = AtomicBool::new(false);

/// Prints a line, or several, on standard output.
pub fn line(text: Arguments<'_>) {
    let text = text.to_string();
    let lines: Vec<_> = text.split('\n').map(|line| cut(line, MOST_CHARS)).collect();
    keep_track(writeln!(std::io::stdout(), "{}", printable(&lines.join("\n"))));
}

/// Prints a document that a program will read, as it is.
pub fn document(text: &str) {
    keep_track(writeln!(std::io::stdout(), "{text}"));
}

/// Prints an error on standard error, also where only these are wanted.
pub fn error(text: Arguments<'_>) {
    let _ = writeln!(std::io::stderr(), "{}", printable(&readable(&text.to_string())));
}

/// Prints a message on standard error, unless only errors are wanted; there is nobody to tell if that fails.
pub fn note(text: Arguments<'_>) {
    if !is_quiet() {
        error(text);
    }
}

/// From now on says only errors on standard error, and shows no progress.
pub fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Whether only errors are wanted on standard error.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Whether all that was said on standard output has arrived, or its reader has gone.
pub fn arrived() -> bool {
    keep_track(std::io::stdout().flush());
    !LOST.load(Ordering::Relaxed)
}

/// Lines and columns of the terminal that standard output is, if it is one that has some.
pub fn terminal_size() -> Option<[u16; 2]> {
    let size = rustix::termios::tcgetwinsize(std::io::stdout()).ok()?;
    (size.ws_row > 0 && size.ws_col > 0).then_some([size.ws_row, size.ws_col])
}

fn keep_track(result: std::io::Result<()>) {
    if result.is_err_and(|error| error.kind() != ErrorKind::BrokenPipe) {
        LOST.store(true, Ordering::Relaxed);
    }
}
