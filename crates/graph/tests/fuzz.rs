//! Every reader survives damaged files: a deterministic mutation fuzzer over the fixtures.
//!
//! Each test mutates the files of its format (bits, bytes, numbers, truncation, splices of two
//! files) and reads the result until its time is over; a panic, a hang or memory out of proportion
//! fails it. A second by default; `EIGENSYNC_FUZZ_SECONDS=600` for longer, and
//! `EIGENSYNC_FUZZ_SEED` for another run than the first. What a round found is told by its number,
//! which reproduces it whatever the time.

use std::io::{Cursor, Read, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use graph::RawNetwork;
use graph::formats::{Layout, Rows, dense, edge_list, graphml, matlab, matrix_market, numpy, tvb};
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use zip::write::{SimpleFileOptions, ZipWriter};
use zip::{CompressionMethod, ZipArchive};

/// A file that takes longer than this to be read or refused is a finding.
const SLOW: Duration = Duration::from_secs(10);

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

macro_rules! files {
    ($($name:literal),+) => {
        &[$(&include_bytes!(concat!("fixtures/", $name))[..]),+]
    };
}

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

fn layout(random: &mut Pcg64) -> Layout {
    let rows = if below(random, 2) == 0 { Rows::Driven } else { Rows::Driving };
    let start = below(random, 3);
    let block = (below(random, 2) == 0).then(|| start..start + below(random, 4));
    Layout { rows, block }
}

/// What is read must be sound, and what is refused must say why on one line of bounded length.
fn check<E: std::fmt::Display>(result: Result<RawNetwork, E>) {
    match result {
        Ok(network) => {
            assert!(network.matrix().data().iter().all(|value| value.is_finite()));
            assert_eq!(network.matrix().rows(), network.labels().len());
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.is_empty() && message.len() < 4096, "{} bytes", message.len());
            assert!(!message.contains(char::is_control), "{message:?}");
        }
    }
}

fn fuzz(files: &[&[u8]], read: impl Fn(&mut Pcg64, &[u8])) {
    fuzz_with(|random| mutate(random, files), read);
}

fn fuzz_archives(archives: &[&[u8]], read: impl Fn(&mut Pcg64, &[u8])) {
    let files: Vec<_> = archives.iter().map(|archive| unpacked(archive)).collect();
    let mutate = |random: &mut Pcg64| match below(random, 4) {
        0 => mutate(random, archives),
        _ => mutate_within(random, &files),
    };
    fuzz_with(mutate, read);
}

fn fuzz_with(mutate: impl Fn(&mut Pcg64) -> Vec<u8>, read: impl Fn(&mut Pcg64, &[u8])) {
    let seconds = Duration::from_secs(setting("EIGENSYNC_FUZZ_SECONDS", 1));
    let seed = setting("EIGENSYNC_FUZZ_SEED", 0);
    let start = Instant::now();
    let mut round = 0;
    while start.elapsed() < seconds {
        let mut random = Pcg64::seed_from_u64((seed << 40) ^ round);
        let file = mutate(&mut random);
        let began = Instant::now();
        let outcome = catch_unwind(AssertUnwindSafe(|| read(&mut random, &file)));
        let shown = || String::from_utf8_lossy(&file[..file.len().min(2000)]).into_owned();
        assert!(outcome.is_ok(), "round {round} of seed {seed}: {:?}\n{}", file, shown());
        assert!(began.elapsed() < SLOW, "round {round} took {:?}: {}", began.elapsed(), shown());
        round += 1;
    }
    println!("{round} files");
}

#[test]
fn edge_lists_are_read_or_refused() {
    let files: &[&[u8]] = &[
        include_bytes!("../../../experiments/networks/nepal.edges"),
        include_bytes!("../../../experiments/networks/six-node.edges"),
        b"\"area 17\" 4, 2.5 # comment\n5\n% more\na;b c\n",
    ];
    fuzz(files, |_, file| check(edge_list::read(file).map(RawNetwork::from)));
}

#[test]
fn matrix_market_files_are_read_or_refused() {
    let files = files![
        "coordinate_symmetric.mtx",
        "coordinate_general.mtx",
        "coordinate_pattern.mtx",
        "array_general.mtx",
        "array_symmetric.mtx"
    ];
    fuzz(files, |random, file| check(matrix_market::read(file, &layout(random))));
}

#[test]
fn dense_matrices_are_read_or_refused() {
    let files = files!["dense.txt", "dense.csv", "labelled.csv"];
    fuzz(files, |random, file| check(dense::read(file, &layout(random))));
}

#[test]
fn graphml_files_are_read_or_refused() {
    let files = files!["undirected.graphml", "directed.graphml"];
    let name = |random: &mut Pcg64, name: &str| (below(random, 2) == 0).then(|| name.to_owned());
    fuzz(files, |random, file| {
        let coordinates = ["x", "y", "z"].map(str::to_owned);
        let attributes = graphml::Attributes {
            weight: name(random, "strength"),
            label: name(random, "full"),
            group: name(random, "area"),
            position: coordinates[..below(random, 4)].to_vec(),
        };
        check(graphml::read(file, &attributes));
    });
}

#[test]
fn npy_files_are_read_or_refused() {
    let files = files![
        "c_float64.npy",
        "fortran_float32.npy",
        "big_endian_int16.npy",
        "uint64.npy",
        "bool.npy",
        "float16.npy",
        "complex.npy",
        "three_dimensional.npy"
    ];
    fuzz(files, |random, file| check(numpy::read_npy(file, &layout(random))));
}

#[test]
fn npz_archives_are_read_or_refused() {
    let files = files!["plain.npz", "compressed.npz", "csr.npz", "csc.npz", "coo.npz", "bsr.npz"];
    fuzz_archives(files, |random, file| {
        let name = (below(random, 2) == 0).then_some("structural");
        check(numpy::read_npz(Cursor::new(file), name, &layout(random)));
    });
}

#[test]
fn mat_files_are_read_or_refused() {
    let files = files!["plain.mat", "compressed.mat", "version4.mat"];
    let names = [None, Some("structural"), Some("counts"), Some("mask"), Some("sparse")];
    fuzz(files, |random, file| {
        let name = names[below(random, names.len())];
        check(matlab::read(file, name, &layout(random)));
    });
}

#[test]
fn tvb_archives_are_read_or_refused() {
    let files = files!["tvb_regions.zip", "tvb_parcels.zip"];
    fuzz_archives(files, |random, file| check(tvb::read(Cursor::new(file), &layout(random))));
}
