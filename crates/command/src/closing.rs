//! How `run` ends: in at most a screen. The verdict, the claims that differ and why, one line for all
//! golden outputs, and where the rest stands.

use std::path::PathBuf;

use crate::output::terminal_size;
use claims::{Judged, Verdict};
use golden::Comparison;
use runner::REPORT;
use runner::table::readable;
use user::text::{one_line, shown};

/// Where no terminal says how large it is.
const SCREEN: [u16; 2] = [24, 100];
/// Continued lines begin with so many blanks.
const INDENT: usize = 4;
/// Most values shown that differ from golden outputs.
const MOVED: usize = 6;

/// What became of one experiment.
pub struct Outcome {
    pub id: String,
    pub place: PathBuf,
    pub claims: Vec<Judged>,
    /// None without a golden output.
    pub comparison: Option<Comparison>,
}

impl Outcome {
    /// Whether all claims and the comparison hold, as far as this run can decide them.
    pub fn holds(&self) -> bool {
        let fails =
            |claim: &Judged| matches!(claim.verdict, Verdict::Differs | Verdict::CannotBeJudged);
        !self.claims.iter().any(fails) && self.comparison.as_ref().is_none_or(Comparison::holds)
    }
}

/// The last screen; `left_out` says which experiments could not be run and why.
pub fn screen(outcomes: &[Outcome], left_out: &[String], took: &str) -> String {
    let [lines, columns] = terminal_size().unwrap_or(SCREEN).map(usize::from);
    // A shell prompts in the last line.
    fitting(outcomes, left_out, took, [lines.max(2) - 1, columns])
}

fn fitting(
    outcomes: &[Outcome],
    left_out: &[String],
    took: &str,
    [most, columns]: [usize; 2],
) -> String {
    let wrapped = |paragraphs: Vec<String>| wrapped(paragraphs, columns);
    let left_out = left_out.iter().map(|problem| format!("left out: {problem}"));
    let above = wrapped(verdicts(outcomes).into_iter().collect());
    let in_full = format!("{}; {took}", in_full(outcomes));
    let below = wrapped(golden(outcomes).into_iter().chain(left_out).chain([in_full]).collect());
    let room = most.saturating_sub(above.len() + below.len());
    let entries = entries(outcomes).into_iter().map(|entry| wrapped(vec![entry])).collect();
    let mut lines = above;
    lines.extend(as_far_as_fits(entries, room));
    lines.extend(below);
    lines.join("\n")
}

/// The lines of the first entries that fit, and of the others how many they are.
fn as_far_as_fits(entries: Vec<Vec<String>>, room: usize) -> Vec<String> {
    let n_entries = entries.len();
    if entries.iter().map(Vec::len).sum::<usize>() <= room {
        return entries.concat();
    }
    let mut lines = Vec::new();
    let mut n_shown = 0;
    for entry in entries {
        if lines.len() + entry.len() >= room {
            break;
        }
        lines.extend(entry);
        n_shown += 1;
    }
    lines.push(format!("… and {} more that differ", n_entries - n_shown));
    lines
}

/// How many claims have which verdict; nothing without claims.
fn verdicts(outcomes: &[Outcome]) -> Option<String> {
    let claims = || outcomes.iter().flat_map(|outcome| &outcome.claims);
    let count = |verdict| claims().filter(|claim| claim.verdict == verdict).count();
    claims().next()?;
    let mut text = format!(
        "{} claims hold, {} differ as known, {} differ",
        count(Verdict::Holds),
        count(Verdict::DiffersAsKnown),
        count(Verdict::Differs)
    );
    let others =
        [(Verdict::CannotBeJudged, "cannot be judged"), (Verdict::NeedsFullRun, "need a full run")];
    for (verdict, words) in others {
        if count(verdict) > 0 {
            text.push_str(&format!(", {} {words}", count(verdict)));
        }
    }
    Some(text)
}

/// What differs, the gravest first.
fn entries(outcomes: &[Outcome]) -> Vec<String> {
    let of_verdict = |verdict: Verdict| {
        outcomes.iter().flat_map(move |outcome| {
            let claims = outcome.claims.iter().filter(move |claim| claim.verdict == verdict);
            claims.map(|claim| format!("{}: {}", outcome.id, about(claim)))
        })
    };
    let moved = outcomes.iter().flat_map(|outcome| {
        let failures = outcome.comparison.iter().flat_map(Comparison::failures);
        failures.map(|line| format!("{}: {}", outcome.id, one_line(line)))
    });
    let moved: Vec<String> = moved.collect();
    let more = moved.len().saturating_sub(MOVED);
    let more = (more > 0).then(|| format!("… and {more} more values beyond their golden bands"));
    of_verdict(Verdict::Differs)
        .chain(of_verdict(Verdict::CannotBeJudged))
        .chain(moved.into_iter().take(MOVED))
        .chain(more)
        .chain(of_verdict(Verdict::DiffersAsKnown))
        .chain(of_verdict(Verdict::NeedsFullRun))
        .collect()
}

/// A claim that does not hold, and why.
fn about(claim: &Judged) -> String {
    let (mut sentence, reason) = (claim.sentence(), one_line(&claim.reason));
    if let Some(runs) = claim.runs {
        sentence.push_str(&format!(" ({runs})"));
    }
    match claim.verdict {
        Verdict::DiffersAsKnown => format!("{sentence}: as known: {reason}"),
        Verdict::CannotBeJudged => format!("{sentence}: cannot be judged: {reason}"),
        Verdict::NeedsFullRun => format!("{sentence}: needs a full run"),
        Verdict::Differs | Verdict::Holds => {
            let [paper, obtained] = [&claim.paper, &claim.obtained].map(readable);
            let reason = if reason.is_empty() { String::new() } else { format!(" ({reason})") };
            let Judged { verdict, tolerance, .. } = claim;
            format!(
                "{sentence}: {verdict}: expected {paper}, obtained {obtained}, tolerance \
                 {tolerance}{reason}"
            )
        }
    }
}

/// A line for all golden outputs; none without any.
fn golden(outcomes: &[Outcome]) -> Option<String> {
    let compared: Vec<(&str, &Comparison)> = outcomes
        .iter()
        .filter_map(|outcome| Some((&outcome.id[..], outcome.comparison.as_ref()?)))
        .collect();
    if compared.is_empty() {
        return None;
    }
    Some(compared_in_a_line(&compared))
}

/// How comparisons with golden outputs ended.
pub fn compared_in_a_line(compared: &[(&str, &Comparison)]) -> String {
    let of =
        |count: fn(&Comparison) -> usize| compared.iter().map(|(_, c)| count(c)).sum::<usize>();
    let differ: Vec<String> = compared
        .iter()
        .filter(|(_, comparison)| !comparison.holds())
        .map(|(id, comparison)| {
            format!("{} in {} values", one_line(id), comparison.failures().len())
        })
        .collect();
    let verdict = match (compared.len(), differ.len()) {
        (1, 0) => "the golden output holds".to_owned(),
        (all, 0) => format!("all {all} golden outputs hold"),
        (1, _) => format!("the golden output differs: {}", differ.join(", ")),
        (all, n) => format!("{n} of {all} golden outputs differ: {}", differ.join(", ")),
    };
    let mut notes = Vec::new();
    let counts = [
        (of(Comparison::n_within_band), "moved within their bands"),
        (of(|c| c.open().len()), "simulated values need a full run"),
        (of(Comparison::n_not_judged), "are not judged"),
    ];
    for (count, words) in counts {
        if count > 0 {
            notes.push(format!("{count} {words}"));
        }
    }
    if notes.is_empty() { verdict } else { format!("{verdict} ({})", notes.join(", ")) }
}

/// Where everything stands.
fn in_full(outcomes: &[Outcome]) -> String {
    let report = |outcome: &Outcome| shown(outcome.place.join(REPORT));
    match outcomes {
        [] => "nothing was run".into(),
        [one] => format!("in full: {}", report(one)),
        [first, others @ ..] => {
            format!("in full: {}, and so for {} more beside it", report(first), others.len())
        }
    }
}

/// Paragraphs as lines of a screen.
fn wrapped(paragraphs: Vec<String>, columns: usize) -> Vec<String> {
    let mut lines = Vec::new();
    for paragraph in paragraphs {
        let (mut line, mut length) = (String::new(), 0);
        for word in paragraph.split_whitespace() {
            let n_chars = word.chars().count();
            if length > INDENT && length + 1 + n_chars > columns {
                lines.push(std::mem::take(&mut line));
                line = " ".repeat(INDENT);
                length = INDENT;
            } else if length > 0 {
                line.push(' ');
                length += 1;
            }
            line.push_str(word);
            length += n_chars;
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn outcome(id: &str, claims: &[(Verdict, &str)]) -> Outcome {
        let claim = |(verdict, reason): &(Verdict, &str)| Judged {
            name: "four_clusters_at_5_65".into(),
            source: String::new(),
            paper: json!(1.0),
            obtained: json!(2.0),
            uncertainty: None,
            runs: None,
            refined: None,
            tolerance: "± 0.1".into(),
            verdict: *verdict,
            reason: (*reason).into(),
        };
        let claims = claims.iter().map(claim).collect();
        Outcome { id: id.into(), place: format!("results/{id}").into(), claims, comparison: None }
    }

    #[test]
    fn a_name_keeps_its_decimals() {
        let mut claim = outcome("a", &[(Verdict::Differs, "")]).claims.remove(0);
        assert_eq!(claim.sentence(), "four clusters at 5.65");
        claim.name = "two pairs at ε = 4.10, modes_2_to_6".into();
        assert_eq!(claim.sentence(), "two pairs at ε = 4.10, modes 2 to 6");
    }

    #[test]
    fn nothing_is_said_of_claims_and_golden_outputs_where_there_are_none() {
        let said = fitting(&[outcome("a", &[])], &[], "1.0 s", [23, 80]);
        assert_eq!(said, "in full: results/a/report.txt; 1.0 s");
    }

    #[test]
    fn a_screen_has_room_for_the_gravest_and_counts_the_rest() {
        let long = "because ".repeat(30);
        let known = [(Verdict::DiffersAsKnown, &long[..]); 20];
        let outcomes = [outcome("a", &known), outcome("b", &[(Verdict::Differs, "")])];
        let said = fitting(&outcomes, &["c".into()], "1.0 s", [23, 80]);
        let lines: Vec<&str> = said.lines().collect();
        assert!(lines.len() <= 23, "{said}");
        assert!(lines.iter().all(|line| line.chars().count() <= 80), "{said}");
        assert_eq!(lines[0], "0 claims hold, 20 differ as known, 1 differ");
        assert!(lines[1].starts_with("b: four clusters at 5.65: differs: expected 1, obtained 2"));
        assert!(said.contains("more that differ\nleft out: c\nin full: results/a/report.txt, and"));
    }

    #[test]
    fn all_that_fits_is_said() {
        let known = [(Verdict::DiffersAsKnown, "so"); 21];
        let said = fitting(&[outcome("a", &known)], &[], "1.0 s", [23, 80]);
        assert_eq!(said.lines().count(), 23, "{said}");
        assert!(!said.contains("more"), "{said}");
    }
}
