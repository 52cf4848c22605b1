//! What a panel shows: one of the kinds of panel, each a file of its own and a line of the list here.

use crate::canvas::{Canvas, Rect};
use crate::drawable::Drawable;
use crate::error::FigureError;

/// The kinds of panel.
macro_rules! contents {
    ($($(#[doc = $text:literal])+ $name:ident($panel:ty)),+ $(,)?) => {
        /// What a panel shows.
        #[derive(Clone, Debug)]
        pub enum Content {
            $($(#[doc = $text])+ $name($panel)),+
        }

        impl Content {
            fn drawable(&self) -> &dyn Drawable {
                match self {
                    $(Self::$name(panel) => panel),+
                }
            }
        }
    };
}

contents! {
    /// Curves in a frame.
    Lines(crate::lines::LinePanel),
    /// Nodes and links.
    Network(crate::network::NetworkPanel),
    /// A square matrix in colours.
    HeatMap(crate::heat_map::HeatMapPanel),
    /// Nodes in space, from three sides.
    Positions(crate::positions::PositionsPanel),
    /// Clusters of every state as ε falls.
    Cascade(crate::cascade::CascadePanel),
    /// Many small curves side by side.
    Multiples(crate::multiples::MultiplesPanel),
}

impl Drawable for Content {
    fn left_margin(&self, height: f64, panel: &str) -> Result<f64, FigureError> {
        self.drawable().left_margin(height, panel)
    }

    fn draw(
        &self,
        canvas: &mut Canvas,
        cell: Rect,
        left_margin: f64,
        panel: &str,
    ) -> Result<(), FigureError> {
        self.drawable().draw(canvas, cell, left_margin, panel)
    }
}
