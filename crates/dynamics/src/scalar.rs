//! The arithmetic in which oscillators are written: plain numbers, lanes of numbers, dual numbers.
//!
//! Dual numbers a + b·δ with δ² = 0 carry a derivative: F(a + b·δ) = F(a) + (DF(a) b)·δ.

use std::ops::{Add, Mul, Neg, Sub};

/// A number on which equations of motion can be evaluated.
///
/// Operations round as IEEE 754 doubles do, one by one: the same expression gives the same bits in
/// every lane and on every machine.
pub trait Scalar:
    Copy
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
}

impl Scalar for f64 {}

/// `L` numbers advanced side by side: different couplings, seeds or tangent vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const L: usize>(pub [f64; L]);

impl<const L: usize> Scalar for Lanes<L> {}

impl<const L: usize> From<f64> for Lanes<L> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self([value; L])
    }
}

impl<const L: usize> Lanes<L> {
    #[inline(always)]
    fn zip(mut self, other: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        for lane in 0..L {
            self.0[lane] = operation(self.0[lane], other.0[lane]);
        }
        self
    }

    #[inline(always)]
    fn map(mut self, operation: impl Fn(f64) -> f64) -> Self {
        for lane in 0..L {
            self.0[lane] = operation(self.0[lane]);
        }
        self
    }

    /// |x| in every lane.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        self.map(f64::abs)
    }
}

macro_rules! lanewise {
    ($($operator:ident $method:ident $symbol:tt),*) => {$(
        impl<const L: usize> $operator for Lanes<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $symbol b)
            }
        }

        impl<const L: usize> $operator<f64> for Lanes<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.map(|a| a $symbol other)
            }
        }
    )*};
}
lanewise!(Add add +, Sub sub -, Mul mul *);

impl<const L: usize> Neg for Lanes<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

/// A value with a tangent: value + tangent·δ, δ² = 0.
///
/// One value may carry several tangents as [`Lanes`]: its own operations are then done once for all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<V, T = V> {
    /// The number itself.
    pub value: V,
    /// Its derivative along the direction, or directions, carried.
    pub tangent: T,
}

impl<V: Scalar, T: Scalar + Mul<V, Output = T>> Scalar for Dual<V, T> {}

impl<V: Scalar, T: Scalar> From<f64> for Dual<V, T> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { value: V::from(value), tangent: T::from(0.0) }
    }
}

impl<V: Scalar, T: Scalar> Add for Dual<V, T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, tangent: self.tangent + other.tangent }
    }
}

impl<V: Scalar, T: Scalar> Sub for Dual<V, T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, tangent: self.tangent - other.tangent }
    }
}

impl<V: Scalar, T: Scalar + Mul<V, Output = T>> Mul for Dual<V, T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            tangent: other.tangent * self.value + self.tangent * other.value,
        }
    }
}

impl<V: Scalar, T: Scalar> Neg for Dual<V, T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, tangent: -self.tangent }
    }
}

impl<V: Scalar, T: Scalar> Add<f64> for Dual<V, T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, tangent: self.tangent }
    }
}

impl<V: Scalar, T: Scalar> Sub<f64> for Dual<V, T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        Self { value: self.value - other, tangent: self.tangent }
    }
}

impl<V: Scalar, T: Scalar> Mul<f64> for Dual<V, T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        Self { value: self.value * other, tangent: self.tangent * other }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cubic<S: Scalar>(x: S) -> S {
        -(x * x * x) + x * 2.0 - 1.0 + (S::from(3.0) - x)
    }

    #[test]
    fn the_tangent_of_a_polynomial_is_its_derivative() {
        let dual = cubic(Dual { value: 1.5, tangent: 2.0 });
        assert_eq!(dual.value, cubic(1.5));
        assert_eq!(dual.tangent, 2.0 * (-3.0 * 1.5 * 1.5 + 2.0 - 1.0));
    }

    #[test]
    fn every_lane_has_the_bits_of_a_single_value() {
        let values = [0.1, -7.3, 1e-9, 2.5e4];
        let lanes = cubic(Lanes(values));
        assert_eq!(lanes.0.map(f64::to_bits), values.map(|x| cubic(x).to_bits()));
    }
}
