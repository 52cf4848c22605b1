//! What a step makes of small deviations. Along an orbit of the isolated oscillator the
//! Jacobians A = DF(s) − σ DH have eigenvalues μ; a deviation along one grows in a step h by
//!
//! ```text
//! exp(hμ)   by the equations
//! R(hμ)     by the method, with R(z) = 1 + z + z²/2 + z³/6 + z⁴/24 for RK4
//! ```
//!
//! Where Re μ < 0 and |R(hμ)| > 1 the method amplifies what the equations damp. σ = −ελ is that of a
//! mode of the network, so that the fastest one, λ_N, decides.
//!
//! Source: E. Hairer & G. Wanner, Solving Ordinary Differential Equations II (1996), Sec. IV.2. The
//! Jacobians are frozen over a step, which is what a stiff direction sees.

use nalgebra::{Complex, DMatrix};

use crate::isolated_orbit::IsolatedOrbit;
use crate::jacobians::Jacobians;
use crate::small_eigenvalues::{eigenvalues, largest};
use crate::{Coupling, DynamicsError, Method, NodeDynamics};

/// The orbit is followed by RK4 with the step in question divided by this.
const FINER: f64 = 4.0;
/// Steps of the orbit before its first Jacobian.
const TRANSIENT: u32 = 40_000;
/// Jacobians along the orbit.
const SAMPLES: usize = 250;
/// Steps from one to the next.
const STRIDE: u32 = 400;
/// How far the rate of the leading direction may be off, relatively, before it is worth a word.
const ACCURATE: f64 = 0.1;

/// What a step does at one σ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepVerdict {
    /// Every direction that the equations damp is damped, at the right rate where that counts.
    Sound,
    /// All is damped on average, but not everywhere along the orbit, or at another rate.
    Doubtful {
        /// Mean growth rate of the leading direction by the equations.
        exact: f64,
        /// The same by the method.
        by_method: f64,
    },
    /// On average along the orbit the method amplifies a direction that the equations damp.
    Unstable {
        /// By how much in a step, as a geometric mean.
        factor: f64,
    },
}

/// Jacobians along an orbit of the isolated oscillator.
pub struct LinearSteps {
    /// DF and DH.
    jacobians: Vec<[DMatrix<f64>; 2]>,
}

impl LinearSteps {
    /// Follows an orbit more finely than the step in question.
    ///
    /// # Errors
    /// [`DynamicsError::BadStep`]; [`DynamicsError::Escaped`] where the orbit does even so.
    ///
    /// # Panics
    /// For a map, which has no step.
    pub fn along_orbit(
        dynamics: &dyn NodeDynamics,
        coupling: &Coupling,
        step: f64,
        seed: u64,
    ) -> Result<Self, DynamicsError> {
        if !(step.is_finite() && step > 0.0) {
            return Err(DynamicsError::BadStep { step });
        }
        assert!(!dynamics.is_map(), "a map has no step to judge");
        let mut orbit = IsolatedOrbit::begin(dynamics, step / FINER, seed);
        let mut jacobians = Vec::with_capacity(SAMPLES);
        while jacobians.len() < SAMPLES {
            let until = if jacobians.is_empty() { TRANSIENT } else { STRIDE };
            (0..until).for_each(|_| orbit.advance());
            let here = jacobians_at((dynamics, coupling), orbit.bounded()?);
            if !here.iter().flat_map(DMatrix::iter).all(|entry| entry.is_finite()) {
                return Err(orbit.escaped());
            }
            jacobians.push(here);
        }
        Ok(Self { jacobians })
    }

    /// What a step of a method that has a fixed one does at this σ.
    ///
    /// # Panics
    /// For an adaptive method.
    pub fn judge(&self, sigma: f64, (method, step): (Method, f64)) -> StepVerdict {
        let method = method.fixed().expect("an adaptive method chooses its steps by itself");
        let (mut exact, mut by_method, mut size) = (0.0, 0.0, 0.0);
        let (mut amplified, mut anywhere) = (0.0, false);
        for rates in self.rates(sigma) {
            let leading = |rate: &dyn Fn(Complex<f64>) -> f64| {
                rates.iter().map(|&mu| rate(mu)).fold(f64::NEG_INFINITY, f64::max)
            };
            let by_steps = |mu: Complex<f64>| method.growth(mu * step).ln() / step;
            let damped = |mu: Complex<f64>| {
                if mu.re < 0.0 { by_steps(mu) } else { f64::NEG_INFINITY }
            };
            let of_damped = leading(&damped);
            anywhere |= of_damped > 0.0;
            // A stretch of the orbit where nothing is damped says nothing.
            amplified += if of_damped.is_finite() { of_damped } else { 0.0 };
            let by_equations = leading(&|mu| mu.re);
            exact += by_equations;
            size += by_equations.abs();
            by_method += leading(&by_steps);
        }
        let n = self.jacobians.len() as f64;
        let [exact, by_method, size, amplified] =
            [exact, by_method, size, amplified].map(|sum| sum / n);
        if amplified > 0.0 || !by_method.is_finite() {
            StepVerdict::Unstable { factor: (amplified * step).exp() }
        } else if anywhere || (by_method - exact).abs() > ACCURATE * size {
            StepVerdict::Doubtful { exact, by_method }
        } else {
            StepVerdict::Sound
        }
    }

    /// The longest step, of those from `at_most` down by a tenth each, that is sound at this σ; none
    /// within thirteen decades.
    pub fn sound_step(&self, sigma: f64, (method, at_most): (Method, f64)) -> Option<f64> {
        let mut steps = (0..300).map(|k| at_most * 0.9f64.powi(k));
        steps.find(|&step| self.judge(sigma, (method, step)) == StepVerdict::Sound)
    }

    /// The largest σ up to `most` at which the step is not unstable, to a per cent.
    pub fn stable_up_to(&self, most: f64, step: (Method, f64)) -> f64 {
        let unstable = |sigma| matches!(self.judge(sigma, step), StepVerdict::Unstable { .. });
        let (mut low, mut high) = (0.0, most);
        if !unstable(most) {
            return most;
        }
        while high - low > 0.01 * high {
            let middle = 0.5 * (low + high);
            if unstable(middle) { high = middle } else { low = middle }
        }
        low
    }

    /// Eigenvalues of DF − σ DH, one Jacobian after the other.
    fn rates(&self, sigma: f64) -> impl Iterator<Item = Vec<Complex<f64>>> {
        self.jacobians.iter().map(move |[df, dh]| rates_of(df - dh * sigma))
    }
}

/// Eigenvalues of a Jacobian. Of one that is too large for its squares to be numbers, a single rate of
/// its size, which no step can follow.
fn rates_of(a: DMatrix<f64>) -> Vec<Complex<f64>> {
    let size = largest(&a);
    eigenvalues(a).unwrap_or_else(|| vec![Complex::new(-size, 0.0)])
}

/// DF and DH at a state.
fn jacobians_at(
    (dynamics, coupling): (&dyn NodeDynamics, &Coupling),
    state: &[f64],
) -> [DMatrix<f64>; 2] {
    let df = Jacobians::of_flow(dynamics, state);
    let dh = Jacobians::of_coupling(dynamics, coupling, state);
    [df.matrix(0), &dh].map(|rows| DMatrix::from_row_slice(df.n_free, df.n_free, rows))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{HindmarshRose, Lorenz, Model, Rossler};

    const RK4: (Method, f64) = (Method::Rk4, 0.01);

    fn lorenz(from: usize, to: usize) -> LinearSteps {
        let model = Model::Lorenz(Lorenz::default());
        LinearSteps::along_orbit(&model, &Coupling::pair(from, to), 0.01, 1).unwrap()
    }

    #[test]
    fn a_damped_component_ends_at_2_785_over_the_step() {
        // x into x: the fast rate is α + σ, apart from terms of order 1/σ.
        let end = lorenz(0, 0).stable_up_to(1000.0, RK4);
        assert!((end + 10.0 - 278.5).abs() < 6.0, "{end}");
    }

    #[test]
    fn dop853_at_an_eighth_damps_up_to_its_interval_of_6_39() {
        let end = lorenz(0, 0).stable_up_to(1000.0, (Method::Dop853, 0.125));
        assert!((end + 10.0 - 8.0 * 6.39).abs() < 2.0, "{end}");
    }

    #[test]
    fn x_into_y_ends_where_the_two_oscillate_too_fast() {
        // The fast pair is ±i √(ασ), and damped on average by (α + 1)/2: hσ½ reaches 2√2 near 8000.
        let steps = lorenz(0, 1);
        let end = steps.stable_up_to(1e5, RK4);
        assert!((7600.0..8400.0).contains(&end), "{end}");
        // z decays by itself more slowly than the pair, so that the pair is noticed only near its end.
        let verdicts = [0.9, 0.98, 0.985, 0.99, 0.995, 1.1].map(|f| steps.judge(f * end, RK4));
        assert_eq!(verdicts[0], StepVerdict::Sound);
        assert!(verdicts.iter().any(|v| matches!(v, StepVerdict::Doubtful { .. })), "{verdicts:?}");
        assert!(matches!(verdicts[5], StepVerdict::Unstable { factor } if factor > 1.0));
        let sound = steps.sound_step(1.1 * end, RK4).unwrap();
        assert!((0.008..0.01).contains(&sound), "{sound}");
    }

    #[test]
    fn numbers_beyond_all_sense_are_answered_too() {
        for sigma in [1e30, 1e155, 1e300, f64::MAX] {
            let steps = lorenz(0, 0);
            assert!(matches!(steps.judge(sigma, RK4), StepVerdict::Unstable { .. }), "{sigma}");
            assert!(steps.stable_up_to(sigma, RK4) < 300.0);
        }
    }

    #[test]
    fn steps_that_people_take_are_sound() {
        let models = [
            (Model::Lorenz(Lorenz::default()), 50.0),
            (Model::Rossler(Rossler::default()), 10.0),
            (Model::HindmarshRose(HindmarshRose::default()), 3.0),
        ];
        for (model, sigma) in models {
            for coupling in [Coupling::pair(0, 0), Coupling::pair(0, 1)] {
                let steps = LinearSteps::along_orbit(&model, &coupling, 0.01, 1).unwrap();
                for sigma in [0.0, 0.1 * sigma, sigma] {
                    assert_eq!(steps.judge(sigma, RK4), StepVerdict::Sound, "{model:?} {sigma}");
                }
            }
        }
    }
}
