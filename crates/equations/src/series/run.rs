//! Coefficients, order by order.
//!
//! All of it is inlined into whoever calls it, so that it is compiled for the vector instructions of
//! the caller; the numbers of a coefficient are as many solutions, none of which knows of the others.

use super::rules::{Rule, Series};

/// Numbers in a line of the cache, which no vector shall straddle.
const LINE: usize = 8;

/// Coefficients of the series of some registers, up to some order, of `W` solutions side by side.
#[derive(Clone, Debug)]
pub struct Coefficients<const W: usize> {
    numbers: Vec<f64>,
    skipped: usize,
    n_orders: usize,
}

impl<const W: usize> Coefficients<W> {
    /// Room for as many registers, with coefficients of orders below `n_orders`.
    pub fn new(n_registers: usize, n_orders: usize) -> Self {
        let numbers = vec![0.0; n_registers * n_orders * W + LINE];
        let skipped = numbers.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE);
        Self { numbers, skipped, n_orders }
    }

    /// The coefficients of a register, order by order.
    #[inline(always)]
    pub fn of(&self, register: usize) -> &[[f64; W]] {
        let numbers = &self.numbers[self.skipped..].as_chunks().0[register * self.n_orders..];
        &numbers[..self.n_orders]
    }

    /// The same, to be changed.
    #[inline(always)]
    pub fn of_mut(&mut self, register: usize) -> &mut [[f64; W]] {
        let numbers = self.numbers[self.skipped..].as_chunks_mut().0;
        &mut numbers[register * self.n_orders..][..self.n_orders]
    }
}

impl Series {
    /// The coefficients of order k of everything that is made of the inputs, of which those up to k are
    /// known.
    #[inline(always)]
    pub fn order<const W: usize>(&self, k: usize, of: &mut Coefficients<W>) {
        for (place, rule) in self.rules.iter().enumerate() {
            let mut sum = [0.0; W];
            match rule {
                Rule::Combination { constant, terms } => {
                    if k == 0 {
                        sum = [*constant; W];
                    }
                    for &(factor, register) in terms {
                        let a = &of.of(register)[k];
                        for lane in 0..W {
                            sum[lane] += factor * a[lane];
                        }
                    }
                }
                Rule::Product(a, b) => {
                    sum = convolution(&of.of(*a)[..=k], &of.of(*b)[..=k]);
                }
                Rule::Square(a) => sum = square(&of.of(*a)[..=k]),
                Rule::Quotient(a, b) => {
                    let [a, b] = [of.of(*a), of.of(*b)];
                    if k > 0 {
                        let known = &of.of(self.n_inputs + place)[..k];
                        sum = convolution(known, &b[1..=k]);
                    }
                    for lane in 0..W {
                        sum[lane] = (a[k][lane] - sum[lane]) / b[0][lane];
                    }
                }
                Rule::Function { code, at, .. } if k == 0 => {
                    let [a, b] = at.map(|register| of.of(register)[0]);
                    for lane in 0..W {
                        sum[lane] = code.of([a[lane], b[lane], 0.0]);
                    }
                }
                Rule::Function { rates, .. } => {
                    for rate in rates {
                        let (u, g) = (&of.of(rate.u)[1..=k], &of.of(rate.g)[..k]);
                        for j in 0..k {
                            let weight = (j + 1) as f64;
                            for lane in 0..W {
                                sum[lane] += weight * u[j][lane] * g[k - 1 - j][lane];
                            }
                        }
                    }
                    let share = 1.0 / k as f64;
                    for lane in 0..W {
                        sum[lane] *= share;
                    }
                }
            }
            of.of_mut(self.n_inputs + place)[k] = sum;
        }
    }
}

/// Σ_j a_j b_{n−1−j} over as many coefficients as there are, those of even and of odd j apart, so that no
/// sum waits for the other.
#[inline(always)]
fn convolution<const W: usize>(a: &[[f64; W]], b: &[[f64; W]]) -> [f64; W] {
    let (mut even, mut odd) = ([0.0; W], [0.0; W]);
    let n = a.len();
    let b = &b[..n];
    let mut j = 0;
    while j + 1 < n {
        let (x, y) = (&a[j], &b[n - 1 - j]);
        let (x_1, y_1) = (&a[j + 1], &b[n - 2 - j]);
        for lane in 0..W {
            even[lane] += x[lane] * y[lane];
        }
        for lane in 0..W {
            odd[lane] += x_1[lane] * y_1[lane];
        }
        j += 2;
    }
    if j < n {
        let (x, y) = (&a[j], &b[0]);
        for lane in 0..W {
            even[lane] += x[lane] * y[lane];
        }
    }
    for lane in 0..W {
        even[lane] += odd[lane];
    }
    even
}

/// Σ_j a_j a_{n−1−j}, every pair once.
#[inline(always)]
fn square<const W: usize>(a: &[[f64; W]]) -> [f64; W] {
    let half = a.len() / 2;
    let mut sum = convolution(&a[..half], &a[a.len() - half..]);
    for lane in 0..W {
        sum[lane] += sum[lane];
    }
    if a.len() % 2 == 1 {
        let x = &a[half];
        for lane in 0..W {
            sum[lane] += x[lane] * x[lane];
        }
    }
    sum
}
