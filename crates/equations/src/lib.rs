//! Equations as text, made into programs over runs of numbers, with exact derivatives.
//!
//! A [`Description`] is what somebody writes: components, a formula for each, names for parts of
//! formulas, parameters. [`System::read`] reads and resolves it, or says where the [`Mistake`] is.
//! A [`Program`] is a straight list of operations made from it, which runs on sixteen numbers at a
//! time:
//!
//! ```
//! use equations::{Description, Kind, Program, Registers, System};
//!
//! let lorenz = Description {
//!     kind: Kind::Flow,
//!     components: vec!["x", "y", "z"],
//!     equations: vec![("x", "(y - x)*alpha"), ("y", "x*(r - z) - y"), ("z", "x*y - z*b")],
//!     subexpressions: vec![],
//!     parameters: vec![("alpha", 10.0), ("r", 28.0), ("b", 2.0)],
//! };
//! let system = System::read(&lorenz)?;
//! assert!(system.warnings().is_empty());
//!
//! let program = Program::new(&system);
//! let mut registers = Registers::new();
//! // Two states, component by component.
//! let (x, y, z) = ([1.0, 3.0], [2.0, 4.0], [20.0, 10.0]);
//! let [mut dx, mut dy, mut dz] = [[0.0; 2]; 3];
//! program.evaluate(&mut registers, &[&x, &y, &z], &mut [&mut dx, &mut dy, &mut dz]);
//! assert_eq!([dx, dy, dz], [[10.0, 10.0], [6.0, 50.0], [-38.0, -8.0]]);
//!
//! // And how they change along x: DF(x) (1, 0, 0).
//! let (one, none) = ([1.0; 2], [0.0; 2]);
//! let [mut ddx, mut ddy, mut ddz] = [[0.0; 2]; 3];
//! program.linearise(
//!     &mut registers,
//!     [&[&x, &y, &z], &[&one, &none, &none]],
//!     [&mut [&mut dx, &mut dy, &mut dz], &mut [&mut ddx, &mut ddy, &mut ddz]],
//! );
//! assert_eq!([ddx, ddy, ddz], [[-10.0, -10.0], [8.0, 18.0], [2.0, 4.0]]);
//!
//! // Mistakes name their place.
//! let wrong = Description { equations: vec![("x", "alhpa*y"), ("y", "x"), ("z", "x")], ..lorenz };
//! let mistake = System::read(&wrong).unwrap_err();
//! assert_eq!(mistake.at, Some(0..5));
//! assert_eq!(mistake.remedy().as_deref(), Some("`alpha`?"));
//! # Ok::<(), equations::Mistake>(())
//! ```
//!
//! # Bits
//! A formula is evaluated as it is written, one rounding an operation: a − b + c is (a − b) + c, no
//! sum or product is reordered but for swapping its two operands, none are fused, and operations on
//! constants alone are done beforehand by the same code. Integer powers up to ±[`LARGEST_PRODUCT`] are
//! products; the elementary functions are our own, or come from `libm`, which is portable. So a flow
//! in Rust and its text give the same bits, on any machine, in any lanes and runs.
//!
//! [`Program::evaluate`] and [`Program::linearise`] are inlined into their callers, down to the loops
//! over numbers: a caller that is compiled for some vector instructions has the program run on them.

mod assemble;
mod builder;
mod elementary;
mod expression;
mod mistake;
mod names;
mod order;
mod parser;
mod program;
mod run;
mod scalar;
mod series;
mod symbol;
mod system;
mod tangent;
mod tape;
mod token;
mod traced;

pub use builder::LARGEST_PRODUCT;
pub use expression::{Expression, Node, Part};
pub use mistake::{Fault, Mistake, Place};
pub use names::{Binary, Comparison, Unary, nearest};
pub use parser::{MAX_BYTES, MAX_DEPTH};
pub use program::Program;
pub use run::Registers;
pub use series::{Coefficients, Series, Slope, SlopeValue};
pub use system::{Description, Kind, MAX_COMPONENTS, MAX_NAMES, System, Warning};
pub use traced::Traced;
