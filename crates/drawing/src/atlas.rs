//! An atlas on one page: for each oscillator a square of small curves Λ(σ), from component by row, to
//! component by column.

use experiment::{AtlasPlan, System};
use figures::{
    Content, Figure, Label, Multiple, MultiplesPanel, Panel, Series, Spread, SpreadStyle,
};
use msf::MasterStability;

use crate::picture::{Picture, files};

/// Oscillators side by side.
const COLUMNS: usize = 2;
/// Width of the page and height of each row of oscillators, in mm.
const WIDTH: f64 = 180.0;
const HEIGHT: f64 = 60.0;
/// Range of Λ, in units of the scale of an oscillator, with room for names above where curves begin.
const SHOWN: [f64; 2] = [-1.6, 2.6];
/// How far curves are drawn, in units of the σ of the last zero; of what has none, in units of the σ from
/// which on it lies outside the range.
const BEYOND_ZERO: f64 = 2.0;
const BEYOND_EXIT: f64 = 3.0;

/// The figure of an atlas with the curves of all pairs, in order.
pub fn atlas(plan: &AtlasPlan, curves: &[&MasterStability]) -> Picture {
    files(|| figure(plan, curves))
}

fn figure(plan: &AtlasPlan, curves: &[&MasterStability]) -> Figure {
    let mut curves = curves.iter().copied();
    let n = plan.systems.len();
    let columns = COLUMNS.min(n);
    let panel = |(number, system): (usize, &System)| {
        let own: Vec<&MasterStability> = curves.by_ref().take(system.pairs.len()).collect();
        let (row, column) = (number / columns, number % columns);
        Panel {
            letter: letter(number),
            rows: row..row + 1,
            columns: column..column + 1,
            content: Content::Multiples(multiples(system, &own)),
        }
    };
    let panels: Vec<Panel> = plan.systems.iter().enumerate().map(panel).collect();
    let rows = n.div_ceil(columns);
    Figure {
        title: plan.title.clone(),
        width_mm: WIDTH * columns as f64 / COLUMNS as f64,
        height_mm: HEIGHT * rows as f64,
        columns: vec![1.0; columns],
        rows: vec![1.0; rows],
        panels,
    }
}

/// (a), (b), …, and numbers where there are more.
fn letter(number: usize) -> String {
    let letter = u8::try_from(number).ok().filter(|number| *number < 26);
    letter.map_or_else(|| format!("({})", number + 1), |k| format!("({})", char::from(b'a' + k)))
}

fn multiples(system: &System, curves: &[&MasterStability]) -> MultiplesPanel {
    let scale = scale(curves);
    MultiplesPanel {
        title: Label::text(system.title.as_str()),
        x_label: Label::math("σ"),
        y_label: Label::math("Λ"),
        y_range: SHOWN.map(|share| share * scale),
        columns: system.components.len(),
        multiples: system
            .pairs
            .iter()
            .zip(curves)
            .map(|(pair, curve)| {
                let name = Label::math(&pair.from).with_text(" → ").with_math(&pair.to);
                multiple(name, curve, scale)
            })
            .collect(),
    }
}

/// |Λ(0)|, by which curves of one oscillator are to be read; where that is 0 the size that they come to.
fn scale(curves: &[&MasterStability]) -> f64 {
    let isolated = curves.iter().map(|curve| curve.isolated);
    let certain = isolated.filter(|of| of.mean.abs() > 3.0 * of.standard_error);
    let sizes = || curves.iter().flat_map(|curve| &curve.lambda).map(|lambda| lambda.mean.abs());
    let scale = certain
        .map(|of| of.mean.abs())
        .reduce(f64::max)
        .unwrap_or_else(|| sizes().fold(0.0, f64::max));
    if scale > 0.0 { scale } else { 1.0 }
}

/// Up to which σ a curve is drawn: beyond, it keeps its sign as far as was looked.
fn drawn_to(curve: &MasterStability, scale: f64) -> f64 {
    let last = curve.sigma.last().copied().unwrap_or(1.0);
    let is_inside = |mean: f64| (SHOWN[0] * scale..=SHOWN[1] * scale).contains(&mean);
    let to = match curve.stable.zeros().last() {
        Some(zero) => BEYOND_ZERO * zero.sigma,
        None => {
            let outside = curve.lambda.iter().rev().take_while(|lambda| !is_inside(lambda.mean));
            let from = curve.sigma.len() - outside.count();
            BEYOND_EXIT * curve.sigma.get(from).copied().unwrap_or(last)
        }
    };
    if to > 0.0 { to.min(last) } else { last }
}

fn multiple(name: Label, curve: &MasterStability, scale: f64) -> Multiple {
    let points = || curve.sigma.iter().zip(&curve.lambda);
    let ends = |sign: f64| {
        points().map(|(_, lambda)| lambda.mean + sign * 2.0 * lambda.standard_error).collect()
    };
    let last = curve.sigma.last().copied().unwrap_or(1.0);
    let class = curve.stable.class();
    let name_of_class = Label::text("Γ").subscript(&class.n_zeros.to_string());
    let class = match class.from_origin {
        true => name_of_class.with_text(" from 0"),
        false => name_of_class,
    };
    Multiple {
        name: name.with_text(", ").with(class),
        series: Series {
            x: points().map(|(sigma, _)| *sigma).collect(),
            y: points().map(|(_, lambda)| lambda.mean).collect(),
            spread: Some(Spread { lower: ends(-1.0), upper: ends(1.0), drawn: SpreadStyle::Band }),
            ..Series::default()
        },
        x_range: [0.0, drawn_to(curve, scale)],
        shaded: curve
            .stable
            .intervals
            .iter()
            .map(|interval| [interval.lower(), interval.upper().unwrap_or(2.0 * last)])
            .collect(),
    }
}
