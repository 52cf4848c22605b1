//! Readers of network formats, one file or folder a format, each from any [`std::io::Read`].
//!
//! A format is its file, with a constant [`Format`] that says all there is to know of it, and its line in
//! [`FORMATS`], from which whoever reads files takes names, endings and readers.

mod archive;
mod binary;
pub mod dense;
pub mod edge_list;
mod format;
pub mod graphml;
mod labels;
pub mod matlab;
mod matrix;
pub mod matrix_market;
pub mod numpy;
mod options;
mod plain;
mod text;
pub mod tvb;

pub use archive::{ArchiveError, MAX_UNPACKED_BYTES};
pub use format::{Choice, Format, ReadError, Source};
pub use matrix::{Layout, MAX_ENTRIES, MAX_SPARE_NODES, MatrixError, Rows};
pub use options::{Attributes, Options};
pub use text::{MAX_LINE_BYTES, TextError};

/// All formats, a line each.
pub const FORMATS: &[&Format] = &[
    &edge_list::FORMAT,
    &matrix_market::FORMAT,
    &graphml::FORMAT,
    &dense::FORMAT,
    &numpy::NPY,
    &numpy::NPZ,
    &matlab::FORMAT,
    &tvb::FORMAT,
];

/// The format of this name, if there is one.
pub fn named(name: &str) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.name == name).copied()
}

/// The format of files whose names end so, in any case and without the point, if there is one.
pub fn of_ending(ending: &str) -> Option<&'static Format> {
    let ending = ending.to_lowercase();
    FORMATS.iter().find(|format| format.endings.contains(&&*ending)).copied()
}
