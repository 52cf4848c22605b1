//! The figure of an experiment of [`FigureKind::Sweep`], the panels of the paper's Fig. 1: the network
//! coloured by clusters, errors against ε with the predicted critical couplings marked, and Λ(σ).
//! `drawing/pairs` has the other kinds.

mod cascade;
mod pairs;
mod picture;
mod room;

pub use pairs::{distance, error_matrix};
pub use picture::picture;
pub use room::foreseen;

use msf::MasterStability;

use crate::plan::Plan;
use crate::spec::{ErrorScale, FigureKind, Layout, SpreadKind};
use eigensync::numbers::three_digits;
use eigensync::{Findings, OverSeeds, Simulated, Sweep};
use figures::{
    Content, Figure, Label, LinePanel, Link, Marker, MarkerGroup, MarkerStyle, MsfCurve,
    NetworkPanel, Node, Panel, Placement, Scale, Series, Shade, Spread, SpreadStyle, Tone,
    msf_panel,
};

/// Resolution of the PNG: what journals ask for.
const DOTS_PER_INCH: f64 = 300.0;

/// Up to this many nodes a network is drawn with its links.
const DRAWN_NODES: usize = 1000;

/// The figure of the kind that the experiment asks for.
fn figure(plan: &Plan, findings: &Findings) -> Figure {
    match (plan.figure_kind(), &findings.simulated) {
        (FigureKind::Matrices, Some(simulated)) => pairs::matrices(plan, findings, simulated),
        (FigureKind::Regions, Some(simulated)) => pairs::regions(plan, findings, simulated),
        _ => sweep(plan, findings),
    }
}

/// The files of the figure of a curve alone, or why there is none.
pub fn curve_alone(
    title: &str,
    msf: &MasterStability,
) -> Vec<(&'static str, std::result::Result<Vec<u8>, String>)> {
    let content = Content::Lines(self::msf(msf));
    let panel = Panel { letter: String::new(), rows: 0..1, columns: 0..1, content };
    let figure = Figure {
        title: title.to_owned(),
        width_mm: 100.0,
        height_mm: 75.0,
        columns: vec![1.0],
        rows: vec![1.0],
        panels: vec![panel],
    };
    let svg = figure.drawn().map(|drawn| drawn.svg).map_err(|error| error.to_string());
    let png = svg
        .clone()
        .and_then(|svg| figures::png(&svg, DOTS_PER_INCH).map_err(|error| error.to_string()));
    vec![("figure.svg", svg.map(String::into_bytes)), ("figure.png", png)]
}

/// The network above Λ(σ) at the left; at the right the sweep or, without one, the predicted states.
fn sweep(plan: &Plan, findings: &Findings) -> Figure {
    let letter = |number: usize| format!("({}{number})", plan.figure().letter);
    let left = |row: usize, number: usize, content: Content| Panel {
        letter: letter(number),
        rows: row..row + 1,
        columns: 0..1,
        content,
    };
    let mut panels = vec![left(0, 1, network_or_spectrum(plan, findings))];
    let lines = match (&plan.study.sweep, &findings.simulated) {
        (Some(sweep), Some(simulated)) => Some(errors(plan, sweep, simulated, findings)),
        _ => None,
    };
    let content = match lines {
        Some(lines) if !lines.series.is_empty() => Some(Content::Lines(lines)),
        // Without a sweep, or where no errors were asked for, or every run escaped.
        _ if findings.cascade.is_empty() => None,
        _ => Some(Content::Cascade(cascade::panel(plan, findings))),
    };
    let mut columns = vec![1.0];
    if let Some(content) = content {
        panels.push(Panel { letter: letter(2), rows: 0..2, columns: 1..2, content });
        columns.push(1.7);
    }
    panels.push(left(1, panels.len() + 1, Content::Lines(msf(&findings.msf))));
    Figure {
        title: plan.experiment.title.clone(),
        width_mm: if columns.len() > 1 { 170.0 } else { 75.0 },
        height_mm: 100.0,
        columns,
        rows: vec![1.0, 0.95],
        panels,
    }
}

/// The network coloured by clusters or, where it is too large to be seen, its leading eigenvalues.
fn network_or_spectrum(plan: &Plan, findings: &Findings) -> Content {
    if plan.study.network.n_nodes() > DRAWN_NODES {
        return Content::Lines(spectrum(findings));
    }
    Content::Network(network(plan, &shown_clusters(plan, findings)))
}

/// λ_k against k.
fn spectrum(findings: &Findings) -> LinePanel {
    let eigenvalues = findings.spectrum.real_eigenvalues();
    LinePanel {
        x_label: Label::text("mode ").with_math("k"),
        y_label: Label::math("λ").subscript("k"),
        series: vec![Series {
            x: (1..=eigenvalues.len()).map(|k| k as f64).collect(),
            y: eigenvalues,
            ..Series::default()
        }],
        ..LinePanel::default()
    }
}

/// The clusters that colour the network: those of the experiment, else of the first predicted state
/// that has some beside global synchronisation.
fn shown_clusters(plan: &Plan, findings: &Findings) -> Vec<Vec<usize>> {
    let own = plan.study.sweep.as_ref().map(|sweep| sweep.observables.clusters.clone());
    own.filter(|clusters| !clusters.is_empty()).unwrap_or_else(|| {
        let some = findings.cascade.iter().filter(|state| state.clusters.n_clusters() > 1);
        let clusters = some.map(|state| state.clusters.nontrivial());
        clusters.into_iter().find(|clusters| !clusters.is_empty()).unwrap_or_default()
    })
}

fn network(plan: &Plan, clusters: &[Vec<usize>]) -> NetworkPanel {
    let network = &plan.study.network;
    let cluster = |node: usize| clusters.iter().position(|cluster| cluster.contains(&node));
    let nodes = network.labels().iter().enumerate();
    let links = network.adjacency().outer_iterator().enumerate().flat_map(|(from, row)| {
        let row: Vec<_> = row.iter().map(|(to, &weight)| Link { from, to, weight }).collect();
        row.into_iter().filter(|link| link.from < link.to)
    });
    NetworkPanel {
        nodes: nodes.map(|(i, label)| Node { label: label.clone(), cluster: cluster(i) }).collect(),
        links: links.collect(),
        placement: match &plan.figure().layout {
            Layout::Circle => Placement::Circle,
            Layout::Force => Placement::Stress,
            Layout::Grouped => Placement::Grouped,
            Layout::At(positions) => Placement::At(positions.clone()),
        },
        cluster_labels: (1..=clusters.len())
            .map(|m| Label::math("C").subscript(&m.to_string()))
            .collect(),
    }
}

fn msf(msf: &MasterStability) -> LinePanel {
    msf_panel(&MsfCurve {
        sigma: msf.sigma.clone(),
        lambda: msf.lambda.iter().map(|lambda| lambda.mean).collect(),
        standard_error: msf.lambda.iter().map(|lambda| lambda.standard_error).collect(),
        stable: msf.stable.intervals.iter().map(|i| (i.lower(), i.upper())).collect(),
        zeros: msf.stable.zeros().map(|zero| (zero.sigma, three_digits(zero.sigma))).collect(),
    })
}

/// δx_i to the reference node or δx^c_m within clusters, whichever the experiment asks for.
fn errors(plan: &Plan, sweep: &Sweep, simulated: &Simulated, findings: &Findings) -> LinePanel {
    let labels = plan.study.network.labels();
    let observables = &sweep.observables;
    let nodes: Vec<usize> =
        (0..labels.len()).filter(|node| Some(*node) != observables.reference).collect();
    let one = |number: usize, style: usize| {
        if observables.clusters.is_empty() {
            let node = nodes[number];
            let label = Label::math("δx").subscript(&labels[node]);
            curve(plan, label, style, |at| {
                simulated.over_seeds(at, |errors| errors.to_reference[node])
            })
        } else {
            let label = Label::math("δx").subscript(&(number + 1).to_string()).superscript("c");
            curve(plan, label, number, |at| {
                simulated.over_seeds(at, |errors| errors.within_clusters[number])
            })
        }
    };
    let sizes = room::curve_sizes(sweep, labels.len());
    let room::Curves { named, grey } = room::curves(&sizes);
    let mut series: Vec<Series> =
        named.iter().enumerate().map(|(style, &number)| one(number, style)).collect();
    let muted = |(place, &number): (usize, &usize)| Series {
        label: match place {
            0 => Label::text(format!("{} more", sizes.len() - named.len())),
            _ => Label::default(),
        },
        muted: true,
        spread: None,
        ..one(number, 0)
    };
    series.extend(grey.iter().enumerate().map(muted));
    // A curve of nothing but escapes, or of zeros on a logarithmic scale, has no point to draw.
    let logarithmic = matches!(plan.figure().error_scale, ErrorScale::Log);
    let drawable = |y: &f64| y.is_finite() && (!logarithmic || *y > 0.0);
    series.retain(|curve| curve.y.iter().any(drawable));
    let y_label = if observables.clusters.is_empty() {
        Label::math("δx").subscript("i")
    } else {
        Label::math("δx").subscript("m").superscript("c")
    };
    let (first, last) = (sweep.epsilon[0], sweep.epsilon[sweep.epsilon.len() - 1]);
    LinePanel {
        x_label: Label::math("ε"),
        y_label,
        y_scale: match plan.figure().error_scale {
            ErrorScale::Linear => Scale::Linear,
            ErrorScale::Log => Scale::Log,
        },
        series,
        markers: [critical(plan, findings, [first, last]), seen_by_the_source(plan)]
            .into_iter()
            .filter(|group| !group.markers.is_empty())
            .collect(),
        shaded: shades(simulated),
        ..LinePanel::default()
    }
}

/// Points of a sweep as ranges of ε, each as far as halfway to its neighbours.
fn stretches(epsilon: &[f64], is_inside: impl Fn(usize) -> bool) -> Vec<[f64; 2]> {
    let halfway = |at: usize, next: usize| 0.5 * (epsilon[at] + epsilon[next]);
    let (mut spans, last): (Vec<[f64; 2]>, _) = (Vec::new(), epsilon.len() - 1);
    for at in (0..=last).filter(|&at| is_inside(at)) {
        let (from, to) = (halfway(at.saturating_sub(1), at), halfway(at, (at + 1).min(last)));
        match spans.last_mut() {
            Some(before) if before[1] == from => before[1] = to,
            _ => spans.push([from, to]),
        }
    }
    spans
}

/// The ranges of ε in which runs fall into groups, so that their mean is of neither, and in which some
/// came to no end.
fn shades(simulated: &Simulated) -> Vec<Shade> {
    let (epsilon, n_runs) = (&simulated.epsilon, simulated.seeds.len());
    let lost: Vec<usize> = (0..epsilon.len()).map(|at| simulated.broken_off(at)).collect();
    let some = || lost.iter().filter(|&&count| count > 0);
    let count = match (some().min(), some().max()) {
        (Some(least), Some(most)) if least == most => format!("{least} of {n_runs}"),
        (Some(least), Some(most)) => format!("{least} to {most} of {n_runs}"),
        _ => String::new(),
    };
    let parted = Shade {
        spans: stretches(epsilon, |at| simulated.parted(at).is_some()),
        label: Label::text("runs in two groups"),
        tone: Tone::Yellow,
    };
    let escaped = Shade {
        spans: stretches(epsilon, |at| lost[at] > 0),
        label: Label::text(format!("{count} runs {}", simulated.broke_off())),
        tone: Tone::Grey,
    };
    [parted, escaped].into_iter().filter(|shade| !shade.spans.is_empty()).collect()
}

/// A curve over ε with the spread over seeds.
fn curve(
    plan: &Plan,
    label: Label,
    style: usize,
    at: impl Fn(usize) -> Option<OverSeeds>,
) -> Series {
    let x = plan.study.sweep.as_ref().map_or_else(Vec::new, |sweep| sweep.epsilon.clone());
    let points: Vec<Option<OverSeeds>> = (0..x.len()).map(at).collect();
    // Where every seed escaped the curve has a gap.
    let of = |value: &dyn Fn(&OverSeeds) -> f64| {
        points.iter().map(|point| point.as_ref().map_or(f64::NAN, value)).collect()
    };
    Series {
        label,
        style,
        muted: false,
        x,
        y: of(&|point| point.mean),
        spread: Some(Spread {
            lower: of(&|point| (point.mean - point.spread).max(0.0)),
            upper: of(&|point| point.mean + point.spread),
            drawn: match plan.figure().spread {
                SpreadKind::Band => SpreadStyle::Band,
                SpreadKind::Bars => SpreadStyle::Bars,
            },
        }),
    }
}

/// The predicted critical couplings within the sweep, one for each run of equal eigenvalues.
fn critical(plan: &Plan, findings: &Findings, [first, last]: [f64; 2]) -> MarkerGroup {
    let wanted =
        |mode: usize| plan.figure().mark_modes.as_ref().is_none_or(|modes| modes.contains(&mode));
    let eigenspaces = findings.spectrum.real_modes().eigenspaces;
    let leads = |mode: usize| eigenspaces.iter().any(|e| e.start + 1 == mode);
    let markers = findings
        .critical
        .iter()
        .filter(|critical| leads(critical.mode) && wanted(critical.mode))
        .filter(|critical| (first..=last).contains(&critical.epsilon))
        .map(|critical| Marker {
            x: critical.epsilon,
            label: Some(Label::math("ε").subscript(&critical.mode.to_string())),
        });
    MarkerGroup {
        style: MarkerStyle::Predicted,
        legend: Some(Label::text("predicted")),
        markers: markers.collect(),
    }
}

/// The transitions that the source saw in its own simulations.
fn seen_by_the_source(plan: &Plan) -> MarkerGroup {
    let transitions = plan.figure().source_transitions.iter();
    MarkerGroup {
        style: MarkerStyle::Reference,
        legend: Some(Label::text("paper")),
        markers: transitions.map(|&x| Marker { x, label: None }).collect(),
    }
}
