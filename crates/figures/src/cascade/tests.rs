//! What a reader finds in the panel: bands in their places, labels clear of one another, and
//! little of it however many clusters there are.

use super::layout::{Clusters, Strand, strands};
use super::*;
use crate::cascade_error::CascadeError;
use crate::tests::overprint::boxes;
use crate::tests::texts;
use crate::{CascadeCluster, CascadePanel, CascadeState, Content, Figure, Panel};
use resvg::usvg::roxmltree::{Document, Node};

fn cluster(n_nodes: usize, parent: Option<usize>, label: &str) -> CascadeCluster {
    CascadeCluster { n_nodes, parent, label: Label::text(label), colour: 0 }
}

/// States with these lower ends, the first without an upper end.
fn panel(n_nodes: usize, ends: &[f64], clusters: Vec<Vec<CascadeCluster>>) -> CascadePanel {
    assert_eq!(ends.len(), clusters.len());
    let upper = std::iter::once(None).chain(ends.iter().copied().map(Some));
    let states = ends.iter().zip(upper).zip(clusters);
    let state = |((&lower, upper), clusters)| CascadeState { epsilon: (lower, upper), clusters };
    CascadePanel { n_nodes, states: states.map(state).collect(), shown: None }
}

/// Ninety nodes in one cluster, then three, then six, two of which are alone in between.
fn small() -> CascadePanel {
    let clusters = vec![
        vec![cluster(90, None, "1–90")],
        vec![cluster(30, Some(0), "west"), cluster(32, Some(0), "east"), cluster(26, Some(0), "m")],
        vec![
            cluster(10, Some(0), "a"),
            cluster(20, Some(0), "b"),
            cluster(32, Some(1), "east"),
            cluster(13, Some(2), "c"),
            cluster(13, Some(2), "d"),
        ],
    ];
    panel(90, &[25.0, 12.0, 9.2], clusters)
}

/// Splits at random of `n_nodes` nodes, some of which become alone, by a linear congruential
/// generator with the constants of Knuth's MMIX.
fn random(n_nodes: usize, ends: &[f64], seed: u64) -> CascadePanel {
    let mut state = seed;
    let mut below = |n: usize| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize % n
    };
    let mut clusters = vec![vec![cluster(n_nodes, None, "all")]];
    while clusters.len() < ends.len() {
        let mut next = Vec::new();
        for (parent, whole) in clusters[clusters.len() - 1].iter().enumerate() {
            let mut left = whole.n_nodes;
            while left >= 2 {
                let n = 2 + below(left - 1);
                let label = format!("{}–{}", 1 + next.len(), n);
                next.push(cluster(n, Some(parent), &label));
                left = (left - n).saturating_sub(below(3));
            }
        }
        clusters.push(next);
    }
    panel(n_nodes, ends, clusters)
}

/// Twenty critical couplings, the first as wide apart as the last are close.
fn crowded() -> Vec<f64> {
    let first = [25.0, 12.0, 9.2, 7.9, 5.9, 0.5, 0.498, 0.497];
    first.into_iter().chain((0..12).map(|k| 0.49 - 0.01 * f64::from(k))).collect()
}

fn figure(panel: &CascadePanel, [width_mm, height_mm]: [f64; 2]) -> Figure {
    let content = Content::Cascade(panel.clone());
    Figure {
        title: "A cascade".into(),
        width_mm,
        height_mm,
        columns: vec![1.0],
        rows: vec![1.0],
        panels: vec![Panel { letter: "(a)".into(), rows: 0..1, columns: 0..1, content }],
    }
}

fn svg(panel: &CascadePanel) -> String {
    figure(panel, [170.0, 90.0]).svg().unwrap()
}

/// The extent of every cluster of a state drawn without blocks.
fn extents(strands: &[Strand], state: usize, n_clusters: usize) -> Vec<[usize; 2]> {
    let mut extents = vec![[0; 2]; n_clusters];
    for stretch in strands.iter().filter_map(|strand| strand.at(state)) {
        let Clusters::One(cluster) = stretch.clusters else { panic!("{stretch:?} is a block") };
        extents[cluster] = [stretch.from, stretch.to];
    }
    extents
}

#[test]
fn children_lie_within_their_parents_the_largest_first() {
    for seed in 0..20 {
        let panel = random(300, &[8.0, 7.0, 6.0, 5.0, 4.0], seed);
        let strands = strands(&panel, 1);
        let of_state: Vec<_> =
            (0..5).map(|k| extents(&strands, k, panel.states[k].clusters.len())).collect();
        for (k, state) in panel.states.iter().enumerate().skip(1) {
            for (c, cluster) in state.clusters.iter().enumerate() {
                let ([from, to], [start, end]) =
                    (of_state[k][c], of_state[k - 1][cluster.parent.unwrap()]);
                assert_eq!(to - from, cluster.n_nodes);
                assert!(start <= from && to <= end, "{from}–{to} is not within {start}–{end}");
            }
            let mut siblings: Vec<_> = state.clusters.iter().zip(&of_state[k]).collect();
            siblings.sort_by_key(|(_, extent)| extent[0]);
            for pair in siblings.windows(2).filter(|p| p[0].0.parent == p[1].0.parent) {
                assert!(pair[0].0.n_nodes >= pair[1].0.n_nodes);
                assert_eq!(
                    pair[0].1[1], pair[1].1[0],
                    "nodes that are alone stand between siblings"
                );
            }
        }
    }
}

#[test]
fn heights_add_up_to_the_clustered_nodes_and_nothing_overlaps() {
    for (seed, least) in (0..10).flat_map(|seed| [1, 3, 10, 1000].map(|least| (seed, least))) {
        let panel = random(300, &[8.0, 7.0, 6.0, 5.0, 4.0], seed);
        let strands = strands(&panel, least);
        for (k, state) in panel.states.iter().enumerate() {
            let mut drawn: Vec<_> = strands.iter().filter_map(|strand| strand.at(k)).collect();
            drawn.sort_by_key(|stretch| stretch.from);
            assert!(drawn.windows(2).all(|pair| pair[0].to <= pair[1].from));
            let height: usize = drawn.iter().map(|stretch| stretch.to - stretch.from).sum();
            assert_eq!(height, panel.n_nodes - state.n_alone(panel.n_nodes));
            let count = |clusters: &Clusters| match clusters {
                Clusters::One(_) => 1,
                Clusters::Block(n) => *n,
            };
            let n_clusters: usize = drawn.iter().map(|stretch| count(&stretch.clusters)).sum();
            assert_eq!(n_clusters, state.clusters.len());
        }
    }
}

#[test]
fn blocks_lie_within_the_bands_they_came_from() {
    let panel = random(3000, &[8.0, 7.0, 6.0, 5.0, 4.0], 1);
    let strands = strands(&panel, 40);
    let blocks: Vec<_> = strands.iter().filter(|strand| strand.is_block).collect();
    assert!(!blocks.is_empty());
    for block in blocks {
        let first = block.stretches[0];
        let mut before = strands.iter().filter_map(|strand| strand.at(block.first - 1));
        assert!(before.any(|band| band.from <= first.from && first.to <= band.to));
        for pair in block.stretches.windows(2) {
            assert!(pair[0].from <= pair[1].from && pair[1].to <= pair[0].to);
        }
    }
}

#[test]
fn bands_have_the_colours_of_their_clusters_and_the_state_shown_elsewhere_a_frame() {
    let mut panel = small();
    let colours = [vec![1], vec![2, 1, 0], vec![3, 2, 1, 0, 4]];
    for (state, colours) in panel.states.iter_mut().zip(&colours) {
        state
            .clusters
            .iter_mut()
            .zip(colours)
            .for_each(|(cluster, &colour)| cluster.colour = colour);
    }
    let strands = strands(&panel, 1);
    for (state, colours) in colours.iter().enumerate() {
        for (cluster, &colour) in colours.iter().enumerate() {
            let is_drawn =
                |s: &&Strand| s.at(state).is_some_and(|at| at.clusters == Clusters::One(cluster));
            assert_eq!(strands.iter().find(is_drawn).unwrap().colour, colour);
        }
    }
    let frames = |panel: &CascadePanel| svg(panel).matches("stroke-width=\"1.10\"").count();
    assert_eq!(frames(&panel), 0);
    panel.shown = Some(1);
    assert_eq!(frames(&panel), 1);
}

#[test]
fn a_state_with_merged_clusters_is_laid_out_anew_by_size() {
    let mut panel = small();
    let merged = vec![cluster(20, Some(1), "b"), cluster(45, None, "merged")];
    panel.states.push(CascadeState { epsilon: (8.0, Some(9.2)), clusters: merged });
    let strands = strands(&panel, 1);
    assert_eq!(extents(&strands, 3, 2), [[45, 65], [0, 45]]);
    let kept = strands.iter().find(|s| s.at(3).is_some_and(|at| at.from == 45)).unwrap();
    assert!(kept.first < 3, "a cluster that goes on lost its colour");
    let found = texts(&svg(&panel));
    assert!(found.contains(&"merged".to_string()));
    assert_eq!(found.iter().filter(|text| *text == "b").count(), 2, "a band that moved: {found:?}");
}

#[test]
fn couplings_fall_from_left_to_right_at_their_places_on_a_logarithmic_scale() {
    let frame = Rect { left: 40.0, top: 20.0, right: 440.0, bottom: 200.0 };
    let states = panel(2, &crowded(), vec![Vec::new(); 20]).states;
    let columns = Columns::new(&states, frame, 50.0);
    let ends = columns.ends(&states);
    assert_eq!(ends.iter().map(|end| end.0).collect::<Vec<_>>(), crowded());
    assert!((ends[0].1 - 90.0).abs() < 1e-9 && (ends[19].1 - 440.0).abs() < 1e-9);
    for &(epsilon, x) in &ends {
        let share = (25.0_f64 / epsilon).ln() / (25.0_f64 / crowded()[19]).ln();
        assert!((x - 90.0 - 350.0 * share).abs() < 1e-9, "ε = {epsilon} stands at {x}");
    }
    assert_eq!(
        (columns.drawn[0].left, columns.drawn[columns.drawn.len() - 1].right),
        (40.0, 440.0)
    );
    assert!(columns.drawn.windows(2).all(|pair| pair[0].right == pair[1].left));
}

#[test]
fn tiny_clusters_make_few_elements_however_many_they_are() {
    let tiny = |n: usize| {
        let pairs = |parent| (0..n).map(move |_| cluster(2, Some(parent), "never shown"));
        let clusters = vec![
            vec![cluster(4 * n, None, "all")],
            vec![cluster(2 * n, Some(0), "left"), cluster(2 * n, Some(0), "right")],
            [cluster(2 * n, Some(0), "left")].into_iter().chain(pairs(1)).collect(),
            pairs(0).chain((0..n).map(|k| cluster(2, Some(1 + k), ""))).collect(),
        ];
        svg(&panel(4 * n, &[4.0, 3.0, 2.0, 1.0], clusters))
    };
    let elements =
        |svg: &str| Document::parse(svg).unwrap().descendants().filter(Node::is_element).count();
    let [few, many] = [1_000, 100_000].map(tiny);
    assert!(elements(&few) < 120, "{} elements", elements(&few));
    assert_eq!(many.matches("<polygon").count(), few.matches("<polygon").count());
    assert!(elements(&many) < 120, "{} elements", elements(&many));
    assert!(many.len() < 20_000, "{} bytes", many.len());
    assert!(!many.contains("never shown"));
    let texts = texts(&few);
    for expected in ["left", "right", "1,000 clusters", "1,001 clusters", "2,000 clusters"] {
        assert!(texts.iter().any(|text| text == expected), "no {expected} among {texts:?}");
    }
}

#[test]
fn labels_never_overlap_nor_leave_the_page() {
    let even: Vec<f64> = (0..20).map(|k| 1e3 * 0.5_f64.powi(k)).collect();
    let wide: Vec<f64> = (0..20).map(|k| 10f64.powi(20 - 3 * k)).collect();
    let close: Vec<f64> = (0..20).map(|k| 0.5 - 1e-7 * f64::from(k)).collect();
    let last_open: Vec<f64> = (0..20).map(|k| f64::from(19 - k)).collect();
    for ends in [crowded(), even, wide, close, last_open] {
        for (n_nodes, [width, height]) in
            [(90, [85.0, 60.0]), (10_000, [170.0, 100.0]), (100_000, [120.0, 50.0])]
        {
            let svg = figure(&random(n_nodes, &ends, 7), [width, height]).svg().unwrap();
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
            let labels = boxes(&svg);
            assert!(labels.len() > 8);
            let [width, height] = [width, height].map(|mm| mm * 72.0 / 25.4);
            for (k, (text, a)) in labels.iter().enumerate() {
                let is_inside = a[0] >= 0.0 && a[1] >= 0.0 && a[2] <= width && a[3] <= height;
                assert!(is_inside, "{text} at {a:?}");
                for (other, b) in &labels[k + 1..] {
                    let is_clear = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
                    assert!(is_clear, "{text} at {a:?} and {other} at {b:?}");
                }
            }
        }
    }
}

#[test]
fn counts_stand_above_and_critical_couplings_below() {
    let found = texts(&svg(&small()));
    for expected in
        ["1 cluster", "3 clusters", "5 clusters", "0 alone", "2 alone", "25", "12", "9.2"]
    {
        assert!(found.iter().any(|text| text == expected), "no {expected} among {found:?}");
    }
    // Names that go on are written once.
    assert_eq!(found.iter().filter(|text| *text == "east").count(), 1);
    let whole = panel(1_204, &[1.0], vec![vec![cluster(1_204, None, "")]]);
    assert!(!texts(&svg(&whole)).iter().any(|text| text.contains("alone")));
    assert_eq!([7, 1_204, 1_000_000].map(grouped), ["7", "1,204", "1,000,000"]);
}

#[test]
fn a_single_state_and_a_single_node_can_be_drawn() {
    let whole = || vec![vec![cluster(6, None, "1–6")]];
    let mut bounded = panel(6, &[0.5], whole());
    bounded.states[0].epsilon.1 = Some(2.0);
    for panel in [panel(6, &[0.8], whole()), panel(6, &[0.0], whole()), bounded] {
        assert!(texts(&svg(&panel)).contains(&"1 cluster".to_string()));
    }
    assert!(texts(&svg(&panel(1, &[0.0], vec![vec![]]))).contains(&"1 alone".to_string()));
}

#[test]
fn the_end_of_a_prediction_is_drawn_unlike_a_transition() {
    let marks = |svg: &str| {
        let path = svg.split("<path").find(|path| path.contains(MARKER_INK)).unwrap_or_default();
        path.split("d=\"").nth(1).unwrap_or_default().matches('M').count()
    };
    let ends = small();
    let text = svg(&ends);
    let found = texts(&text);
    assert!(found.contains(&"not predicted".to_string()) && found.contains(&"9.2".to_string()));
    assert_eq!((marks(&text), text.matches("stroke-dasharray").count()), (2, 1));
    let mut goes_on = ends;
    goes_on.states[2].epsilon.0 = 0.0;
    let text = svg(&goes_on);
    assert!(!texts(&text).contains(&"not predicted".to_string()));
    assert_eq!((marks(&text), text.matches("stroke-dasharray").count()), (2, 0));
}

#[test]
fn the_axis_of_a_single_state_says_where_it_holds() {
    let alone = |end| panel(6, &[end], vec![vec![cluster(6, None, "")]]);
    let found = texts(&svg(&alone(0.0)));
    assert!(found.iter().any(|text| text.starts_with("every")), "{found:?}");
    let found = texts(&svg(&alone(0.8)));
    assert!(found.contains(&"0.8".to_string()) && !found.iter().any(|t| t.starts_with("every")));
}

#[test]
fn any_coupling_that_is_a_number_can_be_drawn() {
    let ends = [1e308, 1.0, 1e-300, 5e-324, 0.0];
    for n in 1..=ends.len() {
        let svg = svg(&random(50, &ends[..n], 3));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
    let close = [1.0, 1.0 - f64::EPSILON, 1.0 - 2.0 * f64::EPSILON];
    assert!(!svg(&random(50, &close, 3)).contains("NaN"));
}

#[test]
fn impossible_data_are_refused_with_their_numbers() {
    let message = |change: &dyn Fn(&mut CascadePanel)| {
        let mut panel = small();
        change(&mut panel);
        assert!(figure(&panel, [170.0, 90.0]).svg().is_err());
        panel.check("(a)").unwrap_err().to_string()
    };
    assert_eq!(message(&|p| p.states.clear()), "panel (a) has no states");
    assert_eq!(message(&|p| p.n_nodes = 0), "panel (a) has no nodes");
    let too_many = message(&|p| p.n_nodes = 89);
    assert_eq!(too_many, "panel (a): clusters of state 0 have 90 nodes out of 89");
    let too_many = message(&|p| p.states[2].clusters[1].n_nodes = 21);
    assert_eq!(too_many, "panel (a): clusters of state 2 have 31 nodes out of 30");
    let nowhere = message(&|p| p.states[2].clusters[1].parent = Some(3));
    let expected = "panel (a): cluster 1 of state 2 comes from cluster 3, but there are 3 in the \
                    state before";
    assert_eq!(nowhere, expected);
    let gap = message(&|p| p.states[1].epsilon.1 = Some(24.0));
    assert_eq!(gap, "panel (a): state 1 begins at ε = 24, but the one before ends at 25");
    for epsilon in [(9.2, Some(9.2)), (f64::NAN, Some(12.0)), (-1.0, Some(12.0))] {
        let range = message(&|p| p.states[2].epsilon = epsilon);
        assert!(range.starts_with("panel (a): state 2 would reach from ε = "), "{range}");
    }
    assert!(
        message(&|p| p.states[0].clusters[0].parent = Some(0))
            .ends_with("there are 0 in the state before")
    );
    let lone = message(&|p| p.states[2].clusters[1].n_nodes = 1);
    assert_eq!(lone, "panel (a): the nodes of cluster 1 of state 2 number 1, fewer than two");
}

#[test]
fn an_empty_panel_and_one_without_room_are_errors() {
    let empty = CascadePanel { n_nodes: 5, states: Vec::new(), shown: None };
    assert!(matches!(empty.check("(a)"), Err(CascadeError::Empty { what: "states", .. })));
    let refused = figure(&empty, [170.0, 90.0]).svg();
    assert_eq!(refused.unwrap_err().to_string(), "panel (a) has no states");
    for size in [[30.0, 90.0], [170.0, 30.0]] {
        assert!(matches!(figure(&small(), size).svg(), Err(FigureError::TooSmall { .. })));
    }
}
