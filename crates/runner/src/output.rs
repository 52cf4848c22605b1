//! Standard output that may be closed before all is said, as by `eigensync list | head -1`.

use std::fmt::Arguments;
use std::io::Write;

/// `println!` for which a reader that has gone is no error.
macro_rules! say {
    ($($text:tt)*) => { $crate::output::line(format_args!($($text)*)) };
}
pub(crate) use say;

/// Prints a line.
pub fn line(text: Arguments<'_>) {
    let _ = writeln!(std::io::stdout(), "{text}");
}
