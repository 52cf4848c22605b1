//! How long a step may be.

use super::orbit::Orbit;
use super::tangents::{Jacobian, larger};

/// The share of the interval of stability that is used.
const SAFETY: f64 = 0.95;
/// Sizes of coefficients that are told apart, as powers of two.
const POWERS: i32 = 200;
/// A power of two is told apart in so many parts.
const PARTS: u32 = 2;

/// Bounds on σ in steps of a factor two, so that those of neighbouring σ are the same.
pub(super) struct Levels {
    /// Below this σ hardly matters beside the equations themselves.
    lowest: f64,
}

impl Levels {
    /// From the sizes of DF, at some state, and B.
    pub fn new(of_flow: f64, of_coupling: f64) -> Self {
        let lowest = of_flow / of_coupling;
        let is_usual = lowest.is_finite() && lowest > 0.0;
        Self { lowest: if is_usual { power_of_two_above(0.5 * lowest) } else { 1.0 } }
    }

    /// The bound of a σ.
    pub fn of(&self, sigma: f64) -> f64 {
        let sigma = sigma.abs();
        if sigma <= self.lowest { self.lowest } else { power_of_two_above(sigma) }
    }
}

fn power_of_two_above(x: f64) -> f64 {
    libm::exp2(libm::ceil(libm::log2(x)))
}

/// The rule by which steps are chosen.
pub(super) struct Steps {
    order: usize,
    /// The longest steps at which the last coefficient, and the one before it, are small enough.
    last: Root,
    before: Root,
    /// How small these two must be, relative to the state or to the box of initial states, whichever is
    /// larger, or to a tangent, for the first one that is left out to be as small as the tolerance.
    small: [f64; 2],
    size: f64,
    /// The interval of stability, with a margin.
    stable: f64,
    longest: f64,
}

impl Steps {
    pub fn new(tolerance: f64, start: &[[f64; 2]], longest: f64) -> Self {
        let order = order_for(tolerance);
        let size = start.iter().flatten().fold(0.0, |size: f64, x| size.max(x.abs()));
        Self {
            order,
            last: Root::new(order),
            before: Root::new(order - 1),
            // Terms fall by the same factor from one to the next.
            small: [order - 1, order].map(|n| libm::pow(tolerance, n as f64 / (order + 1) as f64)),
            size: if size > 0.0 { size } else { 1.0 },
            stable: SAFETY * interval_of_stability(order),
            longest,
        }
    }

    /// Order of the series.
    pub fn order(&self) -> usize {
        self.order
    }

    /// The step of each orbit, from its series and those of DF and DH, and its bound on σ.
    #[inline(always)]
    pub fn of<const W: usize>(
        &self,
        orbit: &Orbit<W>,
        jacobian: &Jacobian,
        bounds: &[f64; W],
    ) -> [f64; W] {
        let [of_flow, of_coupling] = jacobian.sizes(orbit);
        // Coefficients beside what they belong to: a state, and a tangent of unit length.
        let [mut before, mut last] = jacobian.ends(orbit, bounds, self.order);
        let mut size = [self.size; W];
        for c in 0..orbit.n_components() {
            for lane in 0..W {
                size[lane] = larger(size[lane], orbit.component(c)[0][lane].abs());
            }
        }
        for c in 0..orbit.n_components() {
            let of = orbit.component(c);
            for lane in 0..W {
                before[lane] = larger(before[lane], of[self.order - 1][lane].abs() / size[lane]);
                last[lane] = larger(last[lane], of[self.order][lane].abs() / size[lane]);
            }
        }
        let mut h = [0.0; W];
        for lane in 0..W {
            let by_last = self.last.of(last[lane] / self.small[1]);
            let by_before = self.before.of(before[lane] / self.small[0]);
            let by_size = self.stable / (of_flow[lane] + bounds[lane] * of_coupling[lane]);
            h[lane] = by_last.min(by_before).min(by_size).min(self.longest);
        }
        h
    }
}

/// The order that takes the least work: half of −ln(tolerance), and two.
fn order_for(tolerance: f64) -> usize {
    let order = libm::ceil(-0.5 * libm::log(tolerance)) + 1.0;
    order.clamp(4.0, 20.0) as usize
}

/// x^(−1/n) from a table, a little too small.
struct Root(Vec<f64>);

impl Root {
    fn new(n: usize) -> Self {
        let exponent = -1.0 / n as f64;
        let numbers = Self::first()..=Self::place(2f64.powi(POWERS));
        Self(numbers.map(|place| libm::pow(Self::number(place + 1), exponent)).collect())
    }

    fn first() -> u64 {
        Self::place(2f64.powi(-POWERS))
    }

    fn place(x: f64) -> u64 {
        x.to_bits() >> (52 - PARTS)
    }

    fn number(place: u64) -> f64 {
        f64::from_bits(place << (52 - PARTS))
    }

    #[inline(always)]
    fn of(&self, x: f64) -> f64 {
        let place = Self::place(x).saturating_sub(Self::first()) as usize;
        self.0[place.min(self.0.len() - 1)]
    }
}

/// The radius within which the polynomial of the exponential function of this order damps whatever the
/// function damps by at least an eighth of its size.
fn interval_of_stability(order: usize) -> f64 {
    const STEP: f64 = 0.01;
    let is_damped = |size: f64| {
        (0..=32).all(|k| {
            // From the negative axis to where the real part is an eighth of the size.
            let cosine = -1.0 + 0.875 * f64::from(k) / 32.0;
            let [re, im] = [size * cosine, size * (1.0 - cosine * cosine).sqrt()];
            let (mut sum, mut term) = ([1.0, 0.0], [1.0, 0.0]);
            for n in 1..=order {
                let [a, b] = term;
                let share = 1.0 / n as f64;
                term = [(a * re - b * im) * share, (a * im + b * re) * share];
                sum = [sum[0] + term[0], sum[1] + term[1]];
            }
            sum[0] * sum[0] + sum[1] * sum[1] <= 1.0
        })
    };
    let sizes = (1..5000).map(|k| STEP * f64::from(k));
    sizes.take_while(|&size| is_damped(size)).last().unwrap_or(STEP)
}
