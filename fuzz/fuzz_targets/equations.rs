//! Any text as equations, a line a formula: the first two are those of components, the others are named
//! parts. They are read and run, as values, derivatives and series, or refused at a place in the text.
#![no_main]

use equations::{Coefficients, Description, Kind, Place, Program, Registers, System};
use libfuzzer_sys::fuzz_target;

const PARTS: [&str; 4] = ["f", "g", "h", "k"];
const PARAMETERS: [(&str, f64); 3] = [("alpha", 10.0), ("m0", -1.27), ("r", 28.0)];

fuzz_target!(|text: &str| {
    let lines: Vec<&str> = text.lines().take(2 + PARTS.len()).collect();
    let [x, y, parts @ ..] = &lines[..] else { return };
    let kinds = [Kind::Flow, Kind::Map, Kind::Coupling];
    let description = Description {
        kind: kinds[text.len() % kinds.len()],
        components: vec!["x", "y"],
        equations: vec![("x", x), ("y", y)],
        subexpressions: PARTS.into_iter().zip(parts.iter().copied()).collect(),
        parameters: PARAMETERS.to_vec(),
    };
    match System::read(&description) {
        Ok(system) => run(&Program::new(&system)),
        Err(mistake) => {
            assert!(!mistake.to_string().is_empty());
            let text = match &mistake.place {
                Place::Equation(name) => description.equations.iter().find(|e| e.0 == name),
                Place::Subexpression(name) => {
                    description.subexpressions.iter().find(|e| e.0 == name)
                }
                _ => None,
            };
            if let (Some((_, text)), Some(at)) = (text, &mistake.at) {
                assert!(text.get(at.clone()).is_some(), "{mistake:?}");
            }
        }
    }
});

/// Runs a program: no matter what comes out.
fn run(program: &Program) {
    let x = [0.3, -1.7, 1e9];
    let inputs = vec![x.as_slice(); program.n_inputs()];
    let mut to = vec![[0.0; 3]; 2 * program.n_outputs()];
    let (values, slopes) = to.split_at_mut(program.n_outputs());
    let mut values: Vec<&mut [f64]> = values.iter_mut().map(<[f64; 3]>::as_mut_slice).collect();
    let mut slopes: Vec<&mut [f64]> = slopes.iter_mut().map(<[f64; 3]>::as_mut_slice).collect();
    program.linearise(&mut Registers::new(), [&inputs, &inputs], [&mut values, &mut slopes]);
    if let Some(series) = program.series() {
        let mut of = Coefficients::<3>::new(series.n_registers(), 4);
        (0..4).for_each(|k| series.order(k, &mut of));
    }
}
