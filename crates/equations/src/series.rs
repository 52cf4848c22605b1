//! Taylor series of a solution: with x(t + τ) = Σ x_k τ^k every number that equations make of x is such
//! a series too, and x_{k+1} = F_k / (k + 1).
//!
//! The coefficient of order k of each operation follows from those of its operands up to order k:
//!
//! ```text
//! (a b)_k = Σ_{j=0..k} a_j b_{k−j}
//! (a / b)_k = [a_k − Σ_{j=1..k} b_j (a / b)_{k−j}] / b_0
//! f_k = 1/k Σ_{j=1..k} j u_j g_{k−j}        where f' = g u', as (exp u)' = (exp u) u'
//! ```
//!
//! so that a pass over all operations for each order gives the series to any order. Entries of the
//! Jacobian are operations like others. Equations with pieces (`abs`, `if`, …) have no such series.
//!
//! Source: À. Jorba & M. Zou, Exp. Math. 14, 99 (2005), Sec. 2.

mod lower;
mod rules;
mod run;

pub use rules::{Series, Slope, SlopeValue};
pub use run::Coefficients;
