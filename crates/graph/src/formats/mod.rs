//! Readers of network formats, one file a format, each from any [`std::io::Read`].

mod archive;
mod binary;
pub mod dense;
pub mod edge_list;
pub mod graphml;
mod labels;
pub mod matlab;
mod matrix;
pub mod matrix_market;
pub mod numpy;
mod plain;
mod text;
pub mod tvb;

pub use archive::{ArchiveError, MAX_UNPACKED_BYTES};
pub use matrix::{Layout, MAX_ENTRIES, MAX_SPARE_NODES, MatrixError, Rows};
pub use text::{MAX_LINE_BYTES, TextError};
