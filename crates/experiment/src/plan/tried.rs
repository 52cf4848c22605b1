//! Equations tried where orbits begin and where they go: what is not finite there would end every run, or
//! make numbers of nothing, and exponents do not know the jumps of a flow.

use dynamics::{InstructionSet, Linearised, LinearisedMut, NodeDynamics, isolated_states};
use eigensync::numbers::{four_digits, plain};
use user::{Problem, Result};

use super::checker::Checker;
use super::node::{Node, formulas_of};
use crate::spec::OscillatorSpec;

/// States of the box in which orbits begin that are tried.
const STATES: usize = 512;
/// Steps of an orbit that is followed, and from one state that is tried to the next.
const STEPS: usize = 20_000;
const STRIDE: usize = 40;
/// Steps before it is on its attractor, more or less.
const BEFORE: usize = 2_000;
/// A flow jumps where in one step it changes by this share of its size more than its derivatives say.
const JUMP: f64 = 0.05;

/// States component by component, and where they are from.
struct States {
    values: Vec<Vec<f64>>,
    from: &'static str,
}

impl Checker<'_> {
    /// Refuses equations, and what nodes send, that are not finite where orbits begin or go, and a coupling
    /// that couples nothing. Returns what is doubtful.
    pub(super) fn tried(&self, node: &Node, step: f64) -> Result<Option<String>> {
        let (dynamics, seed) = (node.dynamics(), self.experiment.seed);
        let n = dynamics.start().len();
        let drawn = dynamics::initial_states(dynamics.start(), STATES, seed);
        let begin = |c: usize| drawn.iter().skip(c).step_by(n).copied().collect();
        let begin = States {
            values: (0..n).map(begin).collect(),
            from: "states of `start`, where orbits begin",
        };
        let mut couples = self.finite_at(node, &begin)?;
        let Ok(orbit) = isolated_states(dynamics, step, STEPS, seed) else { return Ok(None) };
        self.goes_on(node, &orbit, step)?;
        let tried: Vec<&Vec<f64>> = orbit.iter().step_by(STRIDE).collect();
        let along = States {
            values: (0..n).map(|c| tried.iter().map(|state| state[c]).collect()).collect(),
            from: "states along an isolated orbit",
        };
        couples |= self.finite_at(node, &along)?;
        if !couples {
            let message = "couples nothing: its derivative is zero wherever it was tried";
            return Err(self.problem("coupling.function", message));
        }
        Ok(jump(dynamics, &orbit, step))
    }

    /// Refuses what is not finite at some states; says whether what is sent depends on any of them.
    fn finite_at(&self, node: &Node, states: &States) -> Result<bool> {
        let dynamics = node.dynamics();
        let (flow, sent) = evaluated(node, &states.values);
        for (component, output) in dynamics.components().iter().zip(&flow) {
            self.finite(&key_of(node, component), (dynamics, states), output)?;
        }
        let components = dynamics.components();
        for (output, gain) in sent.iter().zip(node.equations.coupling.gains()) {
            let key = format!("coupling.function.{}", components[gain.equation]);
            self.finite(&key, (dynamics, states), output)?;
        }
        Ok(sent.iter().any(|[_, tangents]| tangents.iter().any(|&tangent| tangent != 0.0)))
    }

    fn finite(
        &self,
        key: &str,
        (dynamics, states): (&dyn NodeDynamics, &States),
        [values, tangents]: &[Vec<f64>; 2],
    ) -> Result<()> {
        for (what, numbers) in [("", values), ("the derivative of it ", tangents)] {
            let Some(at) = numbers.iter().position(|number| !number.is_finite()) else { continue };
            let state: Vec<f64> = states.values.iter().map(|component| component[at]).collect();
            let message = format!(
                "{what}is {} at {}, and not finite at {} of {} {}",
                numbers[at],
                in_words(dynamics, &state),
                numbers.iter().filter(|number| !number.is_finite()).count(),
                numbers.len(),
                states.from
            );
            return Err(self.problem_in_text(key, None, message).hint(WAY_OUT));
        }
        Ok(())
    }

    /// Refuses equations that lose their value on the way: an orbit that ends not because it is far away.
    fn goes_on(&self, node: &Node, orbit: &[Vec<f64>], step: f64) -> Result<()> {
        let dynamics = node.dynamics();
        let (Some(last), true) = (orbit.last(), orbit.len() <= STEPS) else { return Ok(()) };
        // Where the points of the next step may lie, nearly.
        let states: Vec<Vec<f64>> = last.iter().map(|&x| vec![x]).collect();
        let slope: Vec<f64> =
            evaluated(node, &states).0.iter().map(|[value, _]| value[0]).collect();
        let ahead = |by: f64| -> Vec<Vec<f64>> {
            last.iter().zip(&slope).map(|(x, slope)| vec![x + by * slope]).collect()
        };
        let by: &[f64] = if dynamics.is_map() { &[0.0] } else { &[0.0, 0.5, 1.0] };
        for by in by {
            let at = ahead(by * step);
            let (flow, _) = evaluated(node, &at);
            let components = dynamics.components();
            let lost = components.iter().zip(&flow).find(|(_, [value, _])| value[0].is_nan());
            if let Some((component, _)) = lost {
                let state: Vec<f64> = at.iter().map(|component| component[0]).collect();
                let message = format!(
                    "has no value at {}, where an isolated orbit comes at time {}",
                    in_words(dynamics, &state),
                    plain((orbit.len() as f64 * step * 1e6).round() / 1e6)
                );
                let problem: Problem =
                    self.problem_in_text(&key_of(node, component), None, message);
                return Err(problem.hint(WAY_OUT));
            }
        }
        Ok(())
    }
}

const WAY_OUT: &str = "write it so that it has a value everywhere, with if(…, …, …) or max(…, …), or let \
                       orbits begin elsewhere";

/// The key of a component's equation.
fn key_of(node: &Node, component: &str) -> String {
    match &node.oscillator {
        OscillatorSpec::Custom(equations) => {
            format!("oscillator.custom.{}.{component}", formulas_of(equations))
        }
        OscillatorSpec::Known { name, .. } => format!("oscillator.{name}"),
    }
}

fn in_words(dynamics: &dyn NodeDynamics, state: &[f64]) -> String {
    let named = dynamics.components().into_iter().zip(state);
    let each: Vec<String> =
        named.map(|(name, x)| format!("{name} = {}", four_digits(*x))).collect();
    each.join(", ")
}

/// F with its derivative along all components but a clock, and h likewise, output by output.
type Outputs = Vec<[Vec<f64>; 2]>;

fn evaluated(node: &Node, states: &[Vec<f64>]) -> (Outputs, Outputs) {
    let (dynamics, coupling) = (node.dynamics(), &node.equations.coupling);
    let along = |c: usize| vec![f64::from(u8::from(c < dynamics.n_free())); states[0].len()];
    let tangents: Vec<Vec<f64>> = (0..states.len()).map(along).collect();
    let set = InstructionSet::best();
    (
        outputs(states.len(), (states, &tangents), |at, to| dynamics.tangent_flow(set, at, to)),
        outputs(coupling.n_channels(), (states, &tangents), |at, to| coupling.send(set, at, to)),
    )
}

/// So many outputs of states with their tangents, component by component.
fn outputs(
    n: usize,
    (states, tangents): (&[Vec<f64>], &[Vec<f64>]),
    of: impl FnOnce(Linearised<'_>, LinearisedMut<'_, '_>),
) -> Outputs {
    let count = states[0].len();
    let mut outputs = vec![[vec![0.0; count], vec![0.0; count]]; n];
    let (mut value, mut tangent) = (Vec::new(), Vec::new());
    for [of_value, of_tangent] in &mut outputs {
        value.push(of_value.as_mut_slice());
        tangent.push(of_tangent.as_mut_slice());
    }
    let [states, tangents] =
        [states, tangents].map(|rows| rows.iter().map(Vec::as_slice).collect::<Vec<_>>());
    let at = Linearised { value: &states, tangent: &tangents };
    of(at, LinearisedMut { value: &mut value, tangent: &mut tangent });
    outputs
}

/// What is doubtful about a flow that jumps on the way of an orbit: in a step it changes by more than its
/// derivatives at both ends say.
fn jump(dynamics: &dyn NodeDynamics, orbit: &[Vec<f64>], step: f64) -> Option<String> {
    if dynamics.is_map() || orbit.len() < BEFORE + 2 {
        return None;
    }
    let orbit = &orbit[BEFORE..];
    let n = orbit[0].len();
    let component = |c: usize| orbit.iter().map(|state| state[c]).collect::<Vec<f64>>();
    let values: Vec<Vec<f64>> = (0..n).map(component).collect();
    // The direction of each step, that of the last one repeated.
    let along = |values: &Vec<f64>| {
        let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
        steps.chain([0.0]).collect::<Vec<f64>>()
    };
    let tangents: Vec<Vec<f64>> = values.iter().map(along).collect();
    let flow = outputs(n, (&values, &tangents), |at, to| {
        dynamics.tangent_flow(InstructionSet::best(), at, to);
    });
    let size = |at: usize| flow.iter().map(|[slope, _]| slope[at].powi(2)).sum::<f64>().sqrt();
    let typical = (0..orbit.len()).map(size).sum::<f64>() / orbit.len() as f64;
    let jumps = |at: &usize| {
        let unexplained = flow.iter().map(|[slope, change]| {
            let told = 0.5 * (change[*at] + change[at + 1]);
            (slope[at + 1] - slope[*at] - told).powi(2)
        });
        unexplained.sum::<f64>().sqrt() > JUMP * (size(*at).max(size(at + 1)).max(typical))
    };
    let at = (0..orbit.len() - 2).find(jumps)?;
    Some(format!(
        "the flow jumps on the way of an isolated orbit, at time {} near {}: exponents follow derivatives, \
         which do not see jumps, so that Λ, its zeros and all that is predicted may be wrong; smooth the \
         jump, as with tanh(50*x) for sign(x)",
        plain(((BEFORE + at) as f64 * step * 1e6).round() / 1e6),
        in_words(dynamics, &orbit[at])
    ))
}
