//! Files within a zip archive, unpacked as a stream of bounded length.

use std::io::{self, Read, Seek, SeekFrom};

use thiserror::Error;
use zip::ZipArchive;
use zip::result::ZipError;

use super::text::quoted;

/// Most bytes that a reader unpacks from one compressed file or variable: 4 GiB.
///
/// A few megabytes can hold thousands of times as many zeros; this bounds the time that they take.
pub const MAX_UNPACKED_BYTES: u64 = 4 << 30;

/// Most bytes that are unpacked of one file of text, which takes longer to read: 1 GiB, some 14,000 nodes
/// with five characters for each pair.
pub(super) const MAX_UNPACKED_TEXT: u64 = 1 << 30;

/// Numbers that are kept in memory of a compressed file of so many bytes, at most. Vectors of ones
/// and of zeros shrink to a thousandth, but those that say which nodes are linked do not.
pub(super) fn most_kept(packed_bytes: u64) -> u64 {
    packed_bytes.saturating_mul(64).saturating_add(1 << 24)
}

/// Most names that an error lists.
const MAX_LISTED: usize = 20;

/// Why a zip archive could not be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ArchiveError {
    /// The source itself failed.
    #[error("reading the archive failed: {0}")]
    Io(#[source] io::Error),
    /// Not a zip archive, or a damaged one.
    #[error("expected a zip archive: {reason}")]
    NotZip {
        /// What the archive lacks.
        reason: String,
    },
    /// A file in the archive that cannot be unpacked: encrypted, or of an unknown method.
    #[error("`{file}` in the archive cannot be unpacked: {reason}")]
    CannotUnpack {
        /// Name of the file.
        file: String,
        /// What stands against it.
        reason: String,
    },
}

/// An archive and the names of its files.
pub(super) struct Archive<R> {
    zip: ZipArchive<R>,
    names: Vec<String>,
    /// Length of the whole archive.
    packed_bytes: u64,
}

impl<R: Read + Seek> Archive<R> {
    pub(super) fn new(mut source: R) -> Result<Self, ArchiveError> {
        let packed_bytes = source.seek(SeekFrom::End(0)).map_err(ArchiveError::Io)?;
        let not_zip = |error| match error {
            ZipError::Io(error) if error.kind() != io::ErrorKind::UnexpectedEof => {
                ArchiveError::Io(error)
            }
            other => ArchiveError::NotZip { reason: quoted_reason(&other) },
        };
        let zip = ZipArchive::new(source).map_err(not_zip)?;
        let names = zip.file_names().map(|name| Ok(name?.into_owned())).collect::<Result<_, _>>();
        Ok(Self { names: names.map_err(not_zip)?, zip, packed_bytes })
    }

    /// Names of all files and folders, as the archive lists them.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// Length of the whole archive in bytes.
    pub(super) fn packed_bytes(&self) -> u64 {
        self.packed_bytes
    }

    /// The content of the file of that place in [`Self::names`], at most so many bytes of it.
    pub(super) fn open(&mut self, index: usize, most: u64) -> Result<impl Read, ArchiveError> {
        let file = quoted(&self.names[index]);
        match self.zip.by_index(index) {
            Ok(content) => Ok(Limited::new(content, most)),
            Err(ZipError::Io(error)) => Err(ArchiveError::Io(error)),
            Err(error) => Err(ArchiveError::CannotUnpack { file, reason: quoted_reason(&error) }),
        }
    }
}

/// What the zip library says, without control characters that a file name may hold.
fn quoted_reason(error: &ZipError) -> String {
    error.to_string().chars().map(|c| if c.is_control() { ' ' } else { c }).take(200).collect()
}

/// A source that fails, rather than ends, beyond so many bytes.
pub(super) struct Limited<R> {
    source: R,
    left: u64,
    most: u64,
}

impl<R> Limited<R> {
    pub(super) fn new(source: R, most: u64) -> Self {
        Self { source, left: most, most }
    }
}

impl<R: Read> Read for Limited<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.source.read(buffer)?;
        match self.left.checked_sub(n as u64) {
            Some(left) => self.left = left,
            None => {
                let text = format!("more than {} bytes when unpacked", self.most);
                return Err(io::Error::other(text));
            }
        }
        Ok(n)
    }
}

/// The names as an error shows them, quoted and not too many.
pub(super) fn listed(names: &[String]) -> String {
    if names.is_empty() {
        return "none".to_owned();
    }
    let mut list: Vec<String> =
        names.iter().take(MAX_LISTED).map(|name| format!("`{}`", quoted(name))).collect();
    if names.len() > MAX_LISTED {
        list.push(format!("{} more", names.len() - MAX_LISTED));
    }
    list.join(", ")
}
