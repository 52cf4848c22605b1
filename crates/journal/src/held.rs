//! How much of a run is kept, in words.

use serde::Serialize;

use crate::Kind;

/// How much of a run's work is in its journal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Held {
    /// The curve Λ(σ).
    pub curve: bool,
    /// How many of these: an atlas has one for each pair.
    pub curves: usize,
    /// The spectrum.
    pub spectrum: bool,
    /// Replicas.
    pub replicas: usize,
    /// States of replicas that had not ended.
    pub states: usize,
}

impl Held {
    /// Counts one piece more.
    pub fn count(&mut self, kind: Kind) {
        match kind {
            Kind::Curve => {
                self.curve = true;
                self.curves += 1;
            }
            Kind::Spectrum => self.spectrum = true,
            Kind::Replica => self.replicas += 1,
            Kind::Begun | Kind::Look | Kind::Snapshot | Kind::StepEffects | Kind::States => {}
        }
    }

    /// In words, replicas as a part of all; empty for nothing.
    pub fn words(&self, all: usize) -> String {
        let mut parts = Vec::new();
        if self.replicas > 0 {
            parts.push(format!("{} of {all} replicas", self.replicas));
        }
        if self.states > 0 {
            let others = if self.replicas > 0 { "others" } else { "replicas" };
            parts.push(format!("the states of {} {others}", self.states));
        }
        parts.extend(match self.curves {
            0 => None,
            1 => Some("the curve".to_owned()),
            curves => Some(format!("{curves} curves")),
        });
        parts.extend(self.spectrum.then(|| "the spectrum".to_owned()));
        match &parts[..] {
            [] => String::new(),
            [first] => first.clone(),
            [first, last] => format!("{first} and {last}"),
            [first, rest @ .., last] => format!("{first}, {} and {last}", rest.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_held_is_said_in_words() {
        let held = |replicas, curve, spectrum| {
            Held { curve, curves: curve.into(), spectrum, replicas, states: 0 }.words(80)
        };
        assert_eq!(held(0, false, false), "");
        assert_eq!(held(37, false, false), "37 of 80 replicas");
        assert_eq!(held(0, true, true), "the curve and the spectrum");
        assert_eq!(Held { curve: true, curves: 5, ..Held::default() }.words(0), "5 curves");
        assert_eq!(held(37, true, true), "37 of 80 replicas, the curve and the spectrum");
        let running = Held { replicas: 3, states: 16, ..Held::default() };
        assert_eq!(running.words(80), "3 of 80 replicas and the states of 16 others");
    }
}
