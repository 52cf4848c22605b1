//! Random damage to files, as a slip of the pen, a broken download or ill will would do it.

use super::random::Random;

/// Numbers that programs trip over.
const NUMBERS: [&str; 26] = [
    "0",
    "-1",
    "1",
    "2",
    "0.0",
    "-0.0",
    "1e-300",
    "5e-324",
    "1e300",
    "1e308",
    "-1e308",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "0.1",
    "1e-16",
    "1000000",
    "65535",
    "65536",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551616",
    "0x7f",
    "1_000",
];

/// Values of other kinds.
const VALUES: [&str; 14] = [
    "\"\"",
    "\"x\"",
    "true",
    "[]",
    "[[]]",
    "{}",
    "[1, 2]",
    "[[1, 1], [2, 3]]",
    "\"none\"",
    "'''a'''",
    "\"\\u0000\\u001b[2J\"",
    "{ from = 0.0, to = 0.0, points = 1 }",
    "{ from = 1.0, to = 0.5, points = 1000000000 }",
    "{ of_largest = 2.0 }",
];

/// Files that are none, or have no end.
const PATHS: [&str; 6] =
    ["\"/dev/zero\"", "\"/dev/null\"", "\"/dev/stdin\"", "\".\"", "\"nowhere\"", "\"pipe\""];

/// Pieces that mean something in one format or another.
const PIECES: [&[u8]; 16] = [
    b"0",
    b"-1",
    b"nan",
    b"inf",
    b"1e308",
    b"1e999",
    b"99999999999",
    b"\n",
    b" ",
    b",",
    b"\0",
    b"\xff\xfe",
    b"\r\n",
    b"%",
    b"<!--",
    b"\xc3\x28",
];

/// An experiment file with a few mistakes in it; `others` lend their lines.
pub fn experiment(text: &str, others: &[String], random: &mut Random) -> Vec<u8> {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for _ in 0..=random.below(3) {
        mistake(&mut lines, others, random);
    }
    let mut bytes = (lines.join("\n") + "\n").into_bytes();
    if random.below(10) == 0 {
        damage(&mut bytes, random);
    }
    bytes
}

/// One mistake in a list of lines.
fn mistake(lines: &mut Vec<String>, others: &[String], random: &mut Random) {
    if lines.is_empty() {
        lines.push("seed = 1".into());
    }
    let at = random.below(lines.len());
    match random.below(12) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, lines[at].clone()),
        2 => {
            let other = random.below(lines.len());
            lines.swap(at, other);
        }
        3 => {
            let other: Vec<&str> = random.of(others).lines().collect();
            lines.insert(at, (*random.of(&other)).to_owned());
        }
        4 => {
            let line: Vec<char> = lines[at].chars().collect();
            let cut = random.below(line.len() + 1);
            lines[at] = line[..cut].iter().collect();
        }
        5 => slip(&mut lines[at], random),
        _ => {
            // Values are what most lines are about; the first with one from here on.
            let keys = lines.iter_mut().skip(at).find(|line| line.contains('='));
            keys.into_iter().for_each(|line| value(line, random));
        }
    }
}

/// Gives a key another value, or one of the numbers on a line.
fn value(line: &mut String, random: &mut Random) {
    let numbers: Vec<(usize, usize)> = numbers(line);
    let Some((key, _)) = line.split_once('=') else { return slip(line, random) };
    if !numbers.is_empty() && random.below(3) > 0 {
        let (from, to) = *random.of(&numbers);
        let number: &str = random.of::<&str>(&NUMBERS);
        line.replace_range(from..to, number);
        return;
    }
    let value = match (key.trim(), random.below(4)) {
        ("path", _) => random.of(&PATHS),
        (_, 0) => random.of(&VALUES),
        _ => random.of(&NUMBERS),
    };
    *line = format!("{key}= {value}");
}

/// Where the numbers of a line begin and end.
fn numbers(line: &str) -> Vec<(usize, usize)> {
    let is_part = |c: char| c.is_ascii_digit() || c == '.';
    let mut found = Vec::new();
    let mut start = None;
    for (at, c) in line.char_indices().chain([(line.len(), ' ')]) {
        match (start, is_part(c)) {
            (None, true) => start = Some(at),
            (Some(from), false) => {
                found.push((from, at));
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// Changes one letter.
fn slip(line: &mut String, random: &mut Random) {
    let mut letters: Vec<char> = line.chars().collect();
    if letters.is_empty() {
        return;
    }
    let at = random.below(letters.len());
    letters[at] = *random.of(&['x', '=', '[', ']', '"', '.', '#', '\u{1b}', 'ε', ' ']);
    *line = letters.into_iter().collect();
}

/// Random damage to bytes, which are a network or anything else.
pub fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len() + 1);
        let length = random.below(1 + (bytes.len() - at).min(64));
        match random.below(7) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..at + length)),
            2 => {
                let copy = bytes[at..at + length].to_vec();
                let to = random.below(bytes.len() + 1);
                drop(bytes.splice(to..to, copy));
            }
            3 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            4 if at < bytes.len() => bytes[at] = random.bits() as u8,
            5 => number(bytes, random),
            _ => drop(bytes.splice(at..at, random.of(&PIECES).iter().copied())),
        }
    }
}

/// Gives a number that stands in the bytes as text another value.
fn number(bytes: &mut Vec<u8>, random: &mut Random) {
    let text = String::from_utf8_lossy(bytes).into_owned();
    // Positions in the text are those in the bytes only where nothing was replaced.
    let numbers = if text.len() == bytes.len() { numbers(&text) } else { Vec::new() };
    if !numbers.is_empty() {
        let (from, to) = *random.of(&numbers);
        drop(bytes.splice(from..to, random.of(&NUMBERS).bytes()));
    }
}
