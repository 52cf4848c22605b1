//! Methods whose steps all have one length, each as a [`Step`] that the lanes of a network go through.

use nalgebra::Complex;

use super::dop853::Dop853;
use super::iterate::Iterate;
use super::rk4_in_slots::Rk4;
use super::step::{MOST_SLOTS, Slots, Step};

/// A method that advances lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fixed {
    /// The classical one.
    Rk4,
    /// Of order 8.
    Dop853,
    /// The next state of a map.
    Iterate,
}

/// Work that is compiled once for every stage of every method.
pub(crate) trait AtStage {
    /// What comes out.
    type Output;

    /// Does it for one of them.
    fn at<M: Step, const STAGE: usize>(self) -> Self::Output;
}

impl Fixed {
    /// Slots of the points at which stages evaluate the equations, stage by stage.
    pub(crate) fn points(self) -> &'static [usize] {
        match self {
            Self::Rk4 => Rk4::AT,
            Self::Dop853 => Dop853::AT,
            Self::Iterate => Iterate::AT,
        }
    }

    /// Numbers of each component that go from stage to stage.
    pub(crate) fn slots(self) -> usize {
        match self {
            Self::Rk4 => Rk4::SLOTS,
            Self::Dop853 => Dop853::SLOTS,
            Self::Iterate => Iterate::SLOTS,
        }
    }

    /// Does the work of one stage.
    #[inline(always)]
    pub(crate) fn at_stage<W: AtStage>(self, stage: usize, work: W) -> W::Output {
        macro_rules! of {
            ($method:ty: $($stage:literal)*) => {
                match stage {
                    $($stage => work.at::<$method, $stage>(),)*
                    _ => unreachable!("{self:?} has no stage {stage}"),
                }
            };
        }
        match self {
            Self::Rk4 => of!(Rk4: 0 1 2 3),
            Self::Dop853 => of!(Dop853: 0 1 2 3 4 5 6 7 8 9 10 11),
            Self::Iterate => of!(Iterate: 0),
        }
    }
}

impl Fixed {
    /// |R(z)|, what a step of length h makes of the deviation 1 from a state of rest, where ẋ = μx and
    /// z = hμ: R is the polynomial of stability. Infinite where it is no number.
    pub(crate) fn growth(self, z: Complex<f64>) -> f64 {
        let f = |x: &[f64], f: &mut [f64]| {
            f[0] = z.re * x[0] - z.im * x[1];
            f[1] = z.re * x[1] + z.im * x[0];
        };
        let mut x = [1.0, 0.0];
        advance(self, f, &mut x, 1.0);
        let growth = x[0].hypot(x[1]);
        if growth.is_finite() { growth } else { f64::INFINITY }
    }
}

/// Takes some numbers a step forward, f(x) being their right-hand side.
pub(crate) fn advance(method: Fixed, f: impl Fn(&[f64], &mut [f64]), x: &mut [f64], h: f64) {
    let mut slots = vec![Plain([0.0; MOST_SLOTS]); x.len()];
    let (mut at, mut slope) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    slots.iter_mut().zip(&*x).for_each(|(slots, &x)| slots.0[0] = x);
    for (stage, &point) in method.points().iter().enumerate() {
        at.iter_mut().zip(&slots).for_each(|(at, slots)| *at = slots.0[point]);
        f(&at, &mut slope);
        method.at_stage(stage, Each { slots: &mut slots, slope: &slope, h });
    }
    x.iter_mut().zip(&slots).for_each(|(x, slots)| *x = slots.0[0]);
}

/// A stage of some numbers.
struct Each<'a> {
    slots: &'a mut [Plain],
    slope: &'a [f64],
    h: f64,
}

impl AtStage for Each<'_> {
    type Output = ();

    fn at<M: Step, const STAGE: usize>(self) {
        for (slots, &f) in self.slots.iter_mut().zip(self.slope) {
            M::put::<STAGE, _>(slots, f, self.h);
        }
    }
}

/// The slots of a single number.
#[derive(Clone, Copy)]
struct Plain([f64; MOST_SLOTS]);

impl Slots<f64> for Plain {
    fn get(&self, slot: usize) -> f64 {
        self.0[slot]
    }

    fn set(&mut self, slot: usize, number: f64) {
        self.0[slot] = number;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest distance from 0 up to which a method damps along a direction, to 1e-4.
    fn limit(method: Fixed, direction: Complex<f64>) -> f64 {
        (1..200_000)
            .map(|k| 1e-4 * f64::from(k))
            .find(|&r| method.growth(direction * r) > 1.0)
            .expect("explicit methods amplify what is damped fast enough")
    }

    #[test]
    fn rk4_ends_where_its_known_intervals_do() {
        // 2.785 along the negative axis, 2√2 along the imaginary one.
        let at = |re, im| Fixed::Rk4.growth(Complex::new(re, im));
        assert!(at(-2.785, 0.0) < 1.0 && at(-2.786, 0.0) > 1.0);
        assert!(at(0.0, 2.828) < 1.0 && at(0.0, 2.829) > 1.0);
    }

    #[test]
    fn dop853_is_stable_up_to_6_39_along_the_negative_axis() {
        let end = limit(Fixed::Dop853, Complex::new(-1.0, 0.0));
        assert!((6.38..6.42).contains(&end), "{end}");
    }

    #[test]
    fn polynomials_of_stability_are_the_exponential_up_to_the_order() {
        // R(z) − exp z = c z^(p+1) + …: halving z divides it by 2^(p+1), nearly.
        for (method, order) in [(Fixed::Rk4, 4), (Fixed::Dop853, 8)] {
            let error = |z: f64| (method.growth(Complex::new(z, 0.0)) - z.exp()).abs();
            let ratio = error(0.5) / error(0.25);
            let expected = 2f64.powi(order + 1);
            assert!((ratio / expected - 1.0).abs() < 0.2, "{method:?}: {ratio}");
        }
    }
}
