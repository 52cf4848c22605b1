//! What there is to a format of networks: its name, the endings that tell it, which choices its files
//! leave open, and how they are read.

use std::error::Error;
use std::io::{Read, Seek};

use super::options::Options;
use crate::RawNetwork;

/// A format of network files; each is a constant of its own file, and [`FORMATS`](super::FORMATS) lists
/// them.
#[derive(Debug)]
pub struct Format {
    /// What it is called in experiment files and on the command line.
    pub name: &'static str,
    /// What its files hold, in a line.
    pub summary: &'static str,
    /// The endings of names of files that tell it, in lower case and without the point, the usual one
    /// first; the empty one is a name without ending.
    pub endings: &'static [&'static str],
    /// Whether its files are text in which each link stands by itself: their length then tells how much
    /// memory the network may take, before any of it is read.
    pub lists_links: bool,
    /// What is left open about what a file holds; of [`Options`] these alone are looked at.
    pub choices: &'static [Choice],
    /// Reads a network.
    pub read: fn(&mut dyn Source, &Options) -> Result<RawNetwork, ReadError>,
}

/// What files of some formats leave open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// Which of several matrices.
    Variable,
    /// Which attributes of nodes and links are weights, labels, groups and positions.
    Attributes,
    /// Which rows and columns of a matrix.
    Block,
    /// Which nodes the rows of a matrix are.
    Rows,
}

/// Bytes in order, of which those of an archive are looked up as well.
pub trait Source: Read + Seek {}

impl<T: Read + Seek> Source for T {}

/// Why a file could not be read: the error of its format, which names the place.
pub type ReadError = Box<dyn Error + Send + Sync>;

impl Format {
    /// The ending of files of this format that are written here.
    pub fn ending(&self) -> &'static str {
        self.endings[0]
    }

    /// Whether files leave this open.
    pub fn has(&self, choice: Choice) -> bool {
        self.choices.contains(&choice)
    }
}
