//! Full matrices as text.

use std::io::Read;

use graph::formats::TextError;
use graph::formats::dense::{DenseError, MAX_ROW_BYTES, read};
use proptest::prelude::*;

use super::{DIRECTED, SYMMETRIC, block, dense, driving, fixture, refusal, transposed, whole};

#[track_caller]
fn check(text: &str, matrix: [[f64; 2]; 2], labels: [&str; 2]) {
    let network = read(text.as_bytes(), &whole()).unwrap();
    assert_eq!(dense(&network), matrix, "{text:?}");
    assert_eq!(network.labels(), labels, "{text:?}");
}

#[track_caller]
fn check_refused(text: &str, message: &str) {
    assert_eq!(refusal(read(text.as_bytes(), &whole())), message);
}

const TWO: [[f64; 2]; 2] = [[0.0, 1.0], [2.5, 0.0]];

#[test]
fn numpys_text_gives_the_matrix_that_was_written() {
    let network = read(fixture!("dense.dat"), &whole()).unwrap();
    assert_eq!(dense(&network), SYMMETRIC);
    assert_eq!(network.labels(), ["1", "2", "3", "4"]);
    assert_eq!(dense(&read(fixture!("dense.csv"), &whole()).unwrap()), DIRECTED);
    assert_eq!(dense(&read(fixture!("dense.csv"), &driving()).unwrap()), transposed(DIRECTED));
}

#[test]
fn pythons_csv_gives_the_labels_that_were_written() {
    let network = read(fixture!("labelled.csv"), &whole()).unwrap();
    assert_eq!(dense(&network), DIRECTED);
    assert_eq!(network.labels(), ["V1", "the \"other\", V2", "A1"]);
    assert!(network.is_directed());
    let part = read(fixture!("labelled.csv"), &block(1, 3)).unwrap();
    assert_eq!(part.labels(), ["the \"other\", V2", "A1"]);
    assert_eq!(dense(&part), [[5.0, 1.0], [4.0, 0.0]]);
}

#[test]
fn blanks_tabs_commas_and_semicolons_separate_values() {
    for text in ["0 1\n2.5 0", "  0   1 \n 2.5\t0\n", "0\t1\n2.5\t0", "0,1\n2.5,0", "0; 1\n2.5 ;0"]
    {
        check(text, TWO, ["1", "2"]);
    }
}

#[test]
fn labels_stand_above_the_columns_before_the_rows_or_both() {
    for text in [
        "a b\n0 1\n2.5 0\n",
        "a b\na 0 1\nb 2.5 0\n",
        ",a,b\na,0,1\nb,2.5,0\n",
        "a,b\n0,1\n2.5,0\n",
        "\ta\tb\na\t0\t1\nb\t2.5\t0\n",
        "# above\n\n\"a\" \"b\"\n% between\n0 1\n2.5 0\n",
    ] {
        check(text, TWO, ["a", "b"]);
    }
    check(",1,2\n1,0,1\n2,2.5,0\n", TWO, ["1", "2"]);
    check("\"a \"\"x\"\"\", b c \n0,1\n2.5,0\n", TWO, ["a \"x\"", "b c"]);
}

#[test]
fn malformed_matrices_are_refused_where_they_are_wrong() {
    let cases = [
        ("", "expected at least one row of numbers, found none in 0 lines"),
        ("# nothing\n\n", "expected at least one row of numbers, found none in 2 lines"),
        ("a b\n", "expected at least one row of numbers, found none in 1 lines"),
        ("0 1\n1 0 0\n", "line 2: expected 2 values as in line 1, found 3"),
        ("0 1\n1\n", "line 2: expected 2 values as in line 1, found 1"),
        ("0 1\n1 x\n", "line 2, column 3: expected a finite number, found `x`"),
        ("0,1\n1,\n", "line 2, column 3: expected a finite number, found ``"),
        ("0,1\n1 0\n", "line 2, column 1: expected a finite number, found `1 0`"),
        ("0,1\n inf,0\n", "line 2, column 2: expected a finite number, found `inf`"),
        ("0 NaN\n1 0\n", "line 1, column 3: expected a finite number, found `NaN`"),
        ("0 1 2\n1 0 2\n", "expected as many rows as columns, found 2 rows and 3 columns"),
        ("0 1\n1 0\n1 1\n", "expected as many rows as columns, found 3 rows and 2 columns"),
        (
            "a b c\n0 1 0 1 1\n",
            "line 1: expected 4 labels, or 5 with one for the labels of rows, \
                                found 3",
        ),
        (",a,b\na,0,1\nc,1,0\n", "line 3: expected the row of `b`, found that of `c`"),
        ("a,a\n0,1\n1,0\n", "two nodes are called `a`"),
        ("\"a,b\n0,1\n", "line 1, column 1: expected a closing quote before the end of the line"),
        ("\"a\"x,b\n0,1\n", "line 1, column 4: expected a separator after the quote"),
    ];
    for (text, message) in cases {
        check_refused(text, message);
    }
}

#[test]
fn a_line_without_end_is_refused_in_bounded_memory() {
    let source = std::io::repeat(b'1').take(10 * MAX_ROW_BYTES as u64);
    let error = read(source, &whole()).unwrap_err();
    let DenseError::Text(TextError::LineTooLong { line: 1, limit, .. }) = error else {
        panic!("{error}")
    };
    assert_eq!(limit, MAX_ROW_BYTES);
}

proptest! {
    #[test]
    fn what_is_written_is_read_back(
        values in proptest::array::uniform3(proptest::array::uniform3(-1e300..1e300_f64)),
        separator in prop_oneof![Just(","), Just(" "), Just("\t"), Just(" ; ")],
    ) {
        let line = |row: &[f64; 3]| row.map(|value| format!("{value:?}")).join(separator);
        let text = values.each_ref().map(line).join("\n");
        prop_assert_eq!(dense(&read(text.as_bytes(), &whole()).unwrap()), values);
    }
}
