//! What an experiment file is checked with: the file in its forms, and problems that name their place in it.

use std::ops::Range;
use std::path::Path;

use serde_json::Value;
use user::{Problem, Stages};

use crate::load::{self, Document};
use crate::spec::Experiment;

/// `--quick` divides the times of sweeps and of the MSF by this.
pub const QUICK: f64 = 10.0;

/// By how much times are shortened.
pub(super) fn shortening(quick: bool) -> f64 {
    if quick { QUICK } else { 1.0 }
}

/// An experiment file under examination.
pub(super) struct Checker<'a> {
    pub(super) file: &'a Path,
    pub(super) experiment: &'a Experiment,
    /// The same as a document, defaults left out.
    pub(super) written: &'a Value,
    /// Its text.
    pub(super) text: &'a str,
    /// The system of an atlas that it is about.
    pub(super) system: Option<&'a str>,
    pub(super) shortened: f64,
    pub(super) stages: &'a Stages,
}

impl<'a> Checker<'a> {
    pub(super) fn of(
        document: &'a Document,
        file: &'a Path,
        shortened: f64,
        stages: &'a Stages,
    ) -> Self {
        let Document { experiment, written, text } = document;
        Self { file, experiment, written, text, system: None, shortened, stages }
    }
}

impl Checker<'_> {
    pub(super) fn problem(&self, key: &str, message: impl std::fmt::Display) -> Problem {
        Problem::with_key(self.file, &self.key(key), message)
    }

    /// A key as it stands in the file: in an atlas each system has its own oscillator and step.
    pub(super) fn key(&self, key: &str) -> String {
        let is_of_system = key.starts_with("oscillator") || key.starts_with("published");
        match self.system {
            Some(system) if key == "msf.step" => format!("atlas.{system}.step"),
            Some(system)
                if key == "msf.average"
                    && self.written["atlas"][system].get("average").is_some() =>
            {
                format!("atlas.{system}.average")
            }
            Some(system) if is_of_system => format!("atlas.{system}.{key}"),
            _ => key.to_owned(),
        }
    }

    /// A problem with some bytes of a text that is the value of a key.
    pub(super) fn problem_in_text(
        &self,
        key: &str,
        bytes: Option<&Range<usize>>,
        message: impl std::fmt::Display,
    ) -> Problem {
        let key = self.key(key);
        let problem = Problem::new(format!("`{key}`: {message}"));
        let place = |key: &str| load::place_in_text((self.file, self.text), key, bytes);
        // A file with an oscillator alone may leave its table out.
        let alone = key.strip_prefix("oscillator.custom.").and_then(place);
        match place(&key).or(alone) {
            Some(place) => problem.at(place),
            None => problem.in_file(self.file),
        }
    }
}
