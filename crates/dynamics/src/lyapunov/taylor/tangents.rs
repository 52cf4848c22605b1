//! Tangents as series, `L` side by side, about one orbit or about as many.

use equations::{Coefficients, Series, SlopeValue};

use super::super::growth::{log, vanished};
use super::orbit::Orbit;
use crate::Coupling;

/// The entries of DF and B Dh.
pub(super) struct Jacobian {
    /// Those of DF that are the same everywhere: equation, component, value.
    fixed: Vec<(usize, usize, f64)>,
    /// The others, with their register.
    varying: Vec<(usize, usize, usize)>,
    /// The same of B Dh.
    fixed_sent: Vec<(usize, usize, f64)>,
    /// Equation, component, register of Dh, entry of B.
    varying_sent: Vec<(usize, usize, usize, f64)>,
    n_free: usize,
}

impl Jacobian {
    pub fn new(
        flow: &Series,
        (coupling, sent): (&Coupling, Option<&Series>),
        n_free: usize,
    ) -> Self {
        let mut of = Self {
            fixed: Vec::new(),
            varying: Vec::new(),
            fixed_sent: coupling.constant_derivative().into_iter().flatten().collect(),
            varying_sent: Vec::new(),
            n_free,
        };
        // A clock is not perturbed.
        for slope in flow.slopes().iter().filter(|s| s.output < n_free && s.input < n_free) {
            match slope.value {
                SlopeValue::Constant(value) => of.fixed.push((slope.output, slope.input, value)),
                SlopeValue::Series(register) => {
                    of.varying.push((slope.output, slope.input, register));
                }
            }
        }
        for slope in sent.into_iter().flat_map(Series::slopes).filter(|s| s.input < n_free) {
            for gain in coupling.gains().iter().filter(|gain| gain.channel == slope.output) {
                let place = (gain.equation, slope.input);
                match slope.value {
                    SlopeValue::Constant(value) => {
                        of.fixed_sent.push((place.0, place.1, value * gain.weight));
                    }
                    SlopeValue::Series(register) => {
                        of.varying_sent.push((place.0, place.1, register, gain.weight));
                    }
                }
            }
        }
        of
    }

    /// The sizes of DF and B Dh where each orbit is: the roots of the sums of squares of their entries.
    #[inline(always)]
    pub fn sizes<const W: usize>(&self, orbit: &Orbit<W>) -> [[f64; W]; 2] {
        let of_fixed = |entries: &[(usize, usize, f64)]| {
            [entries.iter().map(|entry| entry.2 * entry.2).sum::<f64>(); W]
        };
        let [mut of_flow, mut of_sent] = [of_fixed(&self.fixed), of_fixed(&self.fixed_sent)];
        for &(_, _, register) in &self.varying {
            let slope = &orbit.flow.of(register)[0];
            for lane in 0..W {
                of_flow[lane] += slope[lane] * slope[lane];
            }
        }
        if let Some(sent) = &orbit.sent {
            for &(_, _, register, weight) in &self.varying_sent {
                let slope = &sent.of(register)[0];
                for lane in 0..W {
                    of_sent[lane] += (weight * slope[lane]) * (weight * slope[lane]);
                }
            }
        }
        for lane in 0..W {
            of_flow[lane] = of_flow[lane].sqrt();
            of_sent[lane] = of_sent[lane].sqrt();
        }
        [of_flow, of_sent]
    }

    /// What the last coefficients of entries add to those of a tangent of unit length, of the order before
    /// the last and of the last: series that are cut off too early would do as much.
    #[inline(always)]
    pub fn ends<const W: usize>(
        &self,
        orbit: &Orbit<W>,
        bounds: &[f64; W],
        order: usize,
    ) -> [[f64; W]; 2] {
        let mut ends = [[0.0; W]; 2];
        for (end, k) in ends.iter_mut().zip([order.saturating_sub(2), order - 1]) {
            let share = 1.0 / (k + 1) as f64;
            for &(_, _, register) in &self.varying {
                let of = &orbit.flow.of(register)[k];
                for lane in 0..W {
                    end[lane] = larger(end[lane], of[lane].abs() * share);
                }
            }
            if let Some(sent) = &orbit.sent {
                for &(_, _, register, weight) in &self.varying_sent {
                    let (of, weight) = (&sent.of(register)[k], weight.abs() * share);
                    for lane in 0..W {
                        end[lane] = larger(end[lane], bounds[lane] * weight * of[lane].abs());
                    }
                }
            }
        }
        ends
    }
}

/// The larger one; what is no number is not taken.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// As many tangents as there are side by side.
pub(super) struct Piece<const L: usize> {
    sigma: [f64; L],
    /// DF − σ B Dh where it is the same everywhere, equation by equation: component and entries.
    fixed: Vec<Vec<(usize, [f64; L])>>,
    series: Coefficients<L>,
    /// By what tangents have grown since logarithms were taken, and the sum of these.
    grown: [f64; L],
    logs: [f64; L],
}

/// Growth of which no logarithm has been taken stays within these bounds.
const GROWTH: std::ops::Range<f64> = 1e-120..1e120;

impl<const L: usize> Piece<L> {
    pub fn new(jacobian: &Jacobian, sigma: [f64; L], order: usize) -> Self {
        let n = jacobian.n_free;
        let mut fixed = vec![Vec::<(usize, [f64; L])>::new(); n];
        let mut add = |equation: usize, component: usize, value: [f64; L]| {
            let row = &mut fixed[equation];
            match row.iter_mut().find(|entry| entry.0 == component) {
                Some(entry) => (0..L).for_each(|lane| entry.1[lane] += value[lane]),
                None => row.push((component, value)),
            }
        };
        for &(equation, component, value) in &jacobian.fixed {
            add(equation, component, [value; L]);
        }
        for &(equation, component, value) in &jacobian.fixed_sent {
            add(equation, component, sigma.map(|sigma| -(sigma * value)));
        }
        let mut series = Coefficients::new(n, order + 1);
        (0..n).for_each(|c| series.of_mut(c)[0] = [1.0; L]);
        Self { sigma, fixed, series, grown: [1.0; L], logs: [0.0; L] }
    }

    /// Takes every tangent as far as its orbit will go.
    #[inline(always)]
    pub fn advance<const W: usize>(
        &mut self,
        jacobian: &Jacobian,
        orbit: &Orbit<W>,
        h: &[f64; W],
        order: usize,
    ) {
        let n = jacobian.n_free;
        for k in 0..order {
            let share = 1.0 / (k + 1) as f64;
            for equation in 0..n {
                let mut rate = [0.0; L];
                for (component, entry) in &self.fixed[equation] {
                    let of = &self.series.of(*component)[k];
                    for lane in 0..L {
                        rate[lane] += entry[lane] * of[lane];
                    }
                }
                for &(row, component, register) in &jacobian.varying {
                    if row == equation {
                        let slope = &orbit.flow.of(register)[..=k];
                        add_product(&mut rate, slope, &self.series.of(component)[..=k]);
                    }
                }
                if let Some(sent) = &orbit.sent {
                    for &(row, component, register, weight) in &jacobian.varying_sent {
                        if row == equation {
                            let mut of_sent = [0.0; L];
                            let slope = &sent.of(register)[..=k];
                            add_product(&mut of_sent, slope, &self.series.of(component)[..=k]);
                            for lane in 0..L {
                                rate[lane] -= self.sigma[lane] * weight * of_sent[lane];
                            }
                        }
                    }
                }
                let next = &mut self.series.of_mut(equation)[k + 1];
                for lane in 0..L {
                    next[lane] = rate[lane] * share;
                }
            }
        }
        for c in 0..n {
            let of = self.series.of_mut(c);
            let mut sum = of[order];
            for k in (0..order).rev() {
                for lane in 0..L {
                    sum[lane] = sum[lane] * h[if W == 1 { 0 } else { lane }] + of[k][lane];
                }
            }
            of[0] = sum;
        }
    }

    /// A component of every tangent.
    #[cfg(test)]
    pub fn component(&self, c: usize) -> &[f64; L] {
        &self.series.of(c)[0]
    }

    /// Scales every tangent to unit length.
    #[inline(always)]
    pub fn renormalise(&mut self) {
        let n = self.fixed.len();
        let mut length = [0.0; L];
        for c in 0..n {
            let of = &self.series.of(c)[0];
            for lane in 0..L {
                length[lane] += of[lane] * of[lane];
            }
        }
        for lane in 0..L {
            length[lane] = length[lane].sqrt();
        }
        for c in 0..n {
            let of = &mut self.series.of_mut(c)[0];
            for lane in 0..L {
                of[lane] = if vanished(length[lane]) { 1.0 } else { of[lane] / length[lane] };
            }
        }
        let mut is_within = true;
        for lane in 0..L {
            self.grown[lane] *= length[lane];
            is_within &= GROWTH.contains(&self.grown[lane]);
        }
        if !is_within {
            self.take_logs();
        }
    }

    /// Takes logarithms where growth has become large or small.
    #[cold]
    #[inline(never)]
    fn take_logs(&mut self) {
        for lane in 0..L {
            if !GROWTH.contains(&self.grown[lane]) {
                self.logs[lane] += log(self.grown[lane]);
                self.grown[lane] = 1.0;
            }
        }
    }

    /// The logarithm of the growth of a tangent since this was last asked.
    pub fn take_growth(&mut self, lane: usize) -> f64 {
        let growth = self.logs[lane] + log(self.grown[lane]);
        (self.logs[lane], self.grown[lane]) = (0.0, 1.0);
        growth
    }
}

/// Σ_j a_j b_{n−1−j} over as many coefficients as there are.
#[inline(always)]
fn add_product<const W: usize, const L: usize>(sum: &mut [f64; L], a: &[[f64; W]], b: &[[f64; L]]) {
    let n = a.len();
    let b = &b[..n];
    let mut of = *sum;
    for j in 0..n {
        let (x, y) = (&a[j], &b[n - 1 - j]);
        for lane in 0..L {
            of[lane] += x[if W == 1 { 0 } else { lane }] * y[lane];
        }
    }
    *sum = of;
}
