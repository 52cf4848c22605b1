//! Panels side by side as in the paper's figures: predictions above simulations.
//!
//! Figs. 2 to 4 have a network (a1), its eigenvectors (a2), and for every coupling one matrix of
//! eigenvector distances (b1, c1, …) above one of synchronisation errors (b2, c2, …). Fig. 5 has
//! such pairs alone (a1 above a2, b1 above b2, …).

use std::ops::Range;

use super::content::Content;
use super::figure::{COLUMN_GAP, Figure, POINTS_PER_MM, Panel, ROW_GAP};
use super::heat_map::HeatMapPanel;
use super::lines::LinePanel;
use super::network::NetworkPanel;

/// Width of a figure that fills a page, in mm.
const WIDTH_MM: f64 = 170.0;
/// Columns of matrices from which the network and its eigenvectors stand in a row of their own.
const OWN_ROW_FROM: usize = 3;
/// Height over width of a matrix with its labels and its colour bar, and of three views in space.
const MATRIX_ASPECT: f64 = 0.89;
const VIEWS_ASPECT: f64 = 1.07;
/// Height over width of a network panel in a row of its own.
const NETWORK_ASPECT: f64 = 1.0;

/// A network, its eigenvectors, and predictions against simulations.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// For readers that show it.
    pub title: String,
    /// Panel (a1).
    pub network: NetworkPanel,
    /// Panel (a2).
    pub eigenvectors: LinePanel,
    /// For every coupling the predicted matrix and the simulated one.
    pub matrices: Vec<[HeatMapPanel; 2]>,
}

impl Comparison {
    /// The figure: up to two couplings stand at the right of the network, which is above its
    /// eigenvectors; three and more stand below the network, which has them at its right.
    pub fn figure(self) -> Figure {
        let n_pairs = self.matrices.len();
        let own_row = n_pairs >= OWN_ROW_FROM;
        let n_columns = if own_row { n_pairs } else { n_pairs + 1 };
        let (top, right, first) = if own_row { (1, 1..n_pairs, 0) } else { (0, 0..1, 1) };
        let below = if own_row { 0..1 } else { 1..2 };
        let network = Content::Network(self.network);
        let eigenvectors = Content::Lines(self.eigenvectors);
        let mut panels =
            vec![panel("(a1)", 0..1, 0..1, network), panel("(a2)", below, right, eigenvectors)];
        panels.extend(pairs(self.matrices, Content::HeatMap, 'b', [top, first]));
        let aspects = if own_row {
            vec![NETWORK_ASPECT, MATRIX_ASPECT, MATRIX_ASPECT]
        } else {
            vec![MATRIX_ASPECT, MATRIX_ASPECT]
        };
        grid(self.title, n_columns.max(1), aspects, panels)
    }
}

/// Predictions above simulations, one column a coupling.
pub fn pairs_figure(title: String, columns: Vec<[Content; 2]>) -> Figure {
    let n_columns = columns.len().max(1);
    let panels = pairs(columns, |content| content, 'a', [0, 0]);
    grid(title, n_columns, vec![VIEWS_ASPECT; 2], panels)
}

/// Panels lettered (x1) above (x2), x ascending from `letter`, from a row and a column on.
fn pairs<T>(
    pairs: Vec<[T; 2]>,
    content: impl Fn(T) -> Content,
    letter: char,
    [row, column]: [usize; 2],
) -> Vec<Panel> {
    let mut panels = Vec::new();
    for (k, (pair, letter)) in pairs.into_iter().zip(letter..).enumerate() {
        for (below, one) in pair.into_iter().enumerate() {
            let name = format!("({letter}{})", below + 1);
            let (row, column) = (row + below, column + k);
            panels.push(panel(&name, row..row + 1, column..column + 1, content(one)));
        }
    }
    panels
}

fn panel(letter: &str, rows: Range<usize>, columns: Range<usize>, content: Content) -> Panel {
    Panel { letter: letter.into(), rows, columns, content }
}

/// Columns of equal widths, rows as high as their aspects over one column say.
fn grid(title: String, n_columns: usize, aspects: Vec<f64>, panels: Vec<Panel>) -> Figure {
    let gap = |points: f64, n: usize| points / POINTS_PER_MM * (n - 1) as f64;
    let column = (WIDTH_MM - gap(COLUMN_GAP, n_columns)) / n_columns as f64;
    let height_mm = column * aspects.iter().sum::<f64>() + gap(ROW_GAP, aspects.len());
    Figure {
        title,
        width_mm: WIDTH_MM,
        height_mm,
        columns: vec![1.0; n_columns],
        rows: aspects,
        panels,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Group, Label, Mode, Node, Placement, PositionsPanel, components_panel};

    fn comparison(n_pairs: usize) -> Comparison {
        let node = |k: usize| Node { label: String::new(), cluster: Some(k) };
        let groups = [Group { label: Label::math("C").subscript("1"), nodes: 0..2 }];
        let mode = Mode { label: Label::math("v").subscript("2"), components: vec![0.6, -0.8] };
        let matrix = HeatMapPanel {
            n_nodes: 2,
            values: vec![0.0, 1.4, 1.4, 0.0],
            groups: groups.to_vec(),
            ..HeatMapPanel::default()
        };
        Comparison {
            title: "A test".into(),
            network: NetworkPanel {
                nodes: vec![node(0), node(1)],
                placement: Placement::Stress,
                ..NetworkPanel::default()
            },
            eigenvectors: components_panel(&[mode], &groups),
            matrices: vec![[matrix.clone(), matrix]; n_pairs],
        }
    }

    /// Letter, rows and columns of every panel.
    fn places(figure: &Figure) -> Vec<(&str, Range<usize>, Range<usize>)> {
        figure
            .panels
            .iter()
            .map(|p| (p.letter.as_str(), p.rows.clone(), p.columns.clone()))
            .collect()
    }

    #[test]
    fn three_couplings_stand_below_the_network_and_its_eigenvectors() {
        let figure = comparison(3).figure();
        let expected = [
            ("(a1)", 0..1, 0..1),
            ("(a2)", 0..1, 1..3),
            ("(b1)", 1..2, 0..1),
            ("(b2)", 2..3, 0..1),
            ("(c1)", 1..2, 1..2),
            ("(c2)", 2..3, 1..2),
            ("(d1)", 1..2, 2..3),
            ("(d2)", 2..3, 2..3),
        ];
        assert_eq!(places(&figure), expected);
        assert!(figure.svg().is_ok());
    }

    #[test]
    fn two_couplings_stand_beside_the_network_above_its_eigenvectors() {
        let figure = comparison(2).figure();
        let expected = [
            ("(a1)", 0..1, 0..1),
            ("(a2)", 1..2, 0..1),
            ("(b1)", 0..1, 1..2),
            ("(b2)", 1..2, 1..2),
            ("(c1)", 0..1, 2..3),
            ("(c2)", 1..2, 2..3),
        ];
        assert_eq!(places(&figure), expected);
        assert!(figure.svg().is_ok());
    }

    #[test]
    fn every_number_of_couplings_from_none_to_four_can_be_drawn() {
        for n_pairs in 0..=4 {
            let drawn = comparison(n_pairs).figure().svg();
            assert!(drawn.is_ok(), "{n_pairs}: {drawn:?}");
        }
    }

    #[test]
    fn pairs_alone_begin_with_a() {
        let views = || {
            Content::Positions(PositionsPanel {
                positions: vec![[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]],
                clusters: vec![Some(0), None],
                ..PositionsPanel::default()
            })
        };
        let figure = pairs_figure("A test".into(), vec![[views(), views()], [views(), views()]]);
        let expected = [
            ("(a1)", 0..1, 0..1),
            ("(a2)", 1..2, 0..1),
            ("(b1)", 0..1, 1..2),
            ("(b2)", 1..2, 1..2),
        ];
        assert_eq!(places(&figure), expected);
        assert!(figure.svg().is_ok());
        assert!(matches!(
            pairs_figure(String::new(), vec![]).svg(),
            Err(crate::FigureError::NoPanels)
        ));
    }
}
