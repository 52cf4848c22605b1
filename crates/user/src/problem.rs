//! What keeps a command from running: one message with the file, the key and the way out.

use std::fmt;
use std::path::Path;

use crate::text::{one_line, shown};

/// A problem with the input or the surroundings; the command answers it and exits with status 2.
#[derive(Debug)]
pub struct Problem {
    /// File, with line and column where known.
    place: Option<String>,
    message: String,
    hint: Option<String>,
    /// What was computed before, and is not lost.
    kept: Option<String>,
    /// Whether it only leaves an experiment out: its data may not be shipped and are not here.
    left_out: bool,
}

/// What can fail for a reason that the user is told.
pub type Result<T> = std::result::Result<T, Problem>;

impl Problem {
    /// A problem in these words.
    pub fn new(message: impl Into<String>) -> Self {
        Self { place: None, message: message.into(), hint: None, kept: None, left_out: false }
    }

    /// A problem with one key of an experiment file.
    pub fn with_key(file: &Path, key: &str, message: impl fmt::Display) -> Self {
        Self::new(format!("`{key}` {message}")).in_file(file)
    }

    /// A problem that another error describes.
    pub fn from_error(message: &str, error: impl fmt::Display) -> Self {
        Self::new(format!("{message}: {error}"))
    }

    /// Names the file at fault, unless a place is named already.
    #[must_use]
    pub fn in_file(self, file: &Path) -> Self {
        self.at(shown(file))
    }

    /// Names the place unless one is named already.
    #[must_use]
    pub fn at(mut self, place: String) -> Self {
        self.place.get_or_insert(place);
        self
    }

    /// The same where the file at fault goes by another name: what was made of options has none that
    /// the user knows.
    #[must_use]
    pub fn renamed(mut self, from: &Path, to: &Path) -> Self {
        let from = shown(from);
        let rest = self.place.as_deref().and_then(|place| place.strip_prefix(&*from));
        if rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(':')) {
            self.place = Some(shown(to));
        }
        self
    }

    /// Marks what is no reason to stop the other experiments.
    #[must_use]
    pub fn left_out(mut self) -> Self {
        self.left_out = true;
        self
    }

    /// Whether it only leaves an experiment out.
    pub fn is_left_out(&self) -> bool {
        self.left_out
    }

    /// Says what was computed before and is not lost.
    #[must_use]
    pub fn kept(mut self, kept: impl Into<String>) -> Self {
        self.kept = Some(kept.into());
        self
    }

    /// Says the way out.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{}: ", one_line(place))?;
        }
        f.write_str(&one_line(&self.message))?;
        if let Some(hint) = &self.hint {
            write!(f, "\n\nhint: {}", one_line(hint))?;
        }
        if let Some(kept) = &self.kept {
            write!(f, "\n\n{kept}")?;
        }
        Ok(())
    }
}

/// The known name nearest to one that was found, if it is near enough to be a slip.
pub fn nearest<'a>(found: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    known
        .into_iter()
        .map(|name| (strsim::damerau_levenshtein(found, name), name))
        .filter(|(distance, name)| *distance <= 1 + name.chars().count() / 3)
        .min()
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_finds_its_key_and_a_stranger_does_not() {
        let known = ["epsilon", "transient", "average"];
        assert_eq!(nearest("epsilom", known), Some("epsilon"));
        assert_eq!(nearest("transeint", known), Some("transient"));
        assert_eq!(nearest("colour", known), None);
    }
}
