//! Connectivity archives of The Virtual Brain: a zip of text files.
//!
//! ```text
//! weights.txt      full matrix, one row a line; row i, column j: from area j to area i
//! centres.txt      one area a line: label, x, y, z (mm), in the order of the rows
//! ```
//!
//! Each may be compressed once more (`weights.txt.bz2`) and stand in a folder. Other files, such as
//! tract lengths, are passed over. Where several areas bear the label of their region, the regions
//! are groups, and the areas of region R are labelled R-1, R-2, … in the order of the file.
//!
//! Source: Sanz Leon et al., "The Virtual Brain: a simulator of primate brain network dynamics",
//! Frontiers in Neuroinformatics 7, 10 (2013); tvb-library, `datatypes/connectivity.py`.

use std::collections::HashMap;
use std::error::Error;
use std::io::{Read, Seek};
use std::ops::Range;

use bzip2::read::MultiBzDecoder;
use thiserror::Error;

use super::archive::{Archive, ArchiveError, Limited, MAX_UNPACKED_TEXT, listed};
use super::dense::{self, DenseError};
use super::format::{Choice, Format};
use super::matrix::{Layout, MatrixError};
use super::text::{Lines, TextError, quoted};
use crate::{GraphError, Group, RawNetwork};

/// Connectivity archives.
pub const FORMAT: Format = Format {
    name: "tvb",
    summary: "A connectivity archive of The Virtual Brain, `.zip`",
    endings: &["zip"],
    lists_links: false,
    choices: &[Choice::Block, Choice::Rows],
    read: |source, options| Ok(read(source, &options.layout)?),
};

/// Most centres: N rows of N values take 2 N² bytes or more.
const MAX_CENTRES: usize = 23_170;

/// Why a connectivity archive could not be read. Lines and columns of text count from 1.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TvbError {
    /// The archive could not be read.
    #[error(transparent)]
    Archive(#[from] ArchiveError),
    /// No file, or several, of a kind that must be there once.
    #[error(
        "expected one file of {kind} (such as `{example}`), found {count}; the archive holds: \
         {found}"
    )]
    NotOneFile {
        /// What the file holds.
        kind: &'static str,
        /// A name that it could have.
        example: &'static str,
        /// How many there are.
        count: usize,
        /// Names of all files.
        found: String,
    },
    /// The weights are not a matrix.
    #[error("{file}: {}", with_causes(error))]
    Weights {
        /// Name of the file.
        file: String,
        /// What is wrong with it.
        error: DenseError,
    },
    /// The centres are not text.
    #[error("{file}: {}", with_causes(error))]
    Centres {
        /// Name of the file.
        file: String,
        /// What is wrong with it.
        error: TextError,
    },
    /// A line of centres with too few or too many values.
    #[error("{file}, line {line}: expected a label, x, y and z, found {found} values")]
    WrongCount {
        /// Name of the file.
        file: String,
        /// The line.
        line: usize,
        /// How many values there are.
        found: usize,
    },
    /// More centres than a full matrix as text could have rows.
    #[error(
        "{file} has more than {MAX_CENTRES} centres, for which no matrix as text can have rows"
    )]
    TooManyCentres {
        /// Name of the file.
        file: String,
    },
    /// A coordinate that is not a finite number.
    #[error("{file}, line {line}: expected {coordinate} to be a finite number, found `{found}`")]
    BadCoordinate {
        /// Name of the file.
        file: String,
        /// The line.
        line: usize,
        /// x, y or z.
        coordinate: &'static str,
        /// What stands there.
        found: String,
    },
    /// Weights and centres of different areas.
    #[error("expected as many centres as rows of weights, found {centres} centres and {rows} rows")]
    Mismatch {
        /// Number of centres.
        centres: usize,
        /// Number of rows.
        rows: usize,
    },
    /// The matrix is not a network.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
    /// What [`RawNetwork`] refuses of groups and positions.
    #[error(transparent)]
    Network(#[from] GraphError),
}

/// Reads a network with labels, positions (mm) and regions; the module describes the format.
///
/// The network is directed until preparation makes it symmetric. A block takes areas by their
/// rows.
///
/// # Errors
/// [`TvbError`], naming the file of the archive that is at fault.
pub fn read(source: impl Read + Seek, layout: &Layout) -> Result<RawNetwork, TvbError> {
    let mut archive = Archive::new(source)?;
    let centres = find(&archive, "centres", "centres.txt", &["centres", "centers"])?;
    let weights = find(&archive, "weights", "weights.txt", &["weight"])?;
    let centres = read_centres(&mut archive, centres)?;
    let matrix = archive.text(weights, |file, content| {
        dense::read_matrix(content, layout).map_err(|error| TvbError::Weights { file, error })
    })?;
    if matrix.n_rows != centres.len() {
        let (centres, rows) = (centres.len(), matrix.n_rows);
        return Err(TvbError::Mismatch { centres, rows });
    }
    let (labels, mut groups) = label(&centres);
    let block = matrix.builder.block();
    restrict(&mut groups, &block);
    let positions = centres[block].iter().map(|centre| centre.position).collect();
    let network = matrix.builder.finish_labelled(labels, true)?;
    Ok(network.with_groups(groups)?.with_positions(positions)?)
}

/// The error with what lies behind it, such as a file that could not be unpacked to its end.
fn with_causes(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text.push_str(": ");
        text.push_str(&error.to_string());
        cause = error.source();
    }
    text
}

/// The place of the one file of that kind, by how its name begins.
fn find<R: Read + Seek>(
    archive: &Archive<R>,
    kind: &'static str,
    example: &'static str,
    beginnings: &[&str],
) -> Result<usize, TvbError> {
    let is_meant = |path: &str| {
        let name = path.rsplit('/').next().unwrap_or(path).to_ascii_lowercase();
        // Archives made on a Mac hold a shadow of every file.
        !path.starts_with("__MACOSX") && beginnings.iter().any(|b| name.starts_with(b))
    };
    let names = archive.names();
    let found: Vec<usize> = (0..names.len()).filter(|&place| is_meant(&names[place])).collect();
    match found.as_slice() {
        &[place] => Ok(place),
        _ => {
            let (count, found) = (found.len(), listed(names));
            Err(TvbError::NotOneFile { kind, example, count, found })
        }
    }
}

impl<R: Read + Seek> Archive<R> {
    /// What `read` makes of the text of a file, given its name, unpacked once more if need be.
    fn text<T>(
        &mut self,
        place: usize,
        read: impl FnOnce(String, &mut dyn Read) -> Result<T, TvbError>,
    ) -> Result<T, TvbError> {
        let name = self.names()[place].clone();
        let mut content = self.open(place, MAX_UNPACKED_TEXT)?;
        if name.ends_with(".bz2") {
            let source = MultiBzDecoder::new(content);
            return read(quoted(&name), &mut Limited::new(source, MAX_UNPACKED_TEXT));
        }
        read(quoted(&name), &mut content)
    }
}

/// An area: the label of its line, and where it is.
struct Centre {
    label: String,
    position: [f64; 3],
}

fn read_centres<R: Read + Seek>(
    archive: &mut Archive<R>,
    place: usize,
) -> Result<Vec<Centre>, TvbError> {
    archive.text(place, |file, content| {
        let mut lines = Lines::new(content);
        let mut centres = Vec::new();
        let failed = |error| TvbError::Centres { file: file.clone(), error };
        while let Some((line, text)) = lines.next_line().map_err(failed)? {
            let text = text.trim();
            if !text.is_empty() && !text.starts_with('#') {
                if centres.len() == MAX_CENTRES {
                    return Err(TvbError::TooManyCentres { file: file.clone() });
                }
                centres.push(read_centre(&file, line, text)?);
            }
        }
        Ok(centres)
    })
}

fn read_centre(file: &str, line: usize, text: &str) -> Result<Centre, TvbError> {
    let values = || text.split([' ', '\t', ',']).filter(|value| !value.is_empty());
    let count = values().count();
    if count != 4 {
        return Err(TvbError::WrongCount { file: file.to_owned(), line, found: count });
    }
    let mut values = values();
    let label = values.next().unwrap_or_default().to_owned();
    let mut position = [0.0; 3];
    for ((place, coordinate), value) in position.iter_mut().zip(["x", "y", "z"]).zip(values) {
        *place = match value.parse::<f64>() {
            Ok(number) if number.is_finite() => number,
            _ => {
                let (file, found) = (file.to_owned(), quoted(value));
                return Err(TvbError::BadCoordinate { file, line, coordinate, found });
            }
        };
    }
    Ok(Centre { label, position })
}

/// Labels of the areas, and their regions where several areas share one.
fn label(centres: &[Centre]) -> (Vec<String>, Vec<Group>) {
    let mut groups: Vec<Group> = Vec::new();
    let mut of_label = HashMap::new();
    let mut labels = Vec::with_capacity(centres.len());
    for (node, centre) in centres.iter().enumerate() {
        let group = *of_label.entry(&centre.label).or_insert_with(|| {
            groups.push(Group { name: centre.label.clone(), nodes: Vec::new() });
            groups.len() - 1
        });
        groups[group].nodes.push(node);
        labels.push(format!("{}-{}", centre.label, groups[group].nodes.len()));
    }
    if groups.len() == centres.len() {
        // Every area is its own region, and its label names it already.
        return (centres.iter().map(|centre| centre.label.clone()).collect(), Vec::new());
    }
    (labels, groups)
}

/// Leaves of every group the nodes within the block, counted from its start.
fn restrict(groups: &mut Vec<Group>, block: &Range<usize>) {
    for group in groups.iter_mut() {
        group.nodes.retain(|node| block.contains(node));
        group.nodes.iter_mut().for_each(|node| *node -= block.start);
    }
    groups.retain(|group| !group.nodes.is_empty());
}
