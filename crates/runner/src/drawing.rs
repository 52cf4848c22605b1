//! The figure of an experiment of [`FigureKind::Sweep`], the panels of the paper's Fig. 1: the network
//! coloured by clusters, errors against ε with the predicted critical couplings marked, and Λ(σ).
//! `drawing/pairs` has the other kinds.

mod cascade;
mod identity;
mod marks;
mod order;
mod pairs;
mod picture;
mod regions;
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
    Content, Figure, Label, LinePanel, Link, MsfCurve, NetworkPanel, Node, Panel, Placement, Scale,
    Series, Shade, Spread, SpreadStyle, Tone, msf_panel,
};
use identity::Identities;

/// Resolution of the PNG: what journals ask for.
const DOTS_PER_INCH: f64 = 300.0;

/// Up to this many nodes a network is drawn with its links.
const DRAWN_NODES: usize = 1000;

/// The figure of the kind that the experiment asks for.
fn figure(plan: &Plan, findings: &Findings) -> Figure {
    match (plan.figure_kind(), &findings.simulated) {
        (FigureKind::Matrices, Some(simulated)) => pairs::matrices(plan, findings, simulated),
        (FigureKind::Regions, Some(simulated)) => regions::regions(plan, findings, simulated),
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
    let letter = |number: u8| match &plan.figure().letter {
        Some(letter) => format!("({letter}{number})"),
        None => format!("({})", char::from(b'a' + number - 1)),
    };
    let left = |row: usize, number: u8, content: Content| Panel {
        letter: letter(number),
        rows: row..row + 1,
        columns: 0..1,
        content,
    };
    let mut identities = Identities::of(plan, findings);
    let network = network_or_spectrum(plan, findings, &mut identities);
    let mut panels = vec![left(0, 1, network)];
    let lines = match (&plan.study.sweep, &findings.simulated) {
        (Some(sweep), Some(simulated)) => {
            Some(errors(plan, sweep, simulated, findings, &identities))
        }
        _ => None,
    };
    let content = match lines {
        Some(lines) if !lines.series.is_empty() => Some(Content::Lines(lines)),
        // Without a sweep, or where no errors were asked for, or every run escaped.
        _ if findings.cascade.is_empty() => None,
        _ => Some(Content::Cascade(cascade::panel(plan, findings, &identities))),
    };
    let mut columns = vec![1.0];
    if let Some(content) = content {
        panels.push(Panel { letter: letter(2), rows: 0..2, columns: 1..2, content });
        columns.push(1.7);
    }
    panels.push(left(1, columns.len() as u8 + 1, Content::Lines(msf(&findings.msf))));
    Figure {
        title: plan.experiment.title.clone(),
        width_mm: if columns.len() > 1 { 170.0 } else { 75.0 },
        height_mm: 100.0,
        columns,
        rows: vec![1.0, 0.95],
        panels,
    }
}

/// The network coloured by clusters or, where it is too large to be seen, its leading eigenvalues. The
/// clusters are those of the experiment, else those of the predicted state that has the most.
fn network_or_spectrum(plan: &Plan, findings: &Findings, identities: &mut Identities) -> Content {
    let own = plan.study.sweep.as_ref().map_or(&[][..], |sweep| &sweep.observables.clusters);
    if plan.study.network.n_nodes() > DRAWN_NODES {
        identities.shown = None;
        return Content::Lines(spectrum(findings));
    }
    if !own.is_empty() {
        identities.shown = None;
        let name =
            |(m, nodes): (usize, &Vec<usize>)| identity::own_name(&plan.study.network, m, nodes);
        return Content::Network(network(plan, own, (1..).zip(own).map(name).collect()));
    }
    Content::Network(predicted_network(plan, findings, identities))
}

/// The network coloured by the clusters of the predicted state to be shown, grey where there is none.
fn predicted_network(plan: &Plan, findings: &Findings, identities: &Identities) -> NetworkPanel {
    let Some(shown) = identities.shown else {
        return network(plan, &[], Vec::new());
    };
    let state = &findings.cascade[shown];
    let mut clusters: Vec<_> =
        state.clusters.nontrivial().into_iter().zip(&identities.of_state[shown]).collect();
    // These have the first colours.
    clusters.sort_by_key(|(_, identity)| identity.colour);
    let (nodes, names): (Vec<_>, Vec<_>) =
        clusters.into_iter().map(|(nodes, identity)| (nodes, identity.name.clone())).unzip();
    NetworkPanel { title: range(state.epsilon), ..network(plan, &nodes, names) }
}

/// A range of ε, as an inequality.
fn range((from, to): (f64, Option<f64>)) -> Label {
    let above = |from: f64| Label::math("ε").with_math(&format!(" > {}", three_digits(from)));
    let between = |from: f64, to: f64| {
        Label::math(&format!("{} < ε < {}", three_digits(from), three_digits(to)))
    };
    to.map_or_else(|| above(from), |to| between(from, to))
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

/// The network coloured by clusters, the first of which has the first colour.
fn network(plan: &Plan, clusters: &[Vec<usize>], names: Vec<Label>) -> NetworkPanel {
    let network = &plan.study.network;
    let mut cluster_of = vec![None; network.n_nodes()];
    for (cluster, nodes) in clusters.iter().enumerate() {
        nodes.iter().for_each(|&node| cluster_of[node] = Some(cluster));
    }
    let nodes = network.labels().iter().enumerate();
    let links = network.adjacency().outer_iterator().enumerate().flat_map(|(from, row)| {
        let row: Vec<_> = row.iter().map(|(to, &weight)| Link { from, to, weight }).collect();
        row.into_iter().filter(|link| link.from < link.to)
    });
    NetworkPanel {
        nodes: nodes
            .map(|(i, label)| Node { label: label.clone(), cluster: cluster_of[i] })
            .collect(),
        links: links.collect(),
        placement: match &plan.figure().layout {
            Layout::Circle => Placement::Circle,
            Layout::Force => Placement::Stress,
            Layout::Grouped => Placement::Grouped,
            Layout::At(positions) => Placement::At(positions.clone()),
        },
        cluster_labels: names,
        title: Label::default(),
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
fn errors(
    plan: &Plan,
    sweep: &Sweep,
    simulated: &Simulated,
    findings: &Findings,
    identities: &Identities,
) -> LinePanel {
    let labels = plan.study.network.labels();
    let colours = identities.shown_colours(findings, labels.len());
    let observables = &sweep.observables;
    let nodes: Vec<usize> =
        (0..labels.len()).filter(|node| Some(*node) != observables.reference).collect();
    let one = |number: usize, style: usize| {
        if observables.clusters.is_empty() {
            let node = nodes[number];
            let label = Label::math("δx").subscript(&labels[node]);
            let curve = curve(plan, label, style, |at| {
                simulated.over_seeds(at, |errors| errors.to_reference[node])
            });
            // A node in no cluster has a colour that none of them has.
            let free = identities.n_shown() + style;
            Series { cluster: Some(colours[node].unwrap_or(free)), ..curve }
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
        markers: [marks::critical(plan, findings, [first, last]), marks::seen_by_the_source(plan)]
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
        cluster: None,
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
