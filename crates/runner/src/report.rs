//! `report.txt`: a run in words, in full. The terminal ends in a screen (`closing`); what does not fit
//! there stands here: the prediction beside simulation, every claim, every value that differs from the
//! golden output.

use std::fmt::Write;

use crate::overview;
use crate::table;
use claims::Judged;
use eigensync::Findings;
use eigensync::Warning;
use experiment::Plan;
use golden::Comparison;
use user::text::{one_line, printable};

/// Its name in the results folder.
pub const REPORT: &str = "report.txt";

/// The report of a run; times and memory stand in the summary alone, so that equal runs have equal
/// reports.
pub fn of(
    plan: &Plan,
    findings: &Findings,
    claims: &[Judged],
    warnings: &[Warning],
    comparison: Option<&Comparison>,
) -> String {
    let mut text = format!("{}: {}\n\n", plan.id, one_line(&plan.title));
    text.push_str(&overview::of(plan, findings));
    let rows = findings.simulated.as_ref().map_or(&[][..], |simulated| &simulated.epsilon);
    let agreement = table::agreement(rows.iter().copied().zip(&findings.agreement));
    add_judged(&mut text, claims, agreement.as_deref(), warnings, comparison);
    printable(&text).into_owned()
}

/// Adds what is judged, what must be known beside it, and what became of the golden output.
pub fn add_judged(
    text: &mut String,
    claims: &[Judged],
    agreement: Option<&str>,
    warnings: &[Warning],
    comparison: Option<&Comparison>,
) {
    if !claims.is_empty() {
        add(text, "claims", &table::claims(claims));
        let reasons = claims.iter().filter(|claim| !claim.reason.is_empty());
        for claim in reasons {
            line(text, format_args!("{}: {}", claim.sentence(), one_line(&claim.reason)));
        }
    }
    if let Some(table) = agreement {
        add(text, "prediction against simulation", table);
    }
    if !warnings.is_empty() {
        add(text, "warnings", "");
        for warning in warnings {
            line(text, format_args!("{}: {}", warning.about, one_line(&warning.message)));
        }
    }
    if let Some(comparison) = comparison {
        let lines = comparison.lines();
        let verdict = if comparison.holds() { "holds" } else { "differs" };
        add(text, &format!("the comparison with the golden output {verdict}"), "");
        line(text, format_args!("{} values differ", lines.len()));
        lines.iter().for_each(|moved| line(text, format_args!("{}", one_line(moved))));
    }
}

fn add(text: &mut String, title: &str, content: &str) {
    write!(text, "\n{title}\n").expect("a string takes every line");
    if !content.is_empty() {
        line(text, format_args!("{content}"));
    }
}

fn line(text: &mut String, what: std::fmt::Arguments<'_>) {
    writeln!(text, "{what}").expect("a string takes every line");
}
