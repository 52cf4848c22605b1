//! MAT-files of level 5.

use graph::formats::matlab::{MatlabError, read};
use proptest::prelude::*;

use super::{DIRECTED, SYMMETRIC, block, dense, driving, fixture, refusal, transposed, whole};

/// The bytes of a file as another machine would have written them.
struct File {
    big_endian: bool,
    bytes: Vec<u8>,
}

impl File {
    fn new(big_endian: bool) -> Self {
        let mut bytes = vec![b' '; 124];
        bytes.extend(if big_endian { *b"\x01\x00MI" } else { *b"\x00\x01IM" });
        Self { big_endian, bytes }
    }

    fn word(&self, value: u32) -> [u8; 4] {
        if self.big_endian { value.to_be_bytes() } else { value.to_le_bytes() }
    }

    fn element(&self, kind: u32, data: &[u8]) -> Vec<u8> {
        let length = u32::try_from(data.len()).unwrap();
        let mut element = [self.word(kind), self.word(length)].concat();
        element.extend(data);
        element.resize(element.len().next_multiple_of(8), 0);
        element
    }

    fn words(&self, kind: u32, values: &[u32]) -> Vec<u8> {
        self.element(kind, &values.iter().flat_map(|&v| self.word(v)).collect::<Vec<_>>())
    }

    /// Adds the matrix `[0 2; 1 0]` with dimensions and name stored as those types.
    fn unusual(mut self, dimensions: u32, name: u32) -> Self {
        let mut content = self.words(6, &[6, 0]);
        content.extend(self.words(dimensions, &[2, 2]));
        content.extend(self.element(name, "Ä".as_bytes()));
        content.extend(self.doubles(&[0.0, 1.0, 2.0, 0.0]));
        self.bytes.extend(self.element(14, &content));
        self
    }

    /// Adds a variable: class, dimensions, name, and the elements that follow.
    fn variable(mut self, class: u32, dimensions: &[u32], name: &str, rest: &[Vec<u8>]) -> Self {
        let mut content = self.words(6, &[class, 0]);
        content.extend(self.words(5, dimensions));
        content.extend(self.element(1, name.as_bytes()));
        rest.iter().for_each(|element| content.extend(element));
        self.bytes.extend(self.element(14, &content));
        self
    }

    fn doubles(&self, values: &[f64]) -> Vec<u8> {
        let bytes = |v: &f64| if self.big_endian { v.to_be_bytes() } else { v.to_le_bytes() };
        self.element(9, &values.iter().flat_map(bytes).collect::<Vec<_>>())
    }
}

#[track_caller]
fn check_refused(bytes: &[u8], variable: Option<&str>, message: &str) {
    assert_eq!(refusal(read(bytes, variable, &whole())), message);
}

#[test]
fn scipys_files_give_the_matrices_that_were_written() {
    for file in [fixture!("plain.mat"), fixture!("compressed.mat")] {
        let variable = |name| read(file, Some(name), &whole()).unwrap();
        assert_eq!(dense(&variable("structural")), SYMMETRIC);
        assert_eq!(dense(&variable("counts")), DIRECTED);
        assert_eq!(dense(&variable("sparse")), DIRECTED);
        let ones = SYMMETRIC.map(|row| row.map(|value| f64::from(u8::from(value > 0.0))));
        assert_eq!(dense(&variable("mask")), ones);
        assert!(variable("counts").is_directed());
        assert_eq!(variable("counts").labels(), ["1", "2", "3"]);
    }
}

#[test]
fn scipys_matrices_are_cut_and_turned_as_asked() {
    for file in [fixture!("plain.mat"), fixture!("compressed.mat")] {
        for name in ["counts", "sparse"] {
            assert_eq!(dense(&read(file, Some(name), &driving()).unwrap()), transposed(DIRECTED));
            let part = read(file, Some(name), &block(1, 3)).unwrap();
            assert_eq!(dense(&part), [[5.0, 1.0], [4.0, 0.0]]);
            assert_eq!(part.labels(), ["2", "3"]);
        }
        assert_eq!(dense(&read(file, Some("wide"), &block(0, 3)).unwrap()), DIRECTED);
    }
}

#[test]
fn scipys_other_variables_are_refused_by_what_they_are() {
    let cases = [
        ("wide", "expected as many rows as columns, found 3 rows and 4 columns"),
        ("note", "expected `note` to be a matrix of real numbers, found text"),
        ("cells", "expected `cells` to be a matrix of real numbers, found a cell array"),
        ("nested", "expected `nested` to be a matrix of real numbers, found a structure"),
    ];
    for file in [fixture!("plain.mat"), fixture!("compressed.mat")] {
        for (name, message) in cases {
            let found = refusal(read(file, Some(name), &whole()));
            assert!(found.starts_with("the variable at byte "), "{found}");
            assert!(found.ends_with(message), "{found}");
        }
        check_refused(
            file,
            Some("weights"),
            "expected a variable called `weights`; the file holds: `note`, `structural`, `counts`, \
             `mask`, `sparse`, `cells`, `nested`, `wide`",
        );
        check_refused(
            file,
            None,
            "expected the name of one matrix of numbers; the file holds: `structural`, `counts`, \
             `mask`, `sparse`, `wide`",
        );
    }
}

#[test]
fn the_only_matrix_needs_no_name() {
    let file = File::new(false);
    let (scalar, matrix) = (file.doubles(&[1.0]), file.doubles(&[0.0, 1.0, 2.0, 0.0]));
    let file = file.variable(6, &[1, 1], "n", &[scalar]).variable(6, &[2, 2], "A", &[matrix]);
    assert_eq!(dense(&read(&file.bytes[..], None, &whole()).unwrap()), [[0.0, 2.0], [1.0, 0.0]]);
}

#[test]
fn files_of_either_byte_order_are_read() {
    for big_endian in [false, true] {
        let file = File::new(big_endian);
        // A(1,2) = 0.5, A(3,2) = 2, and room for one entry more.
        let sparse =
            [file.words(5, &[0, 2, 0]), file.words(5, &[0, 0, 2, 2]), file.doubles(&[0.5, 2.0])];
        let full = [file.words(6, &[0, 70_000, 3, 0])];
        let file = file.variable(5, &[3, 3], "S", &sparse).variable(6, &[2, 2], "F", &full);
        let sparse = read(&file.bytes[..], Some("S"), &whole()).unwrap();
        assert_eq!(dense(&sparse), [[0.0, 0.5, 0.0], [0.0; 3], [0.0, 2.0, 0.0]]);
        let full = read(&file.bytes[..], Some("F"), &whole()).unwrap();
        assert_eq!(dense(&full), [[0.0, 3.0], [70_000.0, 0.0]]);
    }
}

#[test]
fn dimensions_without_sign_and_names_in_utf_8_are_read() {
    let file = File::new(false).unusual(6, 16);
    let network = read(&file.bytes[..], Some("Ä"), &whole()).unwrap();
    assert_eq!(dense(&network), [[0.0, 2.0], [1.0, 0.0]]);
    let file = File::new(false).unusual(9, 16);
    let message = "the variable at byte 128: byte 152: expected the dimensions of a variable, found \
                   an element of type 9 with 8 bytes";
    check_refused(&file.bytes, None, message);
    let mut cut = File::new(false).unusual(5, 1);
    cut.bytes[156] = 7;
    let message = "the variable at byte 128: byte 152: expected the dimensions of a variable, found \
                   an element of type 5 with 7 bytes";
    check_refused(&cut.bytes, None, message);
}

#[test]
fn files_of_other_levels_are_told_apart() {
    let level_5 = "expected a MAT-file of level 5, found ";
    let convert = "`save -v7` writes level 5";
    check_refused(b"", None, &format!("{level_5}a file of fewer than 128 bytes"));
    let mut hdf5 = [b' '; 128];
    hdf5[124..].copy_from_slice(b"\x00\x02IM");
    check_refused(&hdf5, None, &format!("{level_5}level 7.3 (HDF5); {convert}"));
    check_refused(
        fixture!("version4.mat"),
        None,
        &format!("{level_5}level 4, or another format; {convert}"),
    );
    check_refused(&[b'x'; 200], None, &format!("{level_5}another format"));
}

#[test]
fn malformed_variables_are_refused_where_they_are_wrong() {
    let start = || File::new(false);
    let with = |rest: &[Vec<u8>]| start().variable(6, &[2, 2], "A", rest).bytes;
    let sparse = |indices: &[u32], starts: &[u32]| {
        let rest =
            [start().words(5, indices), start().words(5, starts), start().doubles(&[1.0, 1.0])];
        start().variable(5, &[2, 2], "A", &rest).bytes
    };
    let at = "the variable at byte 128: ";
    let cases = [
        (with(&[]), "byte 184: expected the matrix, found the end of the data"),
        (with(&[start().doubles(&[1.0])]), "byte 184: expected 4 numbers for the matrix, found 1"),
        (
            with(&[start().element(16, b"text")]),
            "byte 184: expected the matrix, found an element of type 16 with 4 bytes",
        ),
        (
            with(&[start().doubles(&[0.0, f64::INFINITY, 0.0, 0.0])]),
            "row 2, column 1: expected a finite number, found inf",
        ),
        (sparse(&[0, 2], &[0, 1, 2]), "row index 1: expected a number from 0 to 1, found 2"),
        (sparse(&[0, 1], &[1, 1, 2]), "start of column 0: expected a number from 0 to 0, found 1"),
        (sparse(&[0, 1], &[0, 2, 1]), "start of column 2: expected a number from 2 to 2, found 1"),
        (sparse(&[0, 1], &[0, 1, 3]), "start of column 2: expected a number from 1 to 2, found 3"),
        (sparse(&[0, 1], &[0, 2]), "byte 200: expected 3 numbers for starts of columns, found 2"),
        (
            start().variable(6, &[2, 2, 2], "A", &[]).bytes,
            "expected `A` to have two dimensions, found [2, 2, 2]",
        ),
        (
            start().variable(99, &[2, 2], "A", &[]).bytes,
            "expected `A` to be a matrix of real numbers, found a variable of unknown class",
        ),
    ];
    for (bytes, message) in cases {
        check_refused(&bytes, Some("A"), &format!("{at}{message}"));
    }
    let mut foreign = start().bytes;
    foreign.extend(start().element(9, &[0; 8]));
    check_refused(
        &foreign,
        None,
        "byte 128: expected a variable, found an element of type 9 with 8 bytes",
    );
    check_refused(
        &start().bytes,
        None,
        "expected the name of one matrix of numbers; the file \
                                         holds: none",
    );
}

#[test]
fn damage_within_a_compressed_variable_is_noticed() {
    let good = fixture!("compressed.mat");
    let mut n_noticed = 0;
    for place in 136..good.len() {
        let mut damaged = good.to_vec();
        damaged[place] ^= 0x10;
        match read(&damaged[..], Some("structural"), &whole()) {
            Err(_) => n_noticed += 1,
            // What was hit is another variable, or the padding that zlib's header holds.
            Ok(network) => assert_eq!(dense(&network), SYMMETRIC, "byte {place}"),
        }
    }
    assert!(n_noticed > 50, "{n_noticed}");
}

#[test]
fn a_length_that_the_file_does_not_hold_allocates_nothing() {
    let mut file = File::new(false);
    let mut content = file.words(6, &[6, 0]);
    content.extend(file.words(5, &[60_000, 60_000]));
    content.extend(file.element(1, b"A"));
    content.extend([file.word(2), file.word(3_600_000_000)].concat());
    file.bytes.extend([file.word(14), file.word(u32::MAX)].concat());
    file.bytes.extend(content);
    let error = read(&file.bytes[..], Some("A"), &whole()).unwrap_err();
    let MatlabError::InVariable { offset: 128, error } = error else { panic!("{error}") };
    assert!(matches!(*error, MatlabError::Truncated { .. }), "{error}");
}

proptest! {
    #[test]
    fn what_is_written_is_read_back(
        values in proptest::array::uniform4(proptest::array::uniform4(-1e300..1e300_f64)),
        big_endian in any::<bool>(),
    ) {
        let file = File::new(big_endian);
        let matrix = file.doubles(transposed(values).as_flattened());
        let file = file.variable(6, &[4, 4], "A", &[matrix]);
        prop_assert_eq!(dense(&read(&file.bytes[..], None, &whole()).unwrap()), values);
    }
}
