//! What a piece of work is known by: the SHA-256 of all that its result depends on.
//!
//! The program is part of it, since its next version may compute otherwise; titles, claims, figures,
//! threads and vector instructions are not. So an experiment file that was edited takes over what the
//! edit does not concern, and nothing else.

use std::fmt;

use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::Kind;

/// Raised when the payload of a kind changes its form while the program keeps its version.
const FORM: u32 = 3;

/// The key of one piece of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Key(pub [u8; 32]);

impl Key {
    /// The key of a kind of work that depends on some content, done by some program.
    pub fn of(program: &str, kind: Kind, content: &impl Serialize) -> Self {
        let all = (FORM, program, kind as u8, content);
        let bytes = postcard::to_stdvec(&all).expect("plain data can be written down");
        Self(Sha256::digest(bytes).into())
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_changes_with_its_kind_and_with_every_bit_of_its_content() {
        let keys = [
            Key::of("program", Kind::Replica, &(0.1, 7u64)),
            Key::of("program", Kind::Curve, &(0.1, 7u64)),
            Key::of("program", Kind::Replica, &(0.1f64.next_up(), 7u64)),
            Key::of("program", Kind::Replica, &(-0.1, 7u64)),
            Key::of("program", Kind::Replica, &(0.1, 8u64)),
            Key::of("another", Kind::Replica, &(0.1, 7u64)),
        ];
        for (position, key) in keys.iter().enumerate() {
            assert!(!keys[..position].contains(key), "{position}");
        }
        assert_eq!(keys[0], Key::of("program", Kind::Replica, &(0.1, 7u64)));
    }
}
