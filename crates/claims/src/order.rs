//! In which order clusters are lost as ε falls.

use serde_json::{Value, json};

use crate::answer::Answer;

/// Whether clusters that are lost somewhere between two ε each are lost in this order as ε falls. Two
/// that are known to be lost together have no order; of two that overlap it is not known.
pub fn follows(order: &[usize], lost: &[[f64; 2]], exactly: bool) -> Answer {
    let one_after_other = |pair: &[usize]| {
        let ([low, high], [next_low, next_high]) = (lost[pair[0] - 1], lost[pair[1] - 1]);
        if low >= next_high && low > next_low {
            Answer::Holds
        } else if exactly || high <= next_low {
            Answer::Differs
        } else {
            Answer::CannotBeJudged(format!(
                "clusters {} and {} are lost too near each other to tell which is first",
                pair[0], pair[1]
            ))
        }
    };
    Answer::of_all(order.windows(2).map(one_after_other))
}

/// The order in which clusters are lost as ε falls, from 1; those without an order among them stand
/// together, in words.
pub fn order_shown(lost: &[[f64; 2]], exactly: bool) -> Vec<Value> {
    let middle = |position: &usize| 0.5 * (lost[position - 1][0] + lost[position - 1][1]);
    let mut order: Vec<usize> = (1..=lost.len()).collect();
    order.sort_by(|a, b| middle(b).total_cmp(&middle(a)));
    let is_ordered = |a: &usize, b: &usize| follows(&[*a, *b], lost, exactly) == Answer::Holds;
    let shown = |group: &[usize]| match group {
        [single] => json!(single),
        several => {
            let texts: Vec<String> = several.iter().map(usize::to_string).collect();
            let how = if exactly { "lost together" } else { "lost too near each other" };
            json!(format!("{} {how}", texts.join(" and ")))
        }
    };
    order.chunk_by(|a, b| !is_ordered(a, b)).map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clusters_lost_together_are_in_no_order() {
        let lost = [[2.0, 2.0], [2.0, 2.0], [1.0, 1.0]];
        assert_eq!(follows(&[1, 2, 3], &lost, true), Answer::Differs);
        assert_eq!(follows(&[1, 3], &lost, true), Answer::Holds);
        assert_eq!(follows(&[3, 1], &lost, true), Answer::Differs);
    }

    #[test]
    fn clusters_lost_together_are_shown_together_and_not_in_the_claimed_order() {
        let at = |epsilon: f64| [epsilon, epsilon];
        assert_eq!(order_shown(&[at(2.0), at(2.0)], true), [json!("1 and 2 lost together")]);
        let shown = order_shown(&[at(1.0), at(3.0), at(1.0)], true);
        assert_eq!(shown, [json!(2), json!("1 and 3 lost together")]);
        assert_eq!(order_shown(&[at(1.0), at(3.0), at(2.0)], true), [2, 3, 1].map(|k| json!(k)));
        // Of simulated ones that overlap none is known to be the first.
        let shown = order_shown(&[[1.0, 2.0], [3.0, 4.0], [1.0, 2.0]], false);
        assert_eq!(shown, [json!(2), json!("1 and 3 lost too near each other")]);
    }

    #[test]
    fn simulated_losses_that_overlap_or_lie_below_the_sweep_are_in_no_known_order() {
        let unknown = |lost: [[f64; 2]; 2]| {
            [[1, 2], [2, 1]]
                .map(|order| follows(&order, &lost, false))
                .iter()
                .all(|answer| matches!(answer, Answer::CannotBeJudged(_)))
        };
        assert!(unknown([[1.0, 2.0], [1.0, 2.0]]), "between the same points");
        assert!(unknown([[0.0, 1.0], [0.0, 1.0]]), "both below the sweep");
        assert!(unknown([[1.0, 2.0], [1.5, 2.5]]), "means of seeds that overlap");
        assert_eq!(follows(&[1, 2], &[[1.0, 2.0], [0.0, 1.0]], false), Answer::Holds);
        assert_eq!(follows(&[2, 1], &[[1.0, 2.0], [0.0, 1.0]], false), Answer::Differs);
    }
}
