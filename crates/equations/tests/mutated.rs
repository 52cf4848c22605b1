//! Mutated texts: whatever is written is read or answered, and places lie inside the text.

use equations::{Description, Expression, Fault, Kind, Mistake, Place, Program, Registers, System};
use rand_core::Rng as _;
use rand_pcg::Pcg64Mcg;

/// Sound formulas to begin with.
const SEEDS: [&str; 14] = [
    "alpha*(y - x - f)",
    "m1*x + 0.5*(m0 - m1)*(abs(x + 1) - abs(x - 1))",
    "x*(r - z) - y",
    "-(y + z)",
    "z*(x - c) + 1.5e-3",
    "if(x < 0 and not y >= 1, min(x, y)^2, max(x, sin(pi*t)))",
    "if(x == y or x != z, 1, floor(atan2(x, y)))",
    "exp(-x^2/(2*σ^2))*tanh(y)/cosh(z)",
    "((((x))))^((y))",
    "2^-x^2^y",
    "sqrt(abs(x))*sign(y) + log(1 + z^2)",
    "tan(asin(acos(atan(sinh(x)))))",
    "a*x1 + b*x_2 - γ*x₃",
    ".5*x - 1.*y + 1e3*z",
];

/// Pieces that are put in: what formulas are made of, and what they must not be made of.
const PIECES: [&str; 52] = [
    "+", "-", "*", "/", "^", "(", ")", ",", "<", "<=", ">", ">=", "==", "!=", "=", "**", "and",
    "or", "not", "if(", "sin(", "atan2(", "min", "pi", "t", "x", "y", "f", "g", "1", "0", ".",
    "1e400", "1e-400", "e", "E5", "1.5.2", " ", "\t", "\n", "−", "²", "×", "≤", "α", "é", "💥",
    "\0", "\u{301}", "%", "[", "}",
];

struct Mutation(Pcg64Mcg);

impl Mutation {
    fn below(&mut self, bound: usize) -> usize {
        (self.0.next_u64() % bound.max(1) as u64) as usize
    }

    fn any<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[self.below(of.len())]
    }

    /// A place between two characters.
    fn boundary(&mut self, text: &str) -> usize {
        let mut place = self.below(text.len() + 1);
        while !text.is_char_boundary(place) {
            place -= 1;
        }
        place
    }

    fn range(&mut self, text: &str) -> std::ops::Range<usize> {
        let (a, b) = (self.boundary(text), self.boundary(text));
        a.min(b)..a.max(b)
    }

    /// A sound formula with some changes.
    fn formula(&mut self) -> String {
        let mut text = self.any(&SEEDS).to_owned();
        for _ in 0..self.below(6) {
            match self.below(5) {
                0 | 1 => text.insert_str(self.boundary(&text.clone()), self.any(&PIECES)),
                2 => {
                    let start = self.boundary(&text);
                    let end = text[start..].chars().next().map_or(start, |c| start + c.len_utf8());
                    text.replace_range(start..end, "");
                }
                3 => {
                    let range = self.range(&text);
                    text.replace_range(range, "");
                }
                _ => {
                    let copy = text[self.range(&text)].to_owned();
                    let place = self.boundary(&text);
                    text.insert_str(place, &copy);
                }
            }
        }
        text
    }
}

/// Whether a mistake is in the text and can be told.
#[track_caller]
fn check(mistake: &Mistake, text: &str) {
    if let Some(at) = &mistake.at {
        assert!(text.get(at.clone()).is_some(), "{text:?}: {mistake:?}");
    }
    if let Fault::Unclosed { opened } = mistake.fault {
        assert_eq!(text.as_bytes()[opened], b'(', "{text:?}");
    }
    assert!(!mistake.to_string().is_empty());
    assert!(mistake.remedy().is_none_or(|remedy| !remedy.is_empty()));
}

fn count() -> usize {
    let long = std::env::var_os("EIGENSYNC_LONG_TESTS").is_some();
    if long { 20_000_000 } else { 100_000 }
}

#[test]
fn whatever_is_written_is_read_or_answered() {
    let mut mutation = Mutation(Pcg64Mcg::new(11));
    let mut read = 0usize;
    for _ in 0..count() {
        let text = mutation.formula();
        match Expression::read(&text) {
            Ok(expression) => {
                read += 1;
                for part in &expression.parts {
                    assert!(text.get(part.at.clone()).is_some(), "{text:?}: {part:?}");
                }
            }
            Err(mistake) => check(&mistake, &text),
        }
    }
    // Neither way is rare, or the mutations would prove little.
    let share = read as f64 / count() as f64;
    assert!((0.1..0.9).contains(&share), "{share} of the texts are sound");
}

#[test]
fn whatever_is_a_system_is_run_or_answered() {
    let mut mutation = Mutation(Pcg64Mcg::new(12));
    let mut run = 0usize;
    for _ in 0..count() / 10 {
        let texts: [String; 4] = std::array::from_fn(|k| {
            if mutation.below(3) == k { mutation.formula() } else { mutation.any(&SEEDS).into() }
        });
        let mut names = ["x", "y", "f", "g"];
        if mutation.below(20) == 0 {
            names[mutation.below(4)] = mutation.any(&PIECES);
        }
        let mut parameters: Vec<(&str, f64)> =
            ["z", "alpha", "m0", "m1", "r", "c", "σ", "a", "b", "x1", "x_2", "γ", "x₃"]
                .map(|name| (name, 0.5))
                .to_vec();
        if mutation.below(20) == 0 {
            parameters.remove(mutation.below(parameters.len()));
        }
        let description = Description {
            kind: [Kind::Flow, Kind::Map, Kind::Coupling][mutation.below(3)],
            components: names[..2].to_vec(),
            equations: vec![(names[0], &texts[0]), (names[1], &texts[1])],
            subexpressions: vec![(names[2], &texts[2]), (names[3], &texts[3])],
            parameters,
        };
        match System::read(&description) {
            Ok(system) => {
                run += 1;
                evaluate(&Program::new(&system));
            }
            Err(mistake) => {
                let of = match &mistake.place {
                    Place::Equation(name) | Place::Subexpression(name) => {
                        names.iter().position(|known| known == name)
                    }
                    _ => None,
                };
                match of {
                    Some(of) => check(&mistake, &texts[of]),
                    None => assert_eq!(mistake.at, None),
                }
            }
        }
    }
    let share = run as f64 / (count() / 10) as f64;
    assert!((0.1..0.9).contains(&share), "{share} of the systems are sound");
}

/// Runs a program: no matter what comes out.
fn evaluate(program: &Program) {
    let x = [0.3, -1.7, 1e9];
    let inputs = vec![x.as_slice(); program.n_inputs()];
    let mut to = vec![[0.0; 3]; 2 * program.n_outputs()];
    let (values, slopes) = to.split_at_mut(program.n_outputs());
    let mut values: Vec<&mut [f64]> = values.iter_mut().map(<[f64; 3]>::as_mut_slice).collect();
    let mut slopes: Vec<&mut [f64]> = slopes.iter_mut().map(<[f64; 3]>::as_mut_slice).collect();
    program.linearise(&mut Registers::new(), [&inputs, &inputs], [&mut values, &mut slopes]);
}
