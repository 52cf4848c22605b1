//! Orbits as series, `W` side by side.

use equations::{Coefficients, Program, Series};

/// What makes an orbit, and what its nodes send where that is no component.
pub(super) struct Programs {
    pub flow: Program,
    /// Of a coupling by formulas.
    pub sent: Option<Program>,
    pub n_components: usize,
}

/// Orbits, each at a time of its own.
pub(super) struct Orbit<const W: usize> {
    /// Of everything that the equations make of the state.
    pub flow: Coefficients<W>,
    /// The same of what a node sends.
    pub sent: Option<Coefficients<W>>,
    n_components: usize,
}

fn series(program: &Program) -> &Series {
    program.series().expect("others are not followed by series")
}

impl<const W: usize> Orbit<W> {
    pub fn new(programs: &Programs, order: usize) -> Self {
        let room = |program: &Program| Coefficients::new(series(program).n_registers(), order + 1);
        Self {
            flow: room(&programs.flow),
            sent: programs.sent.as_ref().map(room),
            n_components: programs.n_components,
        }
    }

    /// Puts one of them into its initial state.
    pub fn begin(&mut self, lane: usize, state: &[f64]) {
        for (c, &x) in state.iter().enumerate() {
            self.flow.of_mut(c)[0][lane] = x;
        }
    }

    /// The series of states up to some order, and those of everything else up to the one before.
    #[inline(always)]
    pub fn expand(&mut self, programs: &Programs, order: usize) {
        let flow = series(&programs.flow);
        for k in 0..order {
            flow.order(k, &mut self.flow);
            let share = 1.0 / (k + 1) as f64;
            for (c, &output) in flow.outputs().iter().enumerate() {
                let mut next = self.flow.of(output)[k];
                for lane in 0..W {
                    next[lane] *= share;
                }
                self.flow.of_mut(c)[k + 1] = next;
            }
        }
        let Some((program, sent)) = programs.sent.as_ref().zip(self.sent.as_mut()) else {
            return;
        };
        let of_sent = series(program);
        for k in 0..order {
            for c in 0..of_sent.n_inputs() {
                sent.of_mut(c)[k] = self.flow.of(c)[k];
            }
            of_sent.order(k, sent);
        }
    }

    /// The coefficients of a component.
    #[inline(always)]
    pub fn component(&self, c: usize) -> &[[f64; W]] {
        self.flow.of(c)
    }

    pub fn n_components(&self) -> usize {
        self.n_components
    }

    /// Takes every orbit its own step forward.
    #[inline(always)]
    pub fn advance(&mut self, h: &[f64; W], order: usize) {
        for c in 0..self.n_components {
            let of = self.flow.of_mut(c);
            let mut sum = of[order];
            for k in (0..order).rev() {
                for lane in 0..W {
                    sum[lane] = sum[lane] * h[lane] + of[k][lane];
                }
            }
            of[0] = sum;
        }
    }

    /// Whether every one is within the radius of escape; a NaN is not.
    #[inline(always)]
    pub fn is_bounded(&self, n_free: usize, radius: f64) -> bool {
        (0..n_free).all(|c| self.flow.of(c)[0].iter().all(|x| x.abs() < radius))
    }
}
