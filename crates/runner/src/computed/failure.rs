//! What keeps a plan from being done.

use eigensync::Error;

/// Why there are no findings.
pub enum Failure {
    /// The study cannot be done, or was stopped.
    Study(Error),
    /// States on the way cannot be written.
    States(std::io::Error),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Study(error)
    }
}
