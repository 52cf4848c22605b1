//! The oscillators, one file each, and the list of them that experiment files choose from.

mod hindmarsh_rose;
mod lorenz;
mod rossler;

use equations::Program;
use serde::{Deserialize, Serialize};

use crate::lyapunov::Tangents;
use crate::stage::Stage;
use crate::{
    DynamicsError, Estimate, Fused, InstructionSet, Linearised, LinearisedMut, Native,
    NodeDynamics, Oscillator, trace,
};

/// Declares [`Model`]: a line here, and `mod` above, are all that a new oscillator needs beyond its own
/// file.
macro_rules! models {
    ($($file:ident::$name:ident $tag:literal),* $(,)?) => {
        $(pub use $file::$name;)*

        /// Any of the oscillators, chosen at run time.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        pub enum Model {
            $(#[doc = concat!("[`", stringify!($name), "`].")] #[serde(rename = $tag)] $name($name)),*
        }

        impl NodeDynamics for Model {
            fn components(&self) -> Vec<&str> {
                match self { $(Self::$name(_) => <$name as Oscillator<_>>::COMPONENTS.to_vec()),* }
            }

            fn start(&self) -> &[[f64; 2]] {
                match self { $(Self::$name(_) => &<$name as Oscillator<_>>::START),* }
            }

            fn flow(&self, set: InstructionSet, x: &[&[f64]], slope: &mut [&mut [f64]]) {
                match self { $(Self::$name(o) => Native::new(*o).flow(set, x, slope)),* }
            }

            fn tangent_flow(
                &self,
                set: InstructionSet,
                at: Linearised<'_>,
                slope: LinearisedMut<'_, '_>,
            ) {
                match self { $(Self::$name(o) => Native::new(*o).tangent_flow(set, at, slope)),* }
            }

            fn program(&self) -> Option<Program> {
                match self { $(Self::$name(o) => Native::new(*o).program()),* }
            }

            fn fused(&self) -> Option<&dyn Fused> {
                Some(self)
            }
        }

        impl Fused for Model {
            fn advance(&self, state: &mut [f64], h: f64) {
                match self { $(Self::$name(o) => Native::new(*o).advance(state, h)),* }
            }

            fn stage(&self, set: InstructionSet, stage: &mut Stage<'_, '_>) {
                match self { $(Self::$name(o) => Native::new(*o).stage(set, stage)),* }
            }

            fn exponents(
                &self,
                set: InstructionSet,
                tangents: &Tangents<'_>,
            ) -> Result<Vec<Estimate>, DynamicsError> {
                match self { $(Self::$name(o) => Native::new(*o).exponents(set, tangents)),* }
            }
        }

        impl Model {
            /// The oscillator's name in experiment files.
            pub fn name(&self) -> &'static str {
                match self { $(Self::$name(_) => $tag),* }
            }

            /// Its equations as a program, which is that of their text.
            pub fn program(&self) -> Program {
                match self { $(Self::$name(o) => trace(o)),* }
            }

            /// Every oscillator there is, with its default parameters.
            pub fn all() -> Vec<Self> {
                vec![$(Self::$name($name::default())),*]
            }
        }
    };
}

models! {
    lorenz::Lorenz "lorenz",
    hindmarsh_rose::HindmarshRose "hindmarsh_rose",
    rossler::Rossler "rossler",
}

#[cfg(test)]
mod tests {
    use super::*;

    /// F of one state.
    fn flow(model: &Model, state: &[f64]) -> Vec<f64> {
        let x: Vec<&[f64]> = state.chunks(1).collect();
        let mut slope = vec![0.0; state.len()];
        let mut slopes: Vec<&mut [f64]> = slope.chunks_mut(1).collect();
        model.flow(InstructionSet::Baseline, &x, &mut slopes);
        slope
    }

    /// DF of one state in the direction of one component.
    fn tangent(model: &Model, state: &[f64], direction: usize) -> Vec<f64> {
        let along: Vec<f64> =
            (0..state.len()).map(|c| f64::from(u8::from(c == direction))).collect();
        let [value, tangent] = [state, &along].map(|x| x.chunks(1).collect::<Vec<_>>());
        let (mut of_value, mut of_tangent) = (vec![0.0; state.len()], vec![0.0; state.len()]);
        let mut values: Vec<&mut [f64]> = of_value.chunks_mut(1).collect();
        let mut tangents: Vec<&mut [f64]> = of_tangent.chunks_mut(1).collect();
        let at = Linearised { value: &value, tangent: &tangent };
        let slope = LinearisedMut { value: &mut values, tangent: &mut tangents };
        model.tangent_flow(InstructionSet::Baseline, at, slope);
        of_tangent
    }

    #[test]
    fn the_jacobian_of_every_model_is_that_of_central_differences() {
        for model in Model::all() {
            // A state off the middle of the box, so that no component is zero.
            let state: Vec<f64> =
                model.start().iter().map(|[from, to]| from + 0.37 * (to - from)).collect();
            for direction in 0..state.len() {
                let h = 1e-6;
                let shifted = |by: f64| {
                    let mut moved = state.clone();
                    moved[direction] += by;
                    flow(&model, &moved)
                };
                let (above, below) = (shifted(h), shifted(-h));
                for (c, exact) in tangent(&model, &state, direction).into_iter().enumerate() {
                    let difference = (above[c] - below[c]) / (2.0 * h);
                    assert!(
                        (exact - difference).abs() < 1e-6 * (1.0 + difference.abs()),
                        "{}: ∂F_{c}/∂x_{direction}: {exact}, {difference} by differences",
                        model.name()
                    );
                }
            }
        }
    }

    #[test]
    fn fixed_points_do_not_move() {
        // Lorenz: x = y = ±√(b(r − 1)), z = r − 1.
        let lorenz = Lorenz { alpha: 10.0, r: 33.0, b: 2.0 };
        assert_eq!(lorenz.flow([8.0, 8.0, 32.0]), [0.0; 3]);
        // Rössler with a = b = 0.2, c = 5.7: z = (c − √(c² − 4ab)) / 2a, x = az, y = −z.
        let rossler = Rossler { a: 0.2, b: 0.2, c: 5.7 };
        let z = (5.7 - (5.7f64 * 5.7 - 0.16).sqrt()) / 0.4;
        assert!(rossler.flow([0.2 * z, -z, z]).iter().all(|dx| dx.abs() < 1e-14));
        // Hindmarsh–Rose with I chosen so that x = −1.6, y = 1 − 5x², z = 0 is a fixed point.
        let (x, y) = (-1.6f64, 1.0 - 5.0 * 1.6 * 1.6);
        let current = x.powi(3) - 3.0 * x * x - y;
        let neuron = HindmarshRose { r: 0.006, s: 4.0, current };
        assert!(neuron.flow([x, y, 0.0]).iter().all(|dx| dx.abs() < 1e-14));
    }
}
