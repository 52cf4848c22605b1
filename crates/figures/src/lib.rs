//! Figures: panels with letters in a grid, as SVG text, and PNG and PDF bytes, from plain data.
//!
//! Nothing here opens a file or knows what the data mean. One file a kind of panel: `lines`
//! (with `series`, `axis`, `markers` and `legend`; `msf` and `components` fill it), `network` (with
//! `links`, `placement` and `stress`), `heat_map` (with `colour_map`), `positions`, `cascade`, `multiples`; a new kind is
//! one more file, a `Drawable`, and its line in `content`. They draw through `canvas`, which writes SVG in points,
//! with text as text in a list of faces of equal widths (`font`); `raster` makes the PNG of it, `pdf` the PDF.
//! `layouts` sets panels side by side as the paper's figures do.

mod axis;
mod canvas;
mod cascade;
mod cascade_error;
mod circle;
mod colour_map;
mod components;
mod content;
mod drawable;
mod error;
mod figure;
mod font;
mod groups;
mod heat_map;
mod label;
mod layouts;
mod legend;
mod lines;
mod links;
mod markers;
mod msf;
mod multiples;
mod network;
mod numbers;
mod pdf;
mod placement;
mod positions;
mod raster;
mod reader;
mod series;
mod stress;
mod style;
mod title;

pub use axis::Scale;
pub use cascade::{CascadeCluster, CascadePanel, CascadeState};
pub use cascade_error::CascadeError;
pub use components::{Mode, components_panel};
pub use content::Content;
pub use error::FigureError;
pub use figure::{Drawn, Figure, Panel};
pub use groups::Group;
pub use heat_map::HeatMapPanel;
pub use label::Label;
pub use layouts::{Comparison, pairs_figure};
pub use lines::{LinePanel, Shade, Tone};
pub use links::Link;
pub use markers::{Marker, MarkerGroup, MarkerStyle};
pub use msf::{MsfCurve, msf_panel};
pub use multiples::{Multiple, MultiplesPanel};
pub use network::{NetworkPanel, Node};
pub use numbers::{grouped, told_apart};
pub use pdf::pdf;
pub use placement::Placement;
pub use positions::PositionsPanel;
pub use raster::png;
pub use series::{Series, Spread, SpreadStyle};

#[cfg(test)]
mod tests;
