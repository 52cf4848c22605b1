//! An order of named subexpressions in which each comes after those it is made of.

use crate::expression::Expression;
use crate::symbol::Symbol;

/// How far the search has come with a subexpression.
#[derive(Clone, Copy, PartialEq)]
enum State {
    New,
    /// It waits for those it is made of.
    Open,
    Done,
}

/// The order, or a cycle: subexpressions of which each is made of the next, the first once more at the
/// end.
pub(crate) fn in_order(formulas: &[Expression<Symbol>]) -> Result<Vec<usize>, Vec<usize>> {
    let uses: Vec<Vec<usize>> = formulas.iter().map(subexpressions).collect();
    let mut states = vec![State::New; formulas.len()];
    let mut order = Vec::new();
    for first in 0..formulas.len() {
        if states[first] == State::New {
            search(first, &uses, &mut states, &mut order)?;
        }
    }
    Ok(order)
}

/// Goes down from one subexpression, depth first.
fn search(
    first: usize,
    uses: &[Vec<usize>],
    states: &mut [State],
    order: &mut Vec<usize>,
) -> Result<(), Vec<usize>> {
    let mut path = vec![(first, 0)];
    states[first] = State::Open;
    while let Some((at, next)) = path.last_mut() {
        let Some(&to) = uses[*at].get(*next) else {
            states[*at] = State::Done;
            order.push(*at);
            path.pop();
            continue;
        };
        *next += 1;
        match states[to] {
            State::Done => {}
            State::New => {
                states[to] = State::Open;
                path.push((to, 0));
            }
            State::Open => {
                let from = path.iter().position(|(at, _)| *at == to).unwrap_or(0);
                let cycle = path[from..].iter().map(|(at, _)| *at);
                return Err(cycle.chain([to]).collect());
            }
        }
    }
    Ok(())
}

/// Subexpressions that a formula uses, each once.
fn subexpressions(formula: &Expression<Symbol>) -> Vec<usize> {
    let mut used: Vec<usize> = formula
        .names()
        .filter_map(|symbol| match symbol {
            Symbol::Subexpression(s) => Some(*s),
            _ => None,
        })
        .collect();
    used.sort_unstable();
    used.dedup();
    used
}
