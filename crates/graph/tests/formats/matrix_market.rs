//! Matrix Market files.

use graph::formats::matrix_market::{MatrixMarketError, read};
use graph::formats::{MAX_SPARE_NODES, MatrixError};
use proptest::prelude::*;

use super::{DIRECTED, SYMMETRIC, block, dense, driving, fixture, refusal, transposed, whole};

#[track_caller]
fn check_refused(text: &str, message: &str) {
    assert_eq!(refusal(read(text.as_bytes(), &whole())), message);
}

#[test]
fn scipys_coordinate_files_give_the_matrix_that_was_written() {
    let symmetric = read(fixture!("coordinate_symmetric.mtx"), &whole()).unwrap();
    assert_eq!(dense(&symmetric), SYMMETRIC);
    assert!(!symmetric.is_directed());
    assert_eq!(symmetric.labels(), ["1", "2", "3", "4"]);
    let general = read(fixture!("coordinate_general.mtx"), &whole()).unwrap();
    assert_eq!(dense(&general), DIRECTED);
    assert!(general.is_directed());
}

#[test]
fn scipys_pattern_file_gives_ones() {
    let network = read(fixture!("coordinate_pattern.mtx"), &whole()).unwrap();
    let ones = SYMMETRIC.map(|row| row.map(|value| f64::from(u8::from(value > 0.0))));
    assert_eq!(dense(&network), ones);
    assert_eq!(network.into_network().unwrap().n_links(), 5);
}

#[test]
fn scipys_arrays_are_read_by_columns() {
    let general = read(fixture!("array_general.mtx"), &whole()).unwrap();
    assert_eq!(dense(&general), DIRECTED);
    let symmetric = read(fixture!("array_symmetric.mtx"), &whole()).unwrap();
    assert_eq!(dense(&symmetric), SYMMETRIC);
    assert!(!symmetric.is_directed());
}

#[test]
fn rows_that_drive_are_transposed() {
    let network = read(fixture!("coordinate_general.mtx"), &driving()).unwrap();
    assert_eq!(dense(&network), transposed(DIRECTED));
}

#[test]
fn a_block_keeps_the_labels_of_the_whole_matrix() {
    let network = read(fixture!("coordinate_symmetric.mtx"), &block(1, 4)).unwrap();
    assert_eq!(dense(&network), [[0.0, 0.25, 1.0], [0.25, 0.0, 3.0], [1.0, 3.0, 0.0]]);
    assert_eq!(network.labels(), ["2", "3", "4"]);
}

#[test]
fn a_block_makes_a_square_of_a_rectangle() {
    let text = "%%MatrixMarket matrix coordinate integer general\n2 3 2\n1 2 7\n2 3 9\n";
    let network = read(text.as_bytes(), &block(0, 2)).unwrap();
    assert_eq!(dense(&network), [[0.0, 7.0], [0.0, 0.0]]);
    let all = "expected as many rows as columns, found 2 rows and 3 columns";
    check_refused(text, all);
    let beyond = refusal(read(text.as_bytes(), &block(1, 3)));
    let expected = "expected a block of one row or more within 2 rows and 3 columns, found rows 2 \
                    to 3";
    assert_eq!(beyond, expected);
}

#[test]
fn headers_may_be_in_any_case_and_comments_stand_anywhere_after_them() {
    let text = "%%matrixmarket MATRIX Coordinate Real General\r\n%\r\n\r\n2 2 1\r\n% more\r\n\
                1 2 1e-3\r\n\r\n% end";
    let network = read(text.as_bytes(), &whole()).unwrap();
    assert_eq!(dense(&network), [[0.0, 1e-3], [0.0, 0.0]]);
}

#[test]
fn a_value_that_is_not_finite_matters_only_within_the_block() {
    let text = "%%MatrixMarket matrix coordinate real general\n3 3 2\n1 2 1\n3 3 nan\n";
    assert_eq!(read(text.as_bytes(), &block(0, 2)).unwrap().n_nodes(), 2);
    check_refused(text, "line 4, column 5: expected a finite number, found `nan`");
}

#[test]
fn malformed_files_are_refused_where_they_are_wrong() {
    let expected = "line 1: expected `%%MatrixMarket matrix FORMAT FIELD SYMMETRY`, found ";
    check_refused("", &format!("{expected}``"));
    check_refused("1 2 3\n", &format!("{expected}`1 2 3`"));
    let head = "%%MatrixMarket matrix coordinate real general\n";
    let cases = [
        (
            "",
            "expected a line with the numbers of rows, columns and entries, found the end of the \
              file after line 1",
        ),
        ("3 3\n", "line 2: expected the numbers of rows, columns and entries, found 2 values"),
        ("3 3 x\n", "line 2, column 5: expected a whole number, found `x`"),
        ("3 3 2\n1 2 1\n", "expected 2 entries, found 1 before the file ends in line 3"),
        (
            "3 3 1\n1 2 1\n\n2 1 1",
            "line 5: expected the end of the file after 1 entries, found \
                                   `2 1 1`",
        ),
        ("3 3 1\n 0 2 1\n", "line 3, column 2: expected an index from 1 to 3, found 0"),
        ("3 3 1\n1 4 1\n", "line 3, column 3: expected an index from 1 to 3, found 4"),
        ("3 3 1\n1 2\n", "line 3: expected a row, a column and a value, found 2 values"),
        ("3 3 1\n1 2 1.5.\n", "line 3, column 5: expected a finite number, found `1.5.`"),
        ("3 3 2\n1 2 1\n1 2 1\n", "the entry in row `1`, column `2` is given twice"),
        ("0 0 0\n", "expected a matrix of one row or more, found none"),
    ];
    for (rest, message) in cases {
        check_refused(&format!("{head}{rest}"), message);
    }
}

#[test]
fn a_repeated_entry_is_named_as_it_stands_in_the_file() {
    let text = "%%MatrixMarket matrix coordinate pattern general\n3 3 2\n1 2\n1 2\n";
    for layout in [whole(), driving()] {
        let message = "the entry in row `1`, column `2` is given twice";
        assert_eq!(refusal(read(text.as_bytes(), &layout)), message);
    }
}

#[test]
fn headers_that_make_no_network_are_refused_by_name() {
    let cases = [
        ("matrix coordinate complex general", "`real`, `integer` or `pattern`, found `complex`"),
        (
            "matrix array pattern general",
            "`real` or `integer`, as values of an array, found `pattern`",
        ),
        ("matrix coordinate real hermitian", "`general` or `symmetric`, found `hermitian`"),
        (
            "matrix coordinate real skew-symmetric",
            "`general` or `symmetric`, found `skew-symmetric`",
        ),
        ("matrix sparse real general", "`coordinate` or `array`, found `sparse`"),
        ("vector coordinate real general", "`matrix`, found `vector`"),
    ];
    for (header, message) in cases {
        check_refused(
            &format!("%%MatrixMarket {header}\n"),
            &format!("line 1: expected {message}"),
        );
    }
}

#[test]
fn a_symmetric_matrix_is_square_and_lists_an_entry_once() {
    let head = "%%MatrixMarket matrix coordinate pattern symmetric\n";
    check_refused(
        &format!("{head}2 3 0\n"),
        "line 2: a symmetric matrix cannot have 2 rows and 3 columns",
    );
    let twice = format!("{head}2 2 2\n2 1\n1 2\n");
    check_refused(&twice, "the entry in row `1`, column `2` is given twice");
}

#[test]
fn a_size_that_few_entries_do_not_explain_allocates_nothing() {
    let text = "%%MatrixMarket matrix coordinate pattern general\n4000000000 4000000000 1\n1 2\n";
    let error = read(text.as_bytes(), &whole()).unwrap_err();
    let MatrixMarketError::Matrix(MatrixError::MostlyIsolated { n_nodes, n_entries }) = error
    else {
        panic!("{error}")
    };
    assert_eq!((n_nodes, n_entries), (4_000_000_000, 1));
    assert!(MAX_SPARE_NODES < n_nodes);
    let huge =
        "%%MatrixMarket matrix array real general\n18446744073709551615 18446744073709551615";
    check_refused(
        huge,
        "18446744073709551615 nodes are more than the 4294967295 that can be \
                         numbered",
    );
}

proptest! {
    #[test]
    fn what_is_written_is_read_back(
        entries in proptest::collection::btree_map((0_usize..9, 0_usize..9), -1e9..1e9_f64, 0..40)
    ) {
        let mut text = format!("%%MatrixMarket matrix coordinate real general\n9 9 {}\n", entries.len());
        for ((i, j), value) in &entries {
            text += &format!("{} {} {value:e}\n", i + 1, j + 1);
        }
        let mut expected = [[0.0; 9]; 9];
        entries.iter().for_each(|(&(i, j), &value)| expected[i][j] = value);
        prop_assert_eq!(dense(&read(text.as_bytes(), &whole()).unwrap()), expected);
    }
}
