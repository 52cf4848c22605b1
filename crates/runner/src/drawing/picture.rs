//! The files of a figure, made so that nothing in them can cost results: what cannot be drawn is a
//! warning, and so is a fault of ours.

use eigensync::Findings;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::{DOTS_PER_INCH, figure, foreseen};
use crate::plan::Plan;
use crate::spec::FigureKind;
use figures::{Drawn, png};

/// The files, those that could be made, and what is not as it was asked for.
#[derive(Default)]
pub struct Picture {
    pub svg: Option<String>,
    pub png: Option<Vec<u8>>,
    pub warnings: Vec<String>,
}

/// The figure of a run; empty where none is asked for.
pub fn picture(plan: &Plan, findings: &Findings) -> Picture {
    if plan.figure().kind == FigureKind::None {
        return Picture::default();
    }
    let mut warnings = foreseen(plan);
    let svg = match guarded(|| figure(plan, findings).drawn().map_err(|error| error.to_string())) {
        Ok(Drawn { svg, left_out }) => {
            warnings.extend(left_out.iter().map(|error| format!("{error}: it is left empty")));
            Some(svg)
        }
        Err(reason) => {
            warnings.push(format!("there is none: {reason}"));
            None
        }
    };
    let png = svg.as_deref().and_then(|svg| {
        let made = guarded(|| png(svg, DOTS_PER_INCH).map_err(|error| error.to_string()));
        made.map_err(|reason| warnings.push(format!("figure.png is missing: {reason}"))).ok()
    });
    Picture { svg, png, warnings }
}

/// The last line of defence: panics become reasons.
fn guarded<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|_| Err("drawing it met a fault of eigensync".to_owned()))
}
