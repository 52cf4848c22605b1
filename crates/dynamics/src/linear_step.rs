//! What a step of RK4 makes of small deviations. Along an orbit of the isolated oscillator the
//! Jacobians A = DF(s) − σ DH have eigenvalues μ; a deviation along one grows in a step h by
//!
//! ```text
//! exp(hμ)   by the equations
//! R(hμ)     by RK4, with R(z) = 1 + z + z²/2 + z³/6 + z⁴/24
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
use crate::{Coupling, DynamicsError, NodeDynamics};

/// The orbit is followed with the step in question divided by this.
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
        /// The same by RK4.
        rk4: f64,
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

    /// What a step does at this σ.
    pub fn judge(&self, sigma: f64, step: f64) -> StepVerdict {
        let (mut exact, mut rk4, mut size) = (0.0, 0.0, 0.0);
        let (mut amplified, mut anywhere) = (0.0, false);
        for rates in self.rates(sigma) {
            let leading = |rate: &dyn Fn(Complex<f64>) -> f64| {
                rates.iter().map(|&mu| rate(mu)).fold(f64::NEG_INFINITY, f64::max)
            };
            let by_rk4 = |mu: Complex<f64>| growth(mu * step).ln() / step;
            let damped = |mu: Complex<f64>| {
                if mu.re < 0.0 { by_rk4(mu) } else { f64::NEG_INFINITY }
            };
            let of_damped = leading(&damped);
            anywhere |= of_damped > 0.0;
            // A stretch of the orbit where nothing is damped says nothing.
            amplified += if of_damped.is_finite() { of_damped } else { 0.0 };
            let by_equations = leading(&|mu| mu.re);
            exact += by_equations;
            size += by_equations.abs();
            rk4 += leading(&by_rk4);
        }
        let n = self.jacobians.len() as f64;
        let [exact, rk4, size, amplified] = [exact, rk4, size, amplified].map(|sum| sum / n);
        if amplified > 0.0 || !rk4.is_finite() {
            StepVerdict::Unstable { factor: (amplified * step).exp() }
        } else if anywhere || (rk4 - exact).abs() > ACCURATE * size {
            StepVerdict::Doubtful { exact, rk4 }
        } else {
            StepVerdict::Sound
        }
    }

    /// The longest step, of those from `at_most` down by a tenth each, that is sound at this σ; none
    /// within thirteen decades.
    pub fn sound_step(&self, sigma: f64, at_most: f64) -> Option<f64> {
        let steps = (0..300).map(|k| at_most * 0.9f64.powi(k));
        steps.into_iter().find(|&step| self.judge(sigma, step) == StepVerdict::Sound)
    }

    /// The largest σ up to `most` at which the step is not unstable, to a per cent.
    pub fn stable_up_to(&self, most: f64, step: f64) -> f64 {
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

/// |R(z)|.
fn growth(z: Complex<f64>) -> f64 {
    let one = Complex::new(1.0, 0.0);
    (one + z * (one + z * (one / 2.0 + z * (one / 6.0 + z / 24.0)))).norm()
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

    fn lorenz(from: usize, to: usize) -> LinearSteps {
        let model = Model::Lorenz(Lorenz::default());
        LinearSteps::along_orbit(&model, &Coupling::pair(from, to), 0.01, 1).unwrap()
    }

    #[test]
    fn rk4_ends_where_its_known_intervals_do() {
        // 2.785 along the negative axis, 2√2 along the imaginary one.
        let at = |re, im| growth(Complex::new(re, im));
        assert!(at(-2.785, 0.0) < 1.0 && at(-2.786, 0.0) > 1.0);
        assert!(at(0.0, 2.828) < 1.0 && at(0.0, 2.829) > 1.0);
    }

    #[test]
    fn a_damped_component_ends_at_2_785_over_the_step() {
        // x into x: the fast rate is α + σ, apart from terms of order 1/σ.
        let end = lorenz(0, 0).stable_up_to(1000.0, 0.01);
        assert!((end + 10.0 - 278.5).abs() < 6.0, "{end}");
    }

    #[test]
    fn x_into_y_ends_where_the_two_oscillate_too_fast() {
        // The fast pair is ±i √(ασ), and damped on average by (α + 1)/2: hσ½ reaches 2√2 near 8000.
        let steps = lorenz(0, 1);
        let end = steps.stable_up_to(1e5, 0.01);
        assert!((7600.0..8400.0).contains(&end), "{end}");
        // z decays by itself more slowly than the pair, so that the pair is noticed only near its end.
        let verdicts = [0.9, 0.98, 0.985, 0.99, 0.995, 1.1].map(|f| steps.judge(f * end, 0.01));
        assert_eq!(verdicts[0], StepVerdict::Sound);
        assert!(verdicts.iter().any(|v| matches!(v, StepVerdict::Doubtful { .. })), "{verdicts:?}");
        assert!(matches!(verdicts[5], StepVerdict::Unstable { factor } if factor > 1.0));
        let sound = steps.sound_step(1.1 * end, 0.01).unwrap();
        assert!((0.008..0.01).contains(&sound), "{sound}");
    }

    #[test]
    fn numbers_beyond_all_sense_are_answered_too() {
        for sigma in [1e30, 1e155, 1e300, f64::MAX] {
            let steps = lorenz(0, 0);
            assert!(matches!(steps.judge(sigma, 0.01), StepVerdict::Unstable { .. }), "{sigma}");
            assert!(steps.stable_up_to(sigma, 0.01) < 300.0);
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
                    assert_eq!(steps.judge(sigma, 0.01), StepVerdict::Sound, "{model:?} {sigma}");
                }
            }
        }
    }
}
