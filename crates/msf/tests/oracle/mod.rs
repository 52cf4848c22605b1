//! Limit cycles with the zeros that `floquet.py` found.

use dynamics::{HindmarshRose, Lorenz, Model, Rossler};

/// The largest σ at which it looked.
pub const LAST: f64 = 256.0;

/// A coupling of a limit cycle.
#[allow(dead_code, reason = "each test reads what it needs")]
pub struct Case {
    /// System and parameters.
    pub model: Model,
    /// The component that drives, and the one that is driven.
    pub pair: [usize; 2],
    /// The period.
    pub period: f64,
    /// Whether small σ are stable.
    pub begins_stable: bool,
    /// Zeros of Λ, to nine digits.
    pub zeros: Vec<f64>,
}

/// All of them.
pub fn cases() -> Vec<Case> {
    include_str!("floquet.csv").lines().skip(1).map(case).collect()
}

fn case(line: &str) -> Case {
    let cells: Vec<&str> = line.split(',').collect();
    let number = |text: &str| text.parse::<f64>().expect("a number");
    let [a, b, c] = [1, 2, 3].map(|k| number(cells[k]));
    let model = match cells[0] {
        "rossler" => Model::Rossler(Rossler { a, b, c }),
        "lorenz" => Model::Lorenz(Lorenz { alpha: a, r: b, b: c }),
        _ => Model::HindmarshRose(HindmarshRose { r: a, s: b, current: c }),
    };
    let pair = [4, 5].map(|k| "xyz".find(cells[k]).expect("a component"));
    let mut words = cells[7].split_whitespace();
    let begins_stable = words.next() == Some("stable");
    Case {
        model,
        pair,
        period: number(cells[6]),
        begins_stable,
        zeros: words.map(number).collect(),
    }
}
