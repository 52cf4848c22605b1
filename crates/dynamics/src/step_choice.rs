//! The method with a fixed step, and the step, that cost least at an accuracy that is asked for.
//!
//! What a step errs by is measured. At states along orbits of a pair of oscillators, one step of length h
//! is held against two of h/2:
//!
//! ```text
//! error per unit of time = mean over states of  max_c |Φ_h(x) − Φ_{h/2}(Φ_{h/2}(x))|_c / (size_c h)
//! ```
//!
//! size_c being half the range of a component on the orbit, and the pair's the worst of some σ: isolated, and
//! ẋ_{1,2} = F(x_{1,2}) ± σ/2 [H(x_2) − H(x_1)] up to the σ of the fastest mode of a network, so that nodes
//! are driven by what oscillators send and differences decay as fast as any of it does. Where F has jumps or
//! kinks the measured error tells so, since no formula has to be looked at: it falls too slowly with h for a
//! high order to pay.
//!
//! Source: E. Hairer, S. P. Nørsett & G. Wanner, Solving Ordinary Differential Equations I (1993), Sec. II.4,
//! on errors from two step sizes.

use crate::integrators::fixed::{Fixed, advance};
use crate::tile::{slices, slices_mut};
use crate::{
    Coupling, DynamicsError, InstructionSet, LinearSteps, Method, NodeDynamics, StepVerdict,
    initial_states,
};

/// RK4 at this step is what is taken where nothing is asked for, or where no step is good enough.
const USUAL: f64 = 0.01;
/// States along each orbit, the mean time between them, and the time before the first.
const STATES: usize = 600;
const BETWEEN: f64 = 0.7;
/// Times between states are spread by the golden ratio, so that no cycle is met in a few phases again and
/// again.
const GOLDEN: f64 = 0.618_033_988_749_895;
const SETTLING: f64 = 100.0;
/// Shares of the largest σ.
const SHARES: [f64; 4] = [0.0, 0.02, 0.2, 1.0];
/// Steps are 1/n for n up to these, and n up to the longest.
const MOST: [(Method, u32); 2] = [(Method::Dop853, 400), (Method::Rk4, 2000)];
const LONGEST: u32 = 8;
/// Numbers n that are tried grow by this factor.
const GROWTH: f64 = 1.06;

/// A method and its step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepChoice {
    /// RK4 or DOP853.
    pub method: Method,
    /// In model time units.
    pub step: f64,
    /// Its measured error per unit of time, relative to the size of the attractor.
    pub error: f64,
    /// Whether that is as small as was asked for. Where no step is, the usual one of RK4 is taken.
    pub is_within: bool,
}

/// The method and step that cost least while their error per unit of time stays below a tolerance and they
/// damp what the equations damp.
///
/// - `sigma`: ε|λ| of the fastest mode, a bound or more.
/// - `tolerance`: relative to the size of the attractor, per unit of time.
/// - `seed`: of the orbits.
///
/// # Errors
/// [`DynamicsError::Escaped`] where the isolated orbit does so even at a fine step.
///
/// # Panics
/// For a map, which has no step.
pub fn choose_step(
    (dynamics, coupling): (&dyn NodeDynamics, &Coupling),
    sigma: f64,
    tolerance: f64,
    seed: u64,
) -> Result<StepChoice, DynamicsError> {
    let steps = LinearSteps::along_orbit(dynamics, coupling, USUAL, seed)?;
    let fine = steps.sound_step(sigma, (Method::Rk4, USUAL)).unwrap_or(USUAL);
    let mut pairs = Vec::new();
    for share in SHARES {
        let pair = Pair { dynamics, coupling, sigma: share * sigma };
        // Of those that are driven out of their bounds the run will tell.
        match pair.states(fine, seed) {
            Err(error) if share == 0.0 => return Err(error),
            Err(_) => {}
            Ok(states) => pairs.push((pair, states)),
        }
    }
    let error = |method: Method, step: f64, most: f64| {
        let of =
            |(pair, states): &(Pair<'_>, States)| pair.error(states, (fixed(method), step), most);
        pairs.iter().map(of).fold(0.0, f64::max)
    };
    let is_sound = |method, step| steps.judge(sigma, (method, step)) == StepVerdict::Sound;
    let longest = |(method, most): (Method, u32)| {
        let tried = candidates(most).filter(|&step| is_sound(method, step));
        let mut measured = tried.map(|step| (step, error(method, step, tolerance)));
        let (step, error) = measured.find(|&(_, error)| error <= tolerance)?;
        Some(StepChoice { method, step, error, is_within: true })
    };
    let cost = |choice: &StepChoice| fixed(choice.method).points().len() as f64 / choice.step;
    let chosen = MOST.into_iter().filter_map(longest);
    let usual = || {
        let error = error(Method::Rk4, fine, f64::INFINITY);
        StepChoice { method: Method::Rk4, step: fine, error, is_within: error <= tolerance }
    };
    Ok(chosen.min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or_else(usual))
}

fn fixed(method: Method) -> Fixed {
    method.fixed().expect("both methods have fixed steps")
}

/// Steps from the longest down to 1/most.
fn candidates(most: u32) -> impl Iterator<Item = f64> {
    let next = |&n: &u32| Some(((f64::from(n) * GROWTH) as u32).max(n + 1));
    let parts = std::iter::successors(Some(1), next).take_while(move |&n| n <= most);
    (2..=LONGEST).rev().map(f64::from).chain(parts.map(|n| 1.0 / f64::from(n)))
}

/// Two oscillators that drive one another.
struct Pair<'a> {
    dynamics: &'a dyn NodeDynamics,
    coupling: &'a Coupling,
    sigma: f64,
}

/// States `[component][oscillator]` along an orbit, and half the range of each component, twice.
struct States {
    all: Vec<Vec<f64>>,
    sizes: Vec<f64>,
}

impl Pair<'_> {
    /// States along an orbit that RK4 follows at a fine step.
    fn states(&self, step: f64, seed: u64) -> Result<States, DynamicsError> {
        let (start, n_free) = (self.dynamics.start(), self.dynamics.n_free());
        let drawn = initial_states(start, 2, seed);
        let mut x: Vec<f64> =
            (0..2 * start.len()).map(|k| drawn[k % 2 * start.len() + k / 2]).collect();
        let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; start.len()];
        let mut all = Vec::with_capacity(STATES);
        let mut next = (SETTLING / step) as u64;
        let mut number = 0;
        while all.len() < STATES {
            number += 1;
            advance(Fixed::Rk4, |x, slope| self.slope(x, slope), &mut x, step);
            let radius = self.dynamics.escape_radius();
            if !x.iter().take(2 * n_free).all(|x| x.abs() <= radius) {
                return Err(DynamicsError::Escaped { time: number as f64 * step });
            }
            if number as f64 * step > SETTLING {
                for (range, x) in ranges.iter_mut().zip(x.chunks(2)) {
                    *range = [range[0].min(x[0]).min(x[1]), range[1].max(x[0]).max(x[1])];
                }
            }
            if number > next {
                all.push(x.clone());
                let between = BETWEEN * (0.5 + (GOLDEN * all.len() as f64).fract());
                next += (between / step).ceil() as u64;
            }
        }
        // A component at rest is as large as it is.
        let size = |[least, most]: &[f64; 2]| {
            let (half, largest) = (0.5 * (most - least), least.abs().max(most.abs()));
            half.max(1e-3 * largest).max(f64::MIN_POSITIVE)
        };
        let sizes = ranges[..n_free].iter().flat_map(|range| [size(range); 2]).collect();
        Ok(States { all, sizes })
    }

    /// The error per unit of time of a step, infinite where it is found to be more than what is of use.
    fn error(&self, states: &States, (method, h): (Fixed, f64), most: f64) -> f64 {
        let time = states.all.len() as f64 * h;
        let mut sum = 0.0;
        for state in &states.all {
            let (mut once, mut twice) = (state.clone(), state.clone());
            advance(method, |x, slope| self.slope(x, slope), &mut once, h);
            for _ in 0..2 {
                advance(method, |x, slope| self.slope(x, slope), &mut twice, 0.5 * h);
            }
            let off = once.iter().zip(&twice).zip(&states.sizes);
            sum += off.map(|((a, b), size)| (a - b).abs() / size).fold(0.0, |most, off| {
                // What is no number is as bad as can be.
                if off.is_nan() { f64::INFINITY } else { most.max(off) }
            });
            if sum > most * time {
                return f64::INFINITY;
            }
        }
        sum / time
    }

    /// F(x) ± σ/2 H, component by component.
    fn slope(&self, x: &[f64], slope: &mut [f64]) {
        let set = InstructionSet::Baseline;
        let n = self.dynamics.start().len();
        let at = slices(x.chunks(2));
        let mut to = slices_mut(slope.chunks_mut(2));
        self.dynamics.flow(set, &at[..n], &mut to[..n]);
        let mut sent = vec![0.0; 2 * self.coupling.n_channels()];
        let n_sent = self.coupling.n_channels();
        let mut signals = slices_mut(sent.chunks_mut(2));
        self.coupling.channels().send(set, &at[..n], &mut signals[..n_sent]);
        for gain in self.coupling.gains() {
            let [a, b] = [0, 1].map(|node| signals[gain.channel][node]);
            let input = 0.5 * self.sigma * gain.weight * (b - a);
            to[gain.equation][0] += input;
            to[gain.equation][1] -= input;
        }
    }
}

#[cfg(test)]
mod tests {
    use equations::{Description, System};

    use super::*;
    use crate::{HindmarshRose, Lorenz, Model, Text};

    fn neuron() -> Model {
        Model::HindmarshRose(HindmarshRose::default())
    }

    fn choice(dynamics: &dyn NodeDynamics, sigma: f64, tolerance: f64) -> StepChoice {
        choose_step((dynamics, &Coupling::pair(0, 0)), sigma, tolerance, 1).unwrap()
    }

    #[test]
    fn smooth_oscillators_are_given_long_steps_of_eighth_order_whose_error_is_within_the_tolerance()
    {
        for (model, sigma) in [(neuron(), 7.0), (Model::Lorenz(Lorenz::default()), 10.0)] {
            let StepChoice { method, step, error, is_within } = choice(&model, sigma, 1e-8);
            assert_eq!(method, Method::Dop853);
            assert!(is_within && error <= 1e-8 && step >= 1.0 / 80.0, "{step}: {error}");
            // A looser tolerance takes a longer step, and a step is 1/n or n.
            let looser = choice(&model, sigma, 1e-5);
            assert!(looser.step > step && looser.error > error, "{looser:?}");
            assert!((1.0 / step).fract().min(step.fract()) < 1e-9, "{step}");
        }
    }

    #[test]
    fn a_step_is_short_enough_for_the_fastest_mode() {
        // x into x: a transverse mode decays at a rate of σ and more. An evaluation of RK4 takes that
        // further, 2.785 / 4 against 6.39 / 12.
        let StepChoice { method, step, .. } = choice(&neuron(), 400.0, 1e-4);
        assert!(method == Method::Rk4 && (2.0..2.785).contains(&(400.0 * step)), "{step}");
    }

    #[test]
    fn a_flow_that_jumps_is_told_by_its_error_and_left_to_rk4() {
        // A relay that drives an oscillator: ẍ = −0.2ẋ − x + sign(sin t), with sin t from a rotation.
        let system = System::read(&Description {
            components: vec!["x", "v", "c", "s"],
            equations: vec![
                ("x", "v"),
                ("v", "-0.2*v - x + sign(s)"),
                ("c", "-s + c*(1 - c^2 - s^2)"),
                ("s", "c + s*(1 - c^2 - s^2)"),
            ],
            ..Description::default()
        });
        let relay = Text::new(&system.unwrap(), vec![[0.5, 1.0]; 4]);
        let StepChoice { method, step, error, is_within } = choice(&relay, 1.0, 1e-8);
        assert_eq!((method, step, is_within), (Method::Rk4, USUAL, false));
        assert!(error > 1e-8, "{error}");
    }
}
