//! Which files are read at all: regular ones. Others may never end, or never begin.

use std::fs::File;
use std::io;
use std::path::Path;

/// What is read, in words.
pub const REGULAR: &str = "a regular file";

/// What stands at a path, links followed, in words.
pub fn kind(path: &Path) -> io::Result<&'static str> {
    let kind = std::fs::metadata(path)?.file_type();
    if kind.is_file() {
        return Ok(REGULAR);
    }
    if kind.is_dir() {
        return Ok("a folder");
    }
    Ok(special(kind))
}

#[cfg(unix)]
fn special(kind: std::fs::FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_fifo() {
        "a FIFO"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn special(_: std::fs::FileType) -> &'static str {
    "no file"
}

/// Opens a regular file; asked for its kind first, since opening a FIFO waits for its writer.
pub fn open(path: &Path) -> io::Result<File> {
    match kind(path)? {
        REGULAR => File::open(path),
        other => Err(io::Error::other(format!("it is {other}; expected {REGULAR}"))),
    }
}
