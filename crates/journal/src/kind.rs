//! What there is to keep.

/// Kinds of records. Their numbers stand in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Kind {
    /// A run that began: what comes after it is its work.
    Begun = 1,
    /// The first look of `predict` at Λ.
    Look = 2,
    /// Λ(σ) with its zeros.
    Curve = 3,
    /// Eigenvalues and eigenvectors.
    Spectrum = 4,
    /// The outcome of one replica.
    Replica = 5,
    /// The state of a replica that still runs; in files of their own.
    Snapshot = 6,
    /// What the step of the integrator does to simulated errors.
    StepEffects = 7,
    /// States of a replica on the way; in files of their own.
    States = 8,
}

impl Kind {
    const ALL: [Self; 8] = [
        Self::Begun,
        Self::Look,
        Self::Curve,
        Self::Spectrum,
        Self::Replica,
        Self::Snapshot,
        Self::StepEffects,
        Self::States,
    ];

    /// The kind of a number that stands in a file.
    pub fn of(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| *kind as u8 == number)
    }
}
