//! Every reader survives damaged files: a deterministic mutation fuzzer over the fixtures.
//!
//! Of every format in the list, the fixtures whose endings tell it are mutated (bits, bytes, numbers,
//! truncation, splices of two files) and read until the time is over; a panic, a hang or memory out of
//! proportion fails the test. A second by default; `EIGENSYNC_FUZZ_SECONDS=600` for longer, and
//! `EIGENSYNC_FUZZ_SEED` for another run than the first. What a round found is told by its number,
//! which reproduces it whatever the time.

use std::fs;
use std::io::{Cursor, Read, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use graph::formats::{Attributes, FORMATS, Format, Layout, Options, Rows};
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use zip::write::{SimpleFileOptions, ZipWriter};
use zip::{CompressionMethod, ZipArchive};

/// A file that takes longer than this to be read or refused is a finding.
const SLOW: Duration = Duration::from_secs(10);

/// How archives begin.
const ARCHIVE: &[u8] = b"PK\x03\x04";

/// Numbers at which sizes, signs and widths turn over, as text and as bytes.
const NUMBERS: [i64; 16] = [
    0,
    1,
    -1,
    2,
    3,
    127,
    128,
    255,
    256,
    65_535,
    65_536,
    i32::MAX as i64,
    u32::MAX as i64,
    1 << 40,
    i64::MAX,
    i64::MIN,
];
const TEXTS: [&str; 16] = [
    "nan",
    "-inf",
    "1e999",
    "1e-999",
    "-0",
    "99999999999999999999999",
    "4294967296",
    "\u{feff}",
    "\0",
    "\"",
    "<",
    "&#0;",
    "&#x110000;",
    "\r",
    ",",
    "'",
];

/// A number below `n`, near enough to uniform for the choice of mutations.
fn below(random: &mut Pcg64, n: usize) -> usize {
    usize::try_from(random.next_u64() % n.max(1) as u64).unwrap()
}

fn pick<'a, T: ?Sized>(random: &mut Pcg64, from: &[&'a T]) -> &'a T {
    from[below(random, from.len())]
}

fn mutate(random: &mut Pcg64, files: &[&[u8]]) -> Vec<u8> {
    let first = pick(random, files);
    mutate_first(random, first, files)
}

fn mutate_first(random: &mut Pcg64, first: &[u8], files: &[&[u8]]) -> Vec<u8> {
    let mut file = first.to_vec();
    for _ in 0..=below(random, 6) {
        let place = below(random, file.len());
        match below(random, 9) {
            0 if !file.is_empty() => file[place] ^= 1 << below(random, 8),
            1 if !file.is_empty() => file[place] = random.next_u64().to_le_bytes()[0],
            2 => file.truncate(place),
            3 => write(random, &mut file, place),
            4 => number(random, &mut file),
            5 => insert(&mut file, place, pick(random, &TEXTS).as_bytes()),
            6 => {
                let other = pick(random, files);
                splice(random, &mut file, place, other);
            }
            7 => repeat(random, &mut file, place),
            _ => remove(random, &mut file, place),
        }
    }
    file
}

/// Overwrites bytes with a notable number of 1, 2, 4 or 8 of them, in either order.
fn write(random: &mut Pcg64, file: &mut [u8], place: usize) {
    let mut bytes = NUMBERS[below(random, NUMBERS.len())].to_le_bytes();
    let width = 1 << below(random, 4);
    if below(random, 2) == 0 {
        bytes[..width].reverse();
    }
    for (old, new) in file[place..].iter_mut().zip(&bytes[..width]) {
        *old = *new;
    }
}

/// Replaces one run of digits by a notable number.
fn number(random: &mut Pcg64, file: &mut Vec<u8>) {
    let is_start =
        |i: &usize| file[*i].is_ascii_digit() && (*i == 0 || !file[i - 1].is_ascii_digit());
    let starts: Vec<usize> = (0..file.len()).filter(is_start).collect();
    if let Some(&start) = starts.get(below(random, starts.len())) {
        let length = file[start..].iter().take_while(|b| b.is_ascii_digit()).count();
        let new = NUMBERS[below(random, NUMBERS.len())].to_string();
        file.splice(start..start + length, new.bytes());
    }
}

fn insert(file: &mut Vec<u8>, place: usize, bytes: &[u8]) {
    file.splice(place..place, bytes.iter().copied());
}

/// Continues with the end of another file.
fn splice(random: &mut Pcg64, file: &mut Vec<u8>, place: usize, other: &[u8]) {
    file.truncate(place);
    file.extend(&other[below(random, other.len())..]);
}

fn repeat(random: &mut Pcg64, file: &mut Vec<u8>, place: usize) {
    let end = (place + below(random, 64)).min(file.len());
    let part = file[place..end].repeat(1 + below(random, 8));
    insert(file, place, &part);
}

fn remove(random: &mut Pcg64, file: &mut Vec<u8>, place: usize) {
    let end = (place + below(random, 16)).min(file.len());
    file.drain(place..end);
}

/// The files of an archive.
fn unpacked(archive: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut archive = ZipArchive::new(Cursor::new(archive)).unwrap();
    let n_files = archive.len();
    let unpack = |place| {
        let mut file = archive.by_index(place).unwrap();
        let mut content = Vec::new();
        file.read_to_end(&mut content).unwrap();
        (file.name().unwrap().into_owned(), content)
    };
    (0..n_files).map(unpack).collect()
}

/// An archive with one of its files mutated, sound in itself: damage to the archive as a whole
/// hardly ever passes its checksums.
fn mutate_within(random: &mut Pcg64, archives: &[Vec<(String, Vec<u8>)>]) -> Vec<u8> {
    let files = &archives[below(random, archives.len())];
    let target = below(random, files.len());
    let contents: Vec<&[u8]> = files.iter().map(|(_, content)| content.as_slice()).collect();
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (place, (name, content)) in files.iter().enumerate() {
        writer.start_file(name, stored).unwrap();
        let content = match place == target {
            true => mutate_first(random, content, &contents),
            false => content.clone(),
        };
        writer.write_all(&content).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |value| value.parse().expect("a whole number"))
}

/// Any choice, those of the fixtures among them.
fn options(random: &mut Pcg64) -> Options {
    let rows = if below(random, 2) == 0 { Rows::Driven } else { Rows::Driving };
    let start = below(random, 3);
    let block = (below(random, 2) == 0).then(|| start..start + below(random, 4));
    let variables = [None, Some("structural"), Some("counts"), Some("mask"), Some("sparse")];
    let variable = variables[below(random, variables.len())].map(str::to_owned);
    let mut name = |name: &str| (below(random, 2) == 0).then(|| name.to_owned());
    let (weight, label, group) = (name("strength"), name("full"), name("area"));
    let position = ["x", "y", "z"].map(str::to_owned)[..below(random, 4)].to_vec();
    let attributes = Attributes { weight, label, group, position };
    Options { variable, attributes, layout: Layout { rows, block } }
}

/// Whether a file is read: what is must be sound, and what is refused must say why on one line of bounded
/// length.
fn check(format: &Format, file: &[u8], options: &Options) -> bool {
    match (format.read)(&mut Cursor::new(file), options) {
        Ok(network) => {
            assert!(network.matrix().data().iter().all(|value| value.is_finite()));
            assert_eq!(network.matrix().rows(), network.labels().len());
            true
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.is_empty() && message.len() < 4096, "{} bytes", message.len());
            assert!(!message.contains(char::is_control), "{message:?}");
            false
        }
    }
}

/// The files here and in the folder of networks whose endings tell the format, in the order of their
/// names.
fn fixtures(format: &Format) -> Vec<Vec<u8>> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = [here.join("tests/fixtures"), here.join("../../experiments/networks")];
    let all = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap());
    let mut paths: Vec<PathBuf> = all.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| {
        let ending = path.extension().unwrap_or_default().to_str().unwrap();
        format.endings.contains(&ending)
    });
    paths.sort();
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}

/// Reads damaged files of a format for so long; how many were read, and how many refused.
fn fuzz(format: &Format, (seed, time): (u64, Duration)) -> [usize; 2] {
    let name = format.name;
    let files = fixtures(format);
    assert!(!files.is_empty(), "{name} has no file among the fixtures");
    let files: Vec<&[u8]> = files.iter().map(Vec::as_slice).collect();
    let archives: Vec<_> = files.iter().filter(|file| file.starts_with(ARCHIVE)).collect();
    let archives: Vec<_> = archives.into_iter().map(|file| unpacked(file)).collect();
    let start = Instant::now();
    let (mut round, mut outcomes) = (0, [0, 0]);
    while start.elapsed() < time {
        let mut random = Pcg64::seed_from_u64((seed << 40) ^ round);
        let file = match !archives.is_empty() && below(&mut random, 4) > 0 {
            true => mutate_within(&mut random, &archives),
            false => mutate(&mut random, &files),
        };
        let options = options(&mut random);
        let began = Instant::now();
        let outcome = catch_unwind(AssertUnwindSafe(|| check(format, &file, &options)));
        let shown = || String::from_utf8_lossy(&file[..file.len().min(2000)]).into_owned();
        let told = || format!("{name}, round {round} of seed {seed}: {options:?}");
        let Ok(is_read) = outcome else { panic!("{}: {file:?}\n{}", told(), shown()) };
        assert!(began.elapsed() < SLOW, "{} took {:?}: {}", told(), began.elapsed(), shown());
        outcomes[usize::from(!is_read)] += 1;
        round += 1;
    }
    println!("{name}: {} files read, {} refused", outcomes[0], outcomes[1]);
    outcomes
}

#[test]
fn damaged_files_of_every_format_are_read_or_refused() {
    let seconds = Duration::from_secs(setting("EIGENSYNC_FUZZ_SECONDS", 1));
    let seed = setting("EIGENSYNC_FUZZ_SEED", 0);
    let outcomes: Vec<_> = thread::scope(|scope| {
        let fuzz = |format| move || fuzz(format, (seed, seconds));
        let threads: Vec<_> = FORMATS.iter().map(|&format| scope.spawn(fuzz(format))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    for (format, [n_read, n_refused]) in FORMATS.iter().zip(outcomes) {
        assert!(n_read > 0 && n_refused > 0, "{}: {n_read} read, {n_refused} refused", format.name);
    }
}
