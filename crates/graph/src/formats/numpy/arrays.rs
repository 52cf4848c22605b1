//! The arrays of an `.npz`, and what one of them holds.

use std::io::{Read, Seek};

use super::error::NumpyError;
use super::header::{Element, Header};
use crate::formats::archive::{Archive, MAX_UNPACKED_BYTES, listed, most_kept};
use crate::formats::binary::{Interrupted, Number, fill, read_numbers};
use crate::formats::matrix::{MAX_ENTRIES, MatrixError};
use crate::formats::text::quoted;

/// The arrays of an `.npz`, by name.
pub(super) struct Arrays<R> {
    archive: Archive<R>,
    pub(super) names: Vec<String>,
    places: Vec<usize>,
}

impl<R: Read + Seek> Arrays<R> {
    pub(super) fn open(source: R) -> Result<Self, NumpyError> {
        let archive = Archive::new(source)?;
        let arrays = archive.names().iter().enumerate();
        let (places, names) = arrays
            .filter_map(|(place, name)| Some((place, name.strip_suffix(".npy")?.to_owned())))
            .unzip();
        Ok(Self { archive, names, places })
    }

    /// Elements that are kept of one array, at most.
    pub(super) fn most_kept(&self) -> u64 {
        most_kept(self.archive.packed_bytes()).min(MAX_ENTRIES as u64)
    }

    pub(super) fn is_sparse_matrix(&self) -> bool {
        ["format", "shape", "data"].iter().all(|&name| self.names.iter().any(|n| n == name))
    }

    /// What `read` makes of the array; an error names it.
    pub(super) fn read<T>(
        &mut self,
        name: &str,
        read: impl FnOnce(&mut dyn Read) -> Result<T, NumpyError>,
    ) -> Result<T, NumpyError> {
        let Some(place) = self.names.iter().position(|n| n == name) else {
            let (wanted, found) = (quoted(name), listed(&self.names));
            return Err(NumpyError::NoArray { wanted, found });
        };
        let mut content = self.archive.open(self.places[place], MAX_UNPACKED_BYTES)?;
        read(&mut content)
            .map_err(|error| NumpyError::InArray { name: quoted(name), error: Box::new(error) })
    }
}

/// An array whose header has been read.
pub(super) struct Array<'a> {
    pub(super) header: Header,
    pub(super) number: Number,
    pub(super) source: &'a mut dyn Read,
}

impl<'a> Array<'a> {
    /// An array of numbers.
    pub(super) fn open(source: &'a mut dyn Read) -> Result<Self, NumpyError> {
        let header = Header::read(source)?;
        match header.element {
            Element::Number(number) => Ok(Self { header, number, source }),
            Element::Text(_) => Err(NumpyError::UnsupportedType { found: "text".to_owned() }),
        }
    }

    pub(super) fn wrong_dimensions(self, expected: usize) -> NumpyError {
        NumpyError::WrongDimensions { expected, shape: self.header.shape }
    }

    /// Hands every element and its position in the file to `take`, and expects the file's end.
    pub(super) fn read(
        self,
        take: impl FnMut(u64, f64) -> Result<(), MatrixError>,
    ) -> Result<(), NumpyError> {
        let n_elements = self.header.shape.iter().map(|&n| u128::from(n)).product::<u128>();
        let expected = n_elements * self.number.width() as u128;
        // More elements than 64 bits count cannot be there: the file ends before.
        let count = u64::try_from(n_elements).unwrap_or(u64::MAX);
        let order = self.header.order;
        read_numbers(self.source, count, self.number, order, take).map_err(|stop| match stop {
            Interrupted::Short(found) => NumpyError::Truncated { expected, found },
            Interrupted::Io(error) => NumpyError::Io(error),
            Interrupted::Refused(error) => NumpyError::Matrix(error),
        })?;
        match fill(self.source, &mut [0])? {
            0 => Ok(()),
            _ => Err(NumpyError::TrailingBytes { expected }),
        }
    }

    /// All elements of an array of one dimension.
    pub(super) fn vector(self, most: u64) -> Result<Vec<f64>, NumpyError> {
        let &[length] = self.header.shape.as_slice() else {
            return Err(self.wrong_dimensions(1));
        };
        if length > most {
            return Err(NumpyError::TooLong { length, most });
        }
        // No capacity is reserved: the length is only a claim until the elements are there.
        let mut elements = Vec::new();
        self.read(|_, value| {
            elements.push(value);
            Ok(())
        })?;
        Ok(elements)
    }
}
