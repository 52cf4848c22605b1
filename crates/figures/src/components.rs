//! Panel of eigenvector components: v_k,i against node i for several modes k, one symbol a mode,
//! groups of nodes set apart by thin lines.
//!
//! Nodes i and j stay together while every unstable mode k has v_k,i = v_k,j, so that clusters
//! show as level runs of symbols (paper, Figs. 2–4 (a2)).

use super::groups::Group;
use super::label::Label;
use super::lines::{LinePanel, Span};
use super::series::Series;

/// An eigenvector.
#[derive(Clone, Debug)]
pub struct Mode {
    /// Its name, such as v₂.
    pub label: Label,
    /// Its component at each node, in order of the nodes; one that is not finite is left out.
    pub components: Vec<f64>,
}

/// The panel. Groups beyond the last component are cut at the frame.
pub fn components_panel(modes: &[Mode], groups: &[Group]) -> LinePanel {
    let n_nodes = modes.iter().map(|mode| mode.components.len()).max().unwrap_or(0);
    LinePanel {
        x_label: Label::text("node ").with_math("i"),
        y_label: Label::math("v").subscript("k,i"),
        // There is no node 0, and so no tick at it.
        x_range: Some([0.25, n_nodes as f64 + 0.75]),
        zero_line: true,
        series: modes.iter().enumerate().map(|(k, mode)| series(k, groups.len(), mode)).collect(),
        marks_only: true,
        spans: groups.iter().map(span).collect(),
        ..LinePanel::default()
    }
}

/// A mode has none of the colours of the groups, which it is not about.
fn series(style: usize, n_groups: usize, mode: &Mode) -> Series {
    Series {
        label: mode.label.clone(),
        style,
        cluster: Some(n_groups + style),
        x: (1..=mode.components.len()).map(|node| node as f64).collect(),
        y: mode.components.clone(),
        ..Series::default()
    }
}

fn span(group: &Group) -> Span {
    let [from, to] = group.span();
    Span { from, to, label: group.label.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_count_from_one_and_groups_end_between_nodes() {
        let modes = [Mode { label: Label::math("v").subscript("2"), components: vec![0.5; 4] }];
        let groups = [Group { label: Label::default(), nodes: 0..3 }];
        let panel = components_panel(&modes, &groups);
        assert_eq!(panel.series[0].x, [1.0, 2.0, 3.0, 4.0]);
        assert_eq!((panel.spans[0].from, panel.spans[0].to), (0.5, 3.5));
        assert_eq!(panel.series[0].cluster, Some(1), "a mode has the colour of a group");
        let [from, to] = panel.x_range.unwrap();
        assert!(from < 1.0 && to > 4.0);
    }
}
