//! What can be wrong with a figure.

use thiserror::Error;

use super::cascade_error::CascadeError;

/// Why a figure could not be drawn. `panel` is the letter of the panel, as in "(a1)".
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FigureError {
    /// Nothing to draw.
    #[error("the figure has no panels")]
    NoPanels,
    /// A size that is not a positive length.
    #[error("the figure is {width} mm × {height} mm; both must be finite and above zero")]
    BadSize {
        /// Width in mm.
        width: f64,
        /// Height in mm.
        height: f64,
    },
    /// Rows or columns of which one has no positive extent.
    #[error("the shares of rows and columns must be finite and above zero, not {shares:?}")]
    BadShares {
        /// Those of the rows or of the columns.
        shares: Vec<f64>,
    },
    /// A panel outside the grid.
    #[error(
        "panel {panel} covers rows {} to {} and columns {} to {} of a grid of {n_rows} × {n_columns}",
        rows.0, rows.1, columns.0, columns.1
    )]
    OutsideGrid {
        /// Its letter.
        panel: String,
        /// First row and one past the last, from 0.
        rows: (usize, usize),
        /// First column and one past the last, from 0.
        columns: (usize, usize),
        /// Rows of the grid.
        n_rows: usize,
        /// Columns of the grid.
        n_columns: usize,
    },
    /// A page that could not be written.
    #[error("no PDF can be made: {reason}")]
    Pdf {
        /// Why.
        reason: String,
    },
    /// A fault of the program itself.
    #[error("panel {panel} met a fault of eigensync in drawing")]
    Panicked {
        /// Its letter.
        panel: String,
    },
    /// No room is left for the data once the labels are set.
    #[error("panel {panel} leaves {width:.0} pt × {height:.0} pt for its data; give it more room")]
    TooSmall {
        /// Its letter.
        panel: String,
        /// Width left, in points.
        width: f64,
        /// Height left, in points.
        height: f64,
    },
    /// A panel without data.
    #[error("panel {panel} has no {what}")]
    Empty {
        /// Its letter.
        panel: String,
        /// What is missing.
        what: &'static str,
    },
    /// A series of which no point can be drawn.
    #[error("series {series} of panel {panel} has no point that can be drawn among its {n_points}")]
    NothingToDraw {
        /// Letter of the panel.
        panel: String,
        /// Number of the series, from 1.
        series: usize,
        /// Points given.
        n_points: usize,
    },
    /// Two columns of one series differ in length.
    #[error("series {series} of panel {panel} has {n_x} values of x and {found} of its {column}")]
    LengthMismatch {
        /// Letter of the panel.
        panel: String,
        /// Number of the series, from 1.
        series: usize,
        /// Values of x.
        n_x: usize,
        /// The other column.
        column: &'static str,
        /// Its values.
        found: usize,
    },
    /// A range of an axis that cannot be drawn.
    #[error("an axis of panel {panel} would go from {from} to {to}")]
    BadRange {
        /// Letter of the panel.
        panel: String,
        /// Lower end.
        from: f64,
        /// Upper end.
        to: f64,
    },
    /// A link to a node that does not exist.
    #[error("panel {panel}: a link names node {node}, but there are only {n_nodes} nodes")]
    NodeOutOfRange {
        /// Letter of the panel.
        panel: String,
        /// Node number from 0.
        node: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A link whose width cannot be drawn.
    #[error("panel {panel}: a link has weight {weight}; weights must be finite and above zero")]
    BadWeight {
        /// Letter of the panel.
        panel: String,
        /// The weight found.
        weight: f64,
    },
    /// Not one position a node.
    #[error("panel {panel}: {n_positions} positions for {n_nodes} nodes")]
    PositionCount {
        /// Letter of the panel.
        panel: String,
        /// Positions given.
        n_positions: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A position that is not finite.
    #[error("panel {panel}: node {node} is at {position:?}")]
    BadPosition {
        /// Letter of the panel.
        panel: String,
        /// Node number from 0.
        node: usize,
        /// Its coordinates.
        position: Vec<f64>,
    },
    /// A matrix that is not square.
    #[error("panel {panel}: {n_values} values make no matrix of {n_nodes} × {n_nodes}")]
    NotSquare {
        /// Letter of the panel.
        panel: String,
        /// Number of rows asked for.
        n_nodes: usize,
        /// Values given.
        n_values: usize,
    },
    /// A group that is empty or reaches beyond the nodes.
    #[error("panel {panel}: a group covers nodes {from} to {to} (past the end) of {n_nodes}")]
    BadGroup {
        /// Letter of the panel.
        panel: String,
        /// First node, from 0.
        from: usize,
        /// One past the last node.
        to: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// Not one cluster, or none, a node.
    #[error("panel {panel}: clusters of {n_clusters} nodes for {n_nodes} nodes")]
    ClusterCount {
        /// Letter of the panel.
        panel: String,
        /// Nodes whose cluster, or lack of one, is given.
        n_clusters: usize,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// States and clusters of a cascade that cannot be.
    #[error(transparent)]
    Cascade(#[from] CascadeError),
    /// The SVG text cannot be read back.
    #[error("the SVG cannot be read")]
    Svg(#[from] resvg::usvg::Error),
    /// A picture without pixels, or with more than memory can hold.
    #[error("a picture of {width} × {height} pixels cannot be made")]
    BadPixels {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The PNG cannot be written.
    #[error("the PNG cannot be written")]
    Png(#[from] png::EncodingError),
}
