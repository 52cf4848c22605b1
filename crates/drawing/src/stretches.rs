//! Stretches of ε over which the predicted clusters stay as they are: what is seen of a cascade. Its
//! states also part where the clusters stay and some of them are no longer exact.

use std::ops::Range;

use clustering::State;
use figures::{Label, told_apart};

/// States that follow one another and have the same clusters.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// Their positions.
    pub states: Range<usize>,
    /// Open range of ε of all of them, from below; without an upper end where it is unbounded.
    pub epsilon: (f64, Option<f64>),
}

/// The stretches of a cascade, from the largest ε down.
pub fn stretches(states: &[State]) -> Vec<Stretch> {
    let mut stretches: Vec<Stretch> = Vec::new();
    for (number, state) in states.iter().enumerate() {
        match stretches.last_mut() {
            Some(last) if states[last.states.start].clusters == state.clusters => {
                last.states.end = number + 1;
                last.epsilon.0 = state.epsilon.0;
            }
            _ => stretches.push(Stretch { states: number..number + 1, epsilon: state.epsilon }),
        }
    }
    stretches
}

/// The range of ε of the stretch that a state is in, as an inequality, in the numbers that the cascade
/// panel has at its ends.
pub fn range(stretches: &[Stretch], state: usize) -> Label {
    let Some(place) = stretches.iter().position(|stretch| stretch.states.contains(&state)) else {
        return Label::default();
    };
    // Stretches follow one another, so that each lower end is the upper one of the next.
    let first = stretches[0].epsilon.1;
    let lower_ends = stretches.iter().map(|stretch| stretch.epsilon.0);
    let numbers = told_apart(&first.into_iter().chain(lower_ends).collect::<Vec<_>>());
    let lower = place + usize::from(first.is_some());
    let (epsilon, from) = (Label::math("ε"), numbers[lower].clone());
    match lower.checked_sub(1).map(|upper| numbers[upper].clone()) {
        Some(to) => from.with_math(" < ").with(epsilon).with_math(" < ").with(to),
        None => epsilon.with_math(" > ").with(from),
    }
}

#[cfg(test)]
pub mod tests {
    use std::sync::Arc;

    use clustering::Partition;

    use super::*;

    /// A state over a range of ε in which nodes with equal marks are together.
    pub fn state(epsilon: (f64, Option<f64>), marks: &[usize]) -> State {
        let clusters = Arc::new(Partition::from_marks(marks));
        State {
            epsilon,
            unstable_modes: Vec::new(),
            n_unstable: (0, 0),
            cells: Arc::clone(&clusters),
            clusters,
            coincidences: None,
            truncated: false,
        }
    }

    #[test]
    fn states_that_differ_in_exactness_alone_are_one_stretch() {
        let states = [
            state((3.0, None), &[0, 0, 0]),
            state((2.0, Some(3.0)), &[0, 0, 1]),
            state((1.0, Some(2.0)), &[0, 0, 1]),
            state((0.0, Some(1.0)), &[0, 1, 2]),
        ];
        let seen: Vec<_> = stretches(&states).into_iter().map(|s| (s.states, s.epsilon)).collect();
        let expected = [(0..1, (3.0, None)), (1..3, (1.0, Some(3.0))), (3..4, (0.0, Some(1.0)))];
        assert_eq!(seen, expected);
    }

    #[test]
    fn a_range_has_as_many_digits_as_tell_its_ends_apart() {
        let ends = [(1.08312, None), (1.08107, Some(1.08312)), (0.0, Some(1.08107))];
        let clusters: [&[usize]; 3] = [&[0, 0, 0], &[0, 0, 1], &[0, 1, 2]];
        let states: Vec<_> = ends.into_iter().zip(clusters).map(|(e, c)| state(e, c)).collect();
        let seen = stretches(&states);
        let epsilon = || Label::math("ε");
        let number = Label::text;
        assert_eq!(range(&seen, 0), epsilon().with_math(" > ").with(number("1.083")));
        let between = number("1.081").with_math(" < ").with(epsilon()).with_math(" < ");
        assert_eq!(range(&seen, 1), between.with(number("1.083")));
    }
}
