//! The files of a figure, made so that nothing in them can cost results: what cannot be drawn is a
//! warning, and so is a fault of ours.

use eigensync::Findings;
use std::panic::{AssertUnwindSafe, catch_unwind};

use experiment::Plan;
use experiment::spec::FigureKind;
use figures::{Drawn, Figure, FigureError, pdf, png};

use crate::curve::DOTS_PER_INCH;
use crate::room::foreseen;
use crate::sweep::sweep;
use crate::{pairs, regions};

/// The files, those that could be made, and what is not as it was asked for.
#[derive(Default)]
pub struct Picture {
    /// As text.
    pub svg: Option<String>,
    /// As pixels.
    pub png: Option<Vec<u8>>,
    /// As pages.
    pub pdf: Option<Vec<u8>>,
    /// What is not as it was asked for.
    pub warnings: Vec<String>,
}

/// The figure of a run; empty where none is asked for.
pub fn picture(plan: &Plan, findings: &Findings) -> Picture {
    if plan.figure.kind == FigureKind::None {
        return Picture::default();
    }
    let mut foreseen = foreseen(plan);
    let letters = &plan.figure.panels;
    let mut picture = files(|| chosen_panels(figure(plan, findings), letters, &mut foreseen));
    foreseen.append(&mut picture.warnings);
    Picture { warnings: foreseen, ..picture }
}

/// The files of a figure, as far as it can be made.
pub fn files(figure: impl FnOnce() -> Figure) -> Picture {
    let mut warnings = Vec::new();
    let drawn = guarded(|| figure().drawn().map_err(|error| error.to_string()));
    let svg = match drawn {
        Ok(Drawn { svg, left_out }) => {
            warnings.extend(left_out.iter().map(|error| format!("{error}: it is left empty")));
            Some(svg)
        }
        Err(reason) => {
            warnings.push(format!("there is none: {reason}"));
            None
        }
    };
    let mut made = |file: &str, from_svg: &dyn Fn(&str) -> Result<Vec<u8>, FigureError>| {
        let svg = svg.as_deref()?;
        let made = guarded(|| from_svg(svg).map_err(|error| error.to_string()));
        made.map_err(|reason| warnings.push(format!("{file} is missing: {reason}"))).ok()
    };
    let png = made("figure.png", &|svg| png(svg, DOTS_PER_INCH));
    let pdf = made("figure.pdf", &pdf);
    Picture { svg, png, pdf, warnings }
}

/// The figure with the panels that are asked for; the whole of it where it has none of them.
fn chosen_panels(whole: Figure, letters: &[String], warnings: &mut Vec<String>) -> Figure {
    let has = |letter: &&String| whole.panels.iter().any(|p| p.letter == format!("({letter})"));
    let missing: Vec<&str> =
        letters.iter().filter(|letter| !has(letter)).map(String::as_str).collect();
    if !missing.is_empty() {
        let all: Vec<&str> =
            whole.panels.iter().map(|p| p.letter.trim_matches(['(', ')'])).collect();
        let (missing, all) = (missing.join(", "), all.join(", "));
        warnings.push(format!("there is no panel {missing}: the figure has {all}"));
    }
    whole.only(letters).unwrap_or(whole)
}

/// The last line of defence: panics become reasons.
fn guarded<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|_| Err("drawing it met a fault of eigensync".to_owned()))
}

/// The figure of the kind that the experiment asks for.
fn figure(plan: &Plan, findings: &Findings) -> Figure {
    match (plan.figure_kind(), &findings.simulated) {
        (FigureKind::Matrices, Some(simulated)) => pairs::matrices(plan, findings, simulated),
        (FigureKind::Regions, Some(simulated)) => regions::regions(plan, findings, simulated),
        (FigureKind::Sweep | FigureKind::None, _)
        | (FigureKind::Matrices | FigureKind::Regions, None) => sweep(plan, findings),
    }
}
