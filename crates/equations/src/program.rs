//! A system as programs: values, and values with derivatives along a direction.

use crate::assemble::{Assembled, assemble};
use crate::run::Registers;
use crate::series::Series;
use crate::system::System;
use crate::tangent::tangents;
use crate::tape::Tape;
use crate::traced::{self, Traced};

/// Equations that can be evaluated, made for given values of parameters.
///
/// Numbers come component by component, in runs of any length, and each goes through the same
/// operations whatever its neighbours are. Where time enters, it is one more component behind the
/// others, which grows at the rate 1 (of a map: by 1).
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// F(x).
    values: Tape,
    /// F(x) and DF(x) δ of x and δ.
    tangents: Tape,
    /// None of equations with pieces.
    series: Option<Series>,
    n_outputs: usize,
}

impl Program {
    /// Makes a program of a system with the values that its parameters have now.
    pub fn new(system: &System) -> Self {
        Self::assembled(assemble(system))
    }

    /// Makes a program of equations in Rust, by what they do with numbers of `n_inputs` components. It
    /// is that of the same operations as text.
    ///
    /// ```
    /// use equations::Program;
    ///
    /// let jerk = Program::trace(3, |x| vec![x[1], x[2], x[2] * -2.017 + x[1] * x[1] - x[0]]);
    /// assert_eq!((jerk.n_outputs(), jerk.n_operations()[0]), (3, 3));
    /// ```
    pub fn trace(
        n_inputs: usize,
        equations: impl for<'a> FnOnce(&[Traced<'a>]) -> Vec<Traced<'a>>,
    ) -> Self {
        Self::assembled(traced::trace(n_inputs, equations))
    }

    fn assembled(mut assembled: Assembled) -> Self {
        let values = Tape::new(&assembled.builder, assembled.inputs, &assembled.outputs);
        let series = Series::new(&mut assembled);
        let tangents = tangents(&mut assembled);
        let n_outputs = assembled.outputs.len();
        let outputs = [assembled.outputs, tangents].concat();
        let tangents = Tape::new(&assembled.builder, 2 * assembled.inputs, &outputs);
        Self { values, tangents, series, n_outputs }
    }

    /// Components that come in, with time if it enters.
    pub fn n_inputs(&self) -> usize {
        self.values.inputs
    }

    /// Values that come out: one of each formula, and that of time if it enters.
    pub fn n_outputs(&self) -> usize {
        self.n_outputs
    }

    /// Operations of an evaluation, without and with derivatives.
    pub fn n_operations(&self) -> [usize; 2] {
        [self.values.instructions.len(), self.tangents.instructions.len()]
    }

    /// The same equations as series in time along a solution; none where they have pieces.
    pub fn series(&self) -> Option<&Series> {
        self.series.as_ref()
    }

    /// F(x) of every number: `x[c]` are numbers of component c, and `to[k]` as many of output k.
    ///
    /// # Panics
    /// When there are not as many components, outputs and numbers as there have to be.
    #[inline(always)]
    pub fn evaluate(&self, registers: &mut Registers, x: &[&[f64]], to: &mut [&mut [f64]]) {
        self.check(x, to);
        self.values.run(registers, [x, &[]], [to, &mut []]);
    }

    /// F(x) and DF(x) δ of every number x with its tangent δ, in the same layout.
    ///
    /// # Panics
    /// As [`Self::evaluate`].
    #[inline(always)]
    pub fn linearise(
        &self,
        registers: &mut Registers,
        [x, delta]: [&[&[f64]]; 2],
        [to, to_delta]: [&mut [&mut [f64]]; 2],
    ) {
        self.check(x, to);
        self.check(delta, to_delta);
        assert_eq!(x[0].len(), delta[0].len(), "as many tangents as numbers");
        self.tangents.run(registers, [x, delta], [to, to_delta]);
    }

    fn check(&self, x: &[&[f64]], to: &[&mut [f64]]) {
        assert_eq!([x.len(), to.len()], [self.n_inputs(), self.n_outputs], "inputs and outputs");
        let length = x[0].len();
        let lengths = x.iter().map(|x| x.len()).chain(to.iter().map(|to| to.len()));
        lengths.for_each(|other| assert_eq!(other, length, "numbers of every component"));
    }
}
