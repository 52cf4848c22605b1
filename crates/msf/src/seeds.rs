//! Seeds of orbits.

/// The isolated exponent Λ(0) is averaged over this many orbits from different initial states.
pub const ISOLATED_ORBITS: usize = 16;

/// Seeds of orbits.
pub(crate) enum Seeds {
    /// Ever new ones.
    New { first: u64, next: u64 },
    /// The same ones over and over, of orbits that are known to be on one attractor.
    Again { seeds: Vec<u64>, next: usize },
}

impl Seeds {
    pub fn new(seed: u64) -> Self {
        let first = seed.wrapping_mul(1 << 32);
        Self::New { first, next: first }
    }

    pub fn again(seeds: Vec<u64>) -> Self {
        Self::Again { seeds, next: 0 }
    }

    pub fn next(&mut self) -> u64 {
        match self {
            Self::New { next, .. } => {
                *next = next.wrapping_add(1);
                *next
            }
            Self::Again { seeds, next } => {
                *next += 1;
                seeds[(*next - 1) % seeds.len()]
            }
        }
    }

    /// That of the orbit of a first look, whatever came before.
    pub fn of_look(&self) -> u64 {
        match self {
            Self::New { first, .. } => *first,
            Self::Again { seeds, .. } => seeds[0],
        }
    }

    /// Those for an average over orbits, each once.
    pub fn orbits(&mut self) -> impl Iterator<Item = u64> {
        let count = match self {
            Self::New { .. } => ISOLATED_ORBITS,
            Self::Again { seeds, .. } => seeds.len(),
        };
        (0..count).map(move |_| self.next())
    }
}
