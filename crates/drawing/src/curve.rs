//! Λ(σ), as a panel and as a figure of its own.

use eigensync::numbers::three_digits;
use figures::{Content, Figure, FigureError, LinePanel, MsfCurve, Panel, msf_panel, pdf, png};
use msf::MasterStability;

/// Resolution of the PNG: what journals ask for.
pub const DOTS_PER_INCH: f64 = 300.0;

/// The files of the figure of a curve alone, or why there is none.
pub fn curve_alone(
    title: &str,
    msf: &MasterStability,
) -> Vec<(&'static str, Result<Vec<u8>, String>)> {
    let content = Content::Lines(panel(msf));
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
    let from_svg = |make: &dyn Fn(&str) -> Result<Vec<u8>, FigureError>| {
        svg.clone().and_then(|svg| make(&svg).map_err(|error| error.to_string()))
    };
    let (png, pdf) = (from_svg(&|svg| png(svg, DOTS_PER_INCH)), from_svg(&pdf));
    vec![
        ("figure.svg", svg.clone().map(String::into_bytes)),
        ("figure.png", png),
        ("figure.pdf", pdf),
    ]
}

/// Λ(σ) with its stable set and its zeros.
pub fn panel(msf: &MasterStability) -> LinePanel {
    msf_panel(&MsfCurve {
        sigma: msf.sigma.clone(),
        lambda: msf.lambda.iter().map(|lambda| lambda.mean).collect(),
        standard_error: msf.lambda.iter().map(|lambda| lambda.standard_error).collect(),
        stable: msf.stable.intervals.iter().map(|i| (i.lower(), i.upper())).collect(),
        zeros: msf.stable.zeros().map(|zero| (zero.sigma, three_digits(zero.sigma))).collect(),
    })
}
