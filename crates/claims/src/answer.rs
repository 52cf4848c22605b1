//! Whether what was obtained is what is claimed.

/// Whether a claim holds, and why it cannot be told where it cannot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// It does.
    Holds,
    /// It does not.
    Differs,
    /// There is nothing of which the claim could hold.
    NothingToJudge,
    /// For this reason.
    CannotBeJudged(String),
}

impl Answer {
    /// Of a claim that must hold of each of several things: one that differs decides, and then one
    /// that cannot be judged. Of nothing, nothing holds.
    pub fn of_all(answers: impl Iterator<Item = Self>) -> Self {
        let mut all = Self::NothingToJudge;
        for answer in answers {
            match answer {
                Self::Differs | Self::NothingToJudge => return Self::Differs,
                Self::CannotBeJudged(_) => all = answer,
                Self::Holds if all == Self::NothingToJudge => all = Self::Holds,
                Self::Holds => {}
            }
        }
        all
    }
}

impl From<bool> for Answer {
    fn from(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::Differs }
    }
}
