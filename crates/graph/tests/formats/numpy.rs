//! NumPy files, plain, in archives, and scipy's sparse matrices.

use std::io::{Cursor, Write};

use graph::formats::numpy::{NumpyError, read_npy, read_npz};
use graph::formats::{Layout, MatrixError};
use npyz::WriterBuilder;
use proptest::prelude::*;
use zip::write::{SimpleFileOptions, ZipWriter};

use super::{DIRECTED, SYMMETRIC, block, dense, driving, fixture, refusal, transposed, whole};

fn npz(bytes: &[u8], name: Option<&str>) -> Result<graph::RawNetwork, NumpyError> {
    read_npz(Cursor::new(bytes), name, &whole())
}

/// An `.npy` file of version 1 with that dictionary.
fn npy(dictionary: &str, data: &[u8]) -> Vec<u8> {
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend(u16::try_from(dictionary.len()).unwrap().to_le_bytes());
    file.extend(dictionary.as_bytes());
    file.extend(data);
    file
}

/// A vector as scipy stores it.
fn vector(descr: &str, length: usize, data: &[u8]) -> Vec<u8> {
    npy(&format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({length},), }}"), data)
}

fn words(values: &[i32]) -> Vec<u8> {
    let data: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    vector("<i4", values.len(), &data)
}

fn archive(files: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in files {
        writer.start_file(format!("{name}.npy"), SimpleFileOptions::default()).unwrap();
        writer.write_all(content).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// A sparse archive of three nodes in that format, with arrays replaced.
fn sparse(format: &str, replaced: &[(&'static str, Vec<u8>)]) -> Vec<u8> {
    let format = npy("{'descr': '|S3', 'fortran_order': False, 'shape': (), }", format.as_bytes());
    let mut files = vec![
        ("format", format),
        ("shape", words(&[3, 3])),
        ("data", words(&[7, 8])),
        ("indices", words(&[1, 0])),
        ("indptr", words(&[0, 1, 1, 2])),
    ];
    for (name, content) in replaced {
        files.retain(|(n, _)| n != name);
        files.push((name, content.clone()));
    }
    archive(&files)
}

#[test]
fn numpys_arrays_of_every_kind_give_the_matrix_that_was_written() {
    let read = |bytes| read_npy(bytes, &whole()).unwrap();
    assert_eq!(dense(&read(fixture!("c_float64.npy"))), SYMMETRIC);
    assert_eq!(dense(&read(fixture!("float16.npy"))), SYMMETRIC);
    let ones = SYMMETRIC.map(|row| row.map(|value| f64::from(u8::from(value > 0.0))));
    assert_eq!(dense(&read(fixture!("bool.npy"))), ones);
    for bytes in
        [fixture!("fortran_float32.npy"), fixture!("big_endian_int16.npy"), fixture!("uint64.npy")]
    {
        let network = read(bytes);
        assert_eq!(dense(&network), DIRECTED);
        assert!(network.is_directed());
        assert_eq!(network.labels(), ["1", "2", "3"]);
    }
}

#[test]
fn rows_that_drive_are_transposed_and_a_block_is_cut_out() {
    for bytes in [fixture!("fortran_float32.npy"), fixture!("uint64.npy")] {
        assert_eq!(dense(&read_npy(bytes, &driving()).unwrap()), transposed(DIRECTED));
        let part = read_npy(bytes, &block(1, 3)).unwrap();
        assert_eq!(dense(&part), [[5.0, 1.0], [4.0, 0.0]]);
        assert_eq!(part.labels(), ["2", "3"]);
    }
}

#[test]
fn numpys_archives_are_read_by_name_or_hold_one_array() {
    let plain = fixture!("plain.npz");
    assert_eq!(dense(&npz(plain, Some("structural")).unwrap()), SYMMETRIC);
    assert_eq!(dense(&npz(plain, Some("functional")).unwrap()), DIRECTED);
    assert_eq!(dense(&npz(fixture!("compressed.npz"), None).unwrap()), DIRECTED);
    assert_eq!(
        refusal(npz(plain, None)),
        "expected the name of one array, since the archive holds: `structural`, `functional`"
    );
    assert_eq!(
        refusal(npz(plain, Some("weights"))),
        "expected an array called `weights`; the archive holds: `structural`, `functional`"
    );
}

#[test]
fn scipys_sparse_archives_give_the_matrix_that_was_written() {
    for bytes in [fixture!("csr.npz"), fixture!("csc.npz"), fixture!("coo.npz")] {
        assert_eq!(dense(&npz(bytes, None).unwrap()), DIRECTED);
        let driving = read_npz(Cursor::new(bytes), None, &driving()).unwrap();
        assert_eq!(dense(&driving), transposed(DIRECTED));
    }
    assert_eq!(
        refusal(npz(fixture!("bsr.npz"), None)),
        "expected a sparse matrix in the format csr, csc or coo, found `bsr`"
    );
}

#[test]
fn headers_may_be_written_by_hand_or_by_python_2() {
    for dictionary in [
        "{\"shape\":(2L,2L),\"fortran_order\":False,\"descr\":\"|u1\"}",
        "{ 'descr' : '|u1' , 'fortran_order' : False , 'shape' : ( 2 , 2 , ) , }  \n",
    ] {
        let network = read_npy(&npy(dictionary, &[0, 1, 2, 0])[..], &whole()).unwrap();
        assert_eq!(dense(&network), [[0.0, 1.0], [2.0, 0.0]]);
    }
}

#[test]
fn malformed_arrays_are_refused() {
    let plain = |descr: &str, shape: &str| {
        format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}")
    };
    let cases = [
        (vec![], "expected an .npy file, which begins with the byte 0x93 and `NUMPY`"),
        (b"\x93NUMPY\x01\x00\x10".to_vec(), "the file ends within its header"),
        (b"\x93NUMPY\x01\x00\x10\x00{".to_vec(), "the file ends within its header"),
        (
            b"\x93NUMPY\x09\x01\x10\x00{".to_vec(),
            "expected version 1, 2 or 3 of the .npy format, found 9.1",
        ),
        (
            b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(),
            "the header has 4294967295 bytes; expected 10000 at most",
        ),
        (npy("{}", &[]), "the header lacks the key `descr`"),
        (npy("()", &[]), "header, byte 0: expected `{`, found `()`"),
        (
            npy("{'descr': '<f8', 'order': 'C'}", &[]),
            "header, byte 17: expected `descr`, `fortran_order` or `shape`, found `'order': 'C'}`",
        ),
        (
            npy("{'descr': '<f8', 'fortran_order': 0}", &[]),
            "header, byte 34: expected `True` or `False`, found `0}`",
        ),
        (
            npy(&plain("'<f8'", "(-1, 2)"), &[]),
            "header, byte 51: expected a whole number, found `-1, 2), }`",
        ),
        (
            npy(&plain("'|O'", "(2, 2)"), &[]),
            "expected elements that are booleans, integers or real numbers, found `|O`",
        ),
        (
            npy(&plain("[('a', '<f8')]", "(2, 2)"), &[]),
            "expected elements that are booleans, integers or real numbers, found a structure",
        ),
        (
            npy(&plain("'|S3'", "(2, 2)"), &[]),
            "expected elements that are booleans, integers or real numbers, found text",
        ),
        (
            npy(&plain("'<f8'", "(4,)"), &[]),
            "expected an array of 2 dimensions, found the shape [4]",
        ),
        (
            npy(&plain("'<f8'", "(2, 3)"), &[]),
            "expected as many rows as columns, found 2 rows and 3 columns",
        ),
        (npy(&plain("'|u1'", "(2, 2)"), &[1; 3]), "expected 4 bytes of elements, found 3"),
        (
            npy(&plain("'|u1'", "(2, 2)"), &[1; 5]),
            "expected the end of the file after 4 bytes of elements, found more",
        ),
        (
            npy(&plain("'<f2'", "(1, 1)"), &[0, 0x7e]),
            "row 1, column 1: expected a finite number, found NaN",
        ),
    ];
    for (file, message) in cases {
        assert_eq!(refusal(read_npy(&file[..], &whole())), message);
    }
    let three = refusal(read_npy(fixture!("three_dimensional.npy"), &whole()));
    assert_eq!(three, "expected an array of 2 dimensions, found the shape [2, 2, 2]");
    let complex = refusal(read_npy(fixture!("complex.npy"), &whole()));
    let expected = "expected elements that are booleans, integers or real numbers, found `<c16`";
    assert_eq!(complex, expected);
}

#[test]
fn a_shape_that_the_file_does_not_hold_allocates_nothing() {
    for shape in ["(4294967295, 4294967295)", "(1000000, 1000000)"] {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
        let error = read_npy(&npy(&header, &[0; 8])[..], &whole()).unwrap_err();
        assert!(matches!(error, NumpyError::Truncated { found: 8, .. }), "{error}");
    }
    let larger = "{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296), }";
    let error = read_npy(&npy(larger, &[])[..], &whole()).unwrap_err();
    let expected = MatrixError::TooManyNodes { n_nodes: 1 << 32 };
    assert!(matches!(error, NumpyError::Matrix(found) if found == expected));
    let vast = [
        ("shape", words(&[i32::MAX, i32::MAX])),
        ("data", words(&[])),
        ("row", words(&[])),
        ("col", words(&[])),
    ];
    assert_eq!(
        refusal(npz(&sparse("coo", &vast), None)),
        "2147483647 nodes with 0 non-zero entries: more than 1000000 would be isolated"
    );
}

#[test]
fn malformed_sparse_archives_are_refused_by_their_arrays() {
    assert_eq!(dense(&npz(&sparse("csr", &[]), None).unwrap())[0], [0.0, 7.0, 0.0]);
    let cases = [
        (
            ("shape", words(&[3])),
            "expected `shape` of the sparse matrix to have 2 elements, found 1",
        ),
        (
            ("indices", words(&[1])),
            "expected `indices` of the sparse matrix to have 2 elements, found 1",
        ),
        (
            ("indptr", words(&[0, 2])),
            "expected `indptr` of the sparse matrix to have 4 elements, found 2",
        ),
        (
            ("indptr", words(&[0, 2, 1, 2])),
            "element 2 of `indptr`: expected a whole number from 2 to 2, found 1",
        ),
        (
            ("indptr", words(&[0, 1, 1, 1])),
            "element 3 of `indptr`: expected a whole number from 2 to 2, found 1",
        ),
        (
            ("indptr", words(&[1, 1, 1, 2])),
            "element 0 of `indptr`: expected a whole number from 0 to 0, found 1",
        ),
        (
            ("indices", words(&[1, 3])),
            "element 1 of `indices`: expected a whole number from 0 to 2, found 3",
        ),
        (
            ("indices", words(&[1, -1])),
            "element 1 of `indices`: expected a whole number from 0 to 2, found -1",
        ),
        (("data", vector("<f8", 9, &[])), "array `data`: expected 72 bytes of elements, found 0"),
        (
            ("data", vector("|u1", 1 << 40, &[])),
            "array `data`: the array has 1099511627776 elements; expected 16",
        ),
        (
            ("format", words(&[1])),
            "array `format`: expected elements that are booleans, integers or real numbers, found a \
          format that is no text",
        ),
    ];
    for (replaced, message) in cases {
        let refused = refusal(npz(&sparse("csr", &[replaced]), None));
        // How many elements are kept depends on the length of the whole file.
        assert!(refused.starts_with(message), "{refused}");
    }
}

#[test]
fn what_is_no_archive_or_a_damaged_one_is_refused() {
    let message = refusal(npz(b"PK\x03\x04", None));
    assert!(message.starts_with("expected a zip archive: "), "{message}");
    let mut damaged = fixture!("plain.npz").to_vec();
    let place = damaged.windows(8).position(|w| w == 1.5f64.to_le_bytes()).unwrap();
    damaged[place + 6] ^= 1;
    let message = refusal(npz(&damaged, Some("structural")));
    assert!(message.starts_with("array `structural`: reading failed: "), "{message}");
}

proptest! {
    #[test]
    fn what_another_library_writes_is_read_back(
        values in proptest::array::uniform4(proptest::array::uniform4(-1e300..1e300_f64)),
        is_fortran in any::<bool>(),
    ) {
        let order = if is_fortran { npyz::Order::Fortran } else { npyz::Order::C };
        let stored = if is_fortran { transposed(values) } else { values };
        let mut file = Vec::new();
        let options = npyz::WriteOptions::new().default_dtype().shape(&[4, 4]).order(order);
        let mut writer = options.writer(&mut file).begin_nd().unwrap();
        writer.extend(stored.as_flattened()).unwrap();
        writer.finish().unwrap();
        prop_assert_eq!(dense(&read_npy(&file[..], &Layout::default()).unwrap()), values);
    }
}
