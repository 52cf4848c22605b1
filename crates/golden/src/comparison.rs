//! How a summary differs from its golden output: what fails, what a full run decides, what moved within
//! its band, and what is not judged.

/// Most failures shown unless all are asked for.
const SHOWN: usize = 12;

/// Differences, each in a line of its own, in the order of the golden output.
#[derive(Default)]
pub struct Comparison {
    failures: Vec<String>,
    /// Simulated quantities of a quick run, whose averages are too short to tell.
    open: Vec<String>,
    within_band: Vec<String>,
    not_judged: Vec<String>,
}

/// What a difference means.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    Failure,
    /// A full run decides.
    Open,
    WithinBand,
    NotJudged,
}

impl Comparison {
    /// Whether nothing differs beyond what is allowed.
    pub fn holds(&self) -> bool {
        self.failures.is_empty()
    }

    /// What differs beyond all that is allowed.
    pub fn failures(&self) -> &[String] {
        &self.failures
    }

    /// The first of them, and whether there are more.
    pub fn first_failures(&self) -> Vec<&str> {
        let shown = self.failures.iter().take(SHOWN).map(|line| &line[..]);
        let more = (self.failures.len() > SHOWN).then_some("… and more: `--all` has them");
        shown.chain(more).collect()
    }

    /// What a quick run leaves to a full one.
    pub fn open(&self) -> &[String] {
        &self.open
    }

    /// How many values moved within their bands.
    pub fn n_within_band(&self) -> usize {
        self.within_band.len()
    }

    /// How many values differ that are not judged.
    pub fn n_not_judged(&self) -> usize {
        self.not_judged.len()
    }

    /// Every difference, failures first.
    pub fn lines(&self) -> Vec<&str> {
        let Self { failures, open, within_band, not_judged } = self;
        [failures, open, within_band, not_judged].into_iter().flatten().map(|l| &l[..]).collect()
    }

    /// Adds a difference.
    pub fn add(&mut self, meaning: Meaning, line: String) {
        match meaning {
            Meaning::Failure => self.failures.push(line),
            Meaning::Open => self.open.push(format!("{line}: a full run decides")),
            Meaning::WithinBand => self.within_band.push(line),
            Meaning::NotJudged => self.not_judged.push(format!("{line}: not judged")),
        }
    }
}
