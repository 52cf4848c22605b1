//! The figure of an experiment of [`FigureKind::Sweep`](experiment::spec::FigureKind), the panels of the
//! paper's Fig. 1: the network coloured by clusters, errors against ε with the predicted critical
//! couplings marked, and Λ(σ).

use eigensync::{Findings, OverSeeds, Simulated, Sweep};
use experiment::Plan;
use experiment::spec::{ErrorScale, SpreadKind};
use figures::{
    Content, Figure, Label, LinePanel, Panel, Scale, Series, Shade, Spread, SpreadStyle, Tone,
};

use crate::identity::Identities;
use crate::network::network_or_spectrum;
use crate::{cascade, curve, marks, room};

/// The network above Λ(σ) at the left; at the right the sweep or, without one, the predicted states.
pub fn sweep(plan: &Plan, findings: &Findings) -> Figure {
    let letter = |number: u8| match &plan.figure.letter {
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
    panels.push(left(1, columns.len() as u8 + 1, Content::Lines(curve::panel(&findings.msf))));
    Figure {
        title: plan.title.clone(),
        width_mm: if columns.len() > 1 { 170.0 } else { 75.0 },
        height_mm: 100.0,
        columns,
        rows: vec![1.0, 0.95],
        panels,
    }
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
            let curve = error_curve(plan, label, style, |at| {
                simulated.over_seeds(at, |errors| errors.to_reference[node])
            });
            // A node in no cluster has a colour that none of them has.
            let free = identities.n_shown() + style;
            Series { cluster: Some(colours[node].unwrap_or(free)), ..curve }
        } else {
            let label = Label::math("δx").subscript(&(number + 1).to_string()).superscript("c");
            error_curve(plan, label, number, |at| {
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
    let logarithmic = matches!(plan.figure.error_scale, ErrorScale::Log);
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
        y_scale: match plan.figure.error_scale {
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
fn error_curve(
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
            drawn: match plan.figure.spread {
                SpreadKind::Band => SpreadStyle::Band,
                SpreadKind::Bars => SpreadStyle::Bars,
            },
        }),
    }
}
