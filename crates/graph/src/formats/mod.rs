//! Readers of network formats, one file a format, each from any [`std::io::Read`].

pub mod edge_list;
mod fields;
mod text;

pub use text::{MAX_LINE_BYTES, TextError};
