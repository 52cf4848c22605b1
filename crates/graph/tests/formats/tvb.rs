//! Connectivity archives of The Virtual Brain.

use std::io::{Cursor, Write};

use graph::Group;
use graph::formats::tvb::{TvbError, read};
use zip::CompressionMethod;
use zip::write::{SimpleFileOptions, ZipWriter};

use super::{DIRECTED, SYMMETRIC, block, dense, driving, fixture, refusal, transposed, whole};

fn archive(files: &[(&str, &str)]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in files {
        let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        writer.start_file(*name, stored).unwrap();
        writer.write_all(content.as_bytes()).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

fn tvb(bytes: &[u8]) -> Result<graph::RawNetwork, TvbError> {
    read(Cursor::new(bytes), &whole())
}

fn group(name: &str, nodes: &[usize]) -> Group {
    Group { name: name.to_owned(), nodes: nodes.to_vec() }
}

#[test]
fn areas_with_labels_of_their_own_have_no_groups() {
    let network = tvb(fixture!("tvb_regions.zip")).unwrap();
    assert_eq!(dense(&network), SYMMETRIC);
    assert_eq!(network.labels(), ["rV1", "rA1", "lV1", "lA1"]);
    assert_eq!(network.groups(), []);
    let positions = [[1.0, 2.0, 3.0], [4.0, 5.5, 6.0], [-1.0, 2.0, 3.0], [-4.0, 5.5, 6.0]];
    assert_eq!(network.positions(), Some(&positions[..]));
}

#[test]
fn areas_that_share_a_label_are_numbered_within_their_region() {
    let network = tvb(fixture!("tvb_parcels.zip")).unwrap();
    assert_eq!(dense(&network), DIRECTED);
    assert_eq!(network.labels(), ["rLOF-1", "rLOF-2", "lLOF-1"]);
    assert_eq!(network.groups(), [group("rLOF", &[0, 1]), group("lLOF", &[2])]);
    assert_eq!(network.positions().unwrap()[1], [36.0, 27.0, -14.0]);
}

#[test]
fn regions_and_positions_follow_a_block() {
    let source = Cursor::new(fixture!("tvb_parcels.zip"));
    let network = read(source, &block(1, 2)).unwrap();
    assert_eq!(dense(&network), [[5.0]]);
    assert_eq!(network.labels(), ["rLOF-2"]);
    assert_eq!(network.groups(), [group("rLOF", &[0])]);
    assert_eq!(network.positions(), Some(&[[36.0, 27.0, -14.0]][..]));
    let source = Cursor::new(fixture!("tvb_parcels.zip"));
    assert_eq!(dense(&read(source, &driving()).unwrap()), transposed(DIRECTED));
}

#[test]
fn shadows_of_a_mac_and_comments_are_passed_over() {
    let bytes = archive(&[
        ("__MACOSX/._weights.txt", "\u{0}"),
        ("brain/Weights.txt", "0 1\n1 0\n"),
        ("brain/centers.txt", "# label x y z\nA,1,2,3\nB,4,5,6\n\n"),
        ("brain/info.txt", "two areas"),
    ]);
    let network = tvb(&bytes).unwrap();
    assert_eq!(dense(&network), [[0.0, 1.0], [1.0, 0.0]]);
    assert_eq!(network.labels(), ["A", "B"]);
}

#[test]
fn malformed_archives_are_refused_by_their_files() {
    let (weights, centres) = (("weights.txt", "0 1\n1 0\n"), ("centres.txt", "A 1 2 3\nB 4 5 6\n"));
    let cases = [
        (
            vec![weights],
            "expected one file of centres (such as `centres.txt`), found 0; the archive holds: \
          `weights.txt`",
        ),
        (
            vec![centres, weights, ("old/weights.txt", "")],
            "expected one file of weights (such as `weights.txt`), found 2; the archive holds: \
          `centres.txt`, `weights.txt`, `old/weights.txt`",
        ),
        (
            vec![centres, ("weights.txt", "0 1\n1 x\n")],
            "weights.txt: line 2, column 3: expected a finite number, found `x`",
        ),
        (
            vec![centres, ("weights.txt", "0\n")],
            "expected as many centres as rows of weights, found 2 centres and 1 rows",
        ),
        (
            vec![weights, ("centres.txt", "A 1 2 3\nB 4 5\n")],
            "centres.txt, line 2: expected a label, x, y and z, found 3 values",
        ),
        (
            vec![weights, ("centres.txt", "A 1 2 3\nB 4 nan 6\n")],
            "centres.txt, line 2: expected y to be a finite number, found `nan`",
        ),
        (
            vec![centres, ("weights.txt.bz2", "0 1\n1 0\n")],
            "weights.txt.bz2: line 1: reading failed: bzip2: bz2 header missing",
        ),
    ];
    for (files, message) in cases {
        assert_eq!(refusal(tvb(&archive(&files))), message);
    }
    let message = refusal(tvb(b"weights"));
    assert!(message.starts_with("expected a zip archive: "), "{message}");
}

#[test]
fn what_is_damaged_within_the_archive_is_refused_with_the_cause() {
    let bytes = archive(&[("weights.txt", "0 1\n1 0\n"), ("centres.txt", "A 1 2 3\nB 4 5 6\n")]);
    let place = bytes.windows(4).position(|w| w == b"0 1\n").unwrap();
    let mut damaged = bytes.clone();
    damaged[place + 2] = b'2';
    let message = refusal(tvb(&damaged));
    assert!(message.starts_with("weights.txt: line 3: reading failed: "), "{message}");
    assert!(message.to_lowercase().contains("checksum"), "{message}");
}
