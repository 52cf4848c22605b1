//! Every wrong system is answered with its place, what is wrong, and the way out where there is one.

use equations::{Description, Expression, Fault, Kind, Mistake, Place, System, Warning};

/// A formula, what of it is at fault, and parts of what is said and advised.
const FORMULAS: [(&str, &str, &str, &str); 53] = [
    ("", "", "nothing is written", "write 0"),
    ("  \t ", "  \t ", "nothing is written", "write 0"),
    ("x + ", "", "found the end, but expected a number", ""),
    ("x + * y", "*", "found `*`, but expected a number", ""),
    ("(x + y", "", "opened at byte 0 is not closed", "missing )"),
    ("x*(y + (z - 1)", "", "opened at byte 2 is not closed", "missing )"),
    ("sin(x", "", "opened at byte 3 is not closed", "missing )"),
    ("x + y)", ")", "closes none", "missing"),
    ("sin(x))", ")", "closes none", "missing"),
    ("()", ")", "found `)`, but expected a number", ""),
    ("2x", "x", "no sign before `x`", "with *"),
    ("2 x", "x", "no sign before `x`", "with *"),
    ("x y", "y", "no sign before `y`", "with *"),
    ("2(x + 1)", "(", "no sign before `(`", "with *"),
    ("(x)(y)", "(", "no sign before `(`", "with *"),
    ("x(y + 1)", "x", "no function `x`", "write x*(…)"),
    ("x**2", "**", "two asterisks", "use ^"),
    ("x − y", "−", "minus sign of typeset text (U+2212)", "write -"),
    ("x – y", "–", "dash (U+2013)", "write -"),
    ("x·y", "·", "middle dot", "write *"),
    ("x×y", "×", "multiplication sign", "write *"),
    ("x÷y", "÷", "division sign", "write /"),
    ("x² + 1", "²", "above the line", "write ^2"),
    ("x¹² + 1", "¹²", "above the line", "write ^12"),
    ("if(x ≤ 1, x, 0)", "≤", "U+2264", "write <="),
    ("√x", "√", "root", "sqrt"),
    ("x % 2", "%", "percent", "floor"),
    ("[x + 1]*2", "[", "bracket", "write ("),
    ("x & y", "&", "ampersand", "and"),
    ("if(x = 1, 2, 3)", "=", "single equals", "=="),
    ("if(!x, 2, 3)", "!", "exclamation", "not"),
    ("x ? y", "?", "`?` (U+003F) means nothing", ""),
    ("x \u{7} y", "\u{7}", "(U+0007) means nothing", ""),
    ("1e400", "1e400", "beyond the largest", ""),
    ("x + 1e-400", "1e-400", "below the smallest", "write 0"),
    ("1.2.3", "1.2.", "two decimal points", ""),
    ("1,5*x", ",", "comma", "with a point"),
    ("x, y", ",", "comma", ""),
    ("sin", "sin", "`sin` is a function", "sin(…)"),
    ("sin x", "sin", "`sin` is a function", "sin(…)"),
    ("sin()", "sin()", "`sin` has 0 arguments, but takes 1", ""),
    ("sin(x, y)", "sin(x, y)", "`sin` has 2 arguments, but takes 1", ""),
    ("atan2(x)", "atan2(x)", "`atan2` has 1 argument, but takes 2", ""),
    ("if(x > 0, 1)", "if(x > 0, 1)", "`if` has 2 arguments, but takes 3", ""),
    ("tahn(x)", "tahn", "no function `tahn`", "`tanh`?"),
    ("ln(x)", "ln", "no function `ln`", "`log`?"),
    ("Sin(x)", "Sin", "no function `Sin`", "`sin`?"),
    ("x < y", "x < y", "a condition, where a number", "if(condition, 1, 0)"),
    ("1 + (x < y)", "(x < y)", "a condition, where a number", "if(condition, 1, 0)"),
    ("if(x, 1, 2)", "x", "a number, where a condition", "comparison"),
    ("if(0 < x < 1, 1, 2)", "<", "compared once more", "a < b and b < c"),
    ("if(x > 0 and y, 1, 2)", "y", "a number, where a condition", "comparison"),
    ("if(and x > 0, 1, 2)", "and", "found `and`", ""),
];

#[track_caller]
fn check(mistake: &Mistake, text: &str, at: &str, says: &str, advises: &str) {
    let place = mistake.at.clone().expect("the fault is in the text");
    assert_eq!(text.get(place), Some(at), "{text:?}: {mistake:?}");
    let said = mistake.to_string();
    assert!(said.contains(says), "{text:?}: {said}");
    let remedy = mistake.remedy().unwrap_or_default();
    assert!(remedy.contains(advises), "{text:?}: {remedy}");
    assert!(!advises.is_empty() || remedy.is_empty(), "{text:?}: {remedy}");
}

#[test]
fn every_wrong_formula_is_answered_with_place_and_remedy() {
    for (text, at, says, advises) in FORMULAS {
        let mistake = Expression::read(text).expect_err(text);
        check(&mistake, text, at, says, advises);
    }
}

#[test]
fn long_and_deep_formulas_are_answered() {
    let long = "x + ".repeat(25_000) + "x";
    let mistake = Expression::read(&long).expect_err("100 kB");
    assert!(matches!(mistake.fault, Fault::TooLong { bytes: 100_001, .. }));
    for deep in ["(", "-", "sin(", "2^", "if(", "not ", "if(x<"] {
        for count in [1_000, 100_000] {
            let mistake = Expression::read(&deep.repeat(count)).expect_err(deep);
            let fault = mistake.fault;
            assert!(matches!(fault, Fault::TooDeep { .. } | Fault::TooLong { .. }), "{fault:?}");
        }
    }
    // Long sums are not deep, and a few hundred parentheses beside each other are not either.
    Expression::read(&("x + ".repeat(15_000) + "x")).expect("60 kB");
    Expression::read(&("(x) + ".repeat(1_000) + "x")).expect("flat");
}

/// Two components with a parameter and a subexpression each of which is used.
fn sound() -> Description<'static> {
    Description {
        kind: Kind::Flow,
        components: vec!["x", "y"],
        equations: vec![("x", "alpha*y - f"), ("y", "-x + t")],
        subexpressions: vec![("f", "x^3")],
        parameters: vec![("alpha", 2.0)],
    }
}

#[track_caller]
fn mistake(change: impl FnOnce(&mut Description<'static>)) -> Mistake {
    let mut description = sound();
    change(&mut description);
    System::read(&description).expect_err("the system is wrong")
}

#[test]
fn a_sound_system_is_read_without_warnings() {
    let system = System::read(&sound()).expect("sound");
    assert_eq!(system.warnings(), []);
    assert!(system.has_time());
}

#[test]
fn unknown_names_are_answered_with_the_nearest_known_one() {
    let text = "alpah*y - f";
    let unknown = mistake(|d| d.equations[0].1 = text);
    assert_eq!(unknown.place, Place::Equation("x".into()));
    check(&unknown, text, "alpah", "known are alpha, f, x, y", "`alpha`?");
    let text = "x*gamma";
    let unknown = mistake(|d| d.subexpressions[0].1 = text);
    assert_eq!(unknown.place, Place::Subexpression("f".into()));
    check(&unknown, text, "gamma", "`gamma` is unknown", "");
    let text = "sin(π*x)";
    check(&mistake(|d| d.equations[0].1 = text), text, "π", "unknown", "`pi`?");
    let text = "alpha*Y - f";
    check(&mistake(|d| d.equations[0].1 = text), text, "Y", "unknown", "`y`?");
}

#[test]
fn mistakes_in_a_formula_are_placed_in_its_equation() {
    let text = "alpha*(y - f";
    let unclosed = mistake(|d| d.equations[0].1 = text);
    assert_eq!(unclosed.place, Place::Equation("x".into()));
    check(&unclosed, text, "", "equation of `x`: the parenthesis opened at byte 6", "missing )");
}

/// Says something of a part other than a text.
#[track_caller]
fn check_system(mistake: &Mistake, place: &Place, says: &str) {
    assert_eq!(mistake.place, *place);
    assert_eq!(mistake.at, None);
    assert!(mistake.to_string().contains(says), "{mistake}");
}

#[test]
fn components_and_equations_have_to_belong_together() {
    let missing = mistake(|d| d.equations.truncate(1));
    check_system(&missing, &Place::Component("y".into()), "component `y`: it has no equation");
    let stray = mistake(|d| d.equations.push(("z", "x")));
    check_system(&stray, &Place::Equation("z".into()), "no such component; there are x, y");
    let twice = mistake(|d| d.equations.push(("y", "x")));
    check_system(&twice, &Place::Equation("y".into()), "used before, by the equation of `y`");
    let none = mistake(|d| d.components.clear());
    check_system(&none, &Place::System, "no components");
}

#[test]
fn seventeen_components_are_refused_and_so_are_sixteen_with_time() {
    const NAMES: [&str; 17] =
        ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "o", "p", "q"];
    let with = |count: usize, equation: &'static str| Description {
        components: NAMES[..count].to_vec(),
        equations: NAMES[..count].iter().map(|name| (*name, equation)).collect(),
        ..Description::default()
    };
    System::read(&with(16, "a")).expect("sixteen");
    for description in [with(17, "a"), with(16, "a*t")] {
        let mistake = System::read(&description).expect_err("seventeen");
        check_system(&mistake, &Place::System, "there are 17 components, but at most 16 may be");
    }
}

#[test]
fn more_text_than_is_read_is_refused_whole() {
    let half: &'static str = "x + x*x - x/x + 1.5".repeat(2_000).leak();
    let long = mistake(|d| (d.equations[0].1, d.equations[1].1) = (half, half));
    check_system(&long, &Place::System, "76003 bytes are written, but at most 65536 are read");
}

#[test]
fn names_are_unique_free_and_names() {
    let twice = mistake(|d| d.parameters.push(("x", 1.0)));
    check_system(&twice, &Place::Parameter("x".into()), "used before, by the component `x`");
    let twice = mistake(|d| d.subexpressions.push(("f", "1")));
    check_system(&twice, &Place::Subexpression("f".into()), "by the subexpression `f`");
    for reserved in ["t", "pi", "sin", "if", "and"] {
        let reserved = mistake(|d| d.parameters.push((reserved, 1.0)));
        assert_eq!(reserved.fault, Fault::Reserved);
    }
    for wrong in ["", "2a", "a b", "a-b", "x²"] {
        assert_eq!(mistake(|d| d.parameters.push((wrong, 1.0))).fault, Fault::NoName);
    }
}

#[test]
fn parameters_are_finite() {
    for value in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let wrong = mistake(|d| d.parameters[0].1 = value);
        check_system(&wrong, &Place::Parameter("alpha".into()), "its value is");
    }
}

#[test]
fn cycles_are_spelt_out() {
    let cycle = mistake(|d| {
        d.subexpressions = vec![("f", "x + g"), ("g", "y*h"), ("h", "2*g + k"), ("k", "x")];
    });
    check_system(&cycle, &Place::Subexpression("g".into()), "made of itself: g ← h ← g");
    let own = mistake(|d| d.subexpressions[0].1 = "f + 1");
    check_system(&own, &Place::Subexpression("f".into()), "made of itself: f ← f");
}

#[test]
fn subexpressions_stand_in_any_order() {
    let mut description = sound();
    description.subexpressions = vec![("f", "g*h"), ("g", "h + x"), ("h", "y^2")];
    System::read(&description).expect("no cycle");
}

#[test]
fn what_nothing_uses_is_a_warning() {
    let mut description = sound();
    description.equations = vec![("x", "-x"), ("y", "x")];
    let system = System::read(&description).expect("sound");
    let unused = [
        Place::Component("y".into()),
        Place::Subexpression("f".into()),
        Place::Parameter("alpha".into()),
    ];
    assert_eq!(system.warnings(), unused.map(Warning::Unused));
    assert_eq!(system.warnings()[2].to_string(), "parameter `alpha`: nothing uses it");
}

#[test]
fn a_coupling_has_formulas_for_some_components_and_no_time() {
    let mut coupling = sound();
    coupling.kind = Kind::Coupling;
    coupling.equations = vec![("y", "alpha*tanh(y)")];
    coupling.subexpressions.clear();
    let system = System::read(&coupling).expect("sound");
    assert_eq!(system.with_equation().collect::<Vec<_>>(), [1]);
    coupling.equations[0].1 = "t*y";
    let mistake = System::read(&coupling).expect_err("time");
    check(&mistake, "t*y", "t", "`t` has no meaning in a coupling", "driven");
}
