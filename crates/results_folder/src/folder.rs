//! The files of a results folder, written where nobody takes them for finished.

use std::fs;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

use user::{Problem, Result};

/// A results folder in the making.
pub struct Folder {
    making: PathBuf,
    place: PathBuf,
}

impl Folder {
    /// Files are written into `making`, and messages name them as they will be called in `place`.
    pub fn new(making: PathBuf, place: PathBuf) -> Self {
        Self { making, place }
    }

    /// Writes one file of the folder.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<()> {
        let path = self.making.join(name);
        fs::write(&path, content).map_err(|error| {
            // Half a file is none, should the run go on without it.
            let _ = fs::remove_file(&path);
            Problem::from_error("cannot be written", error).in_file(&self.place.join(name))
        })
    }

    /// Writes a file too large to be held as a whole, through a buffer.
    pub fn write_through(
        &self,
        name: &str,
        content: impl FnOnce(&mut BufWriter<fs::File>) -> std::io::Result<()>,
    ) -> Result<()> {
        let written = fs::File::create(self.making.join(name)).and_then(|file| {
            let mut file = BufWriter::with_capacity(1 << 16, file);
            content(&mut file)?;
            file.flush()
        });
        written.map_err(|error| {
            Problem::from_error("cannot be written", error).in_file(&self.place.join(name))
        })
    }

    /// Writes a table: a header and rows of fields.
    pub fn write_table(
        &self,
        name: &str,
        header: &[String],
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> Result<()> {
        let mut table = csv::Writer::from_writer(Vec::new());
        let records = std::iter::once(header.to_vec()).chain(rows);
        for record in records {
            table.write_record(&record).expect("a row has as many fields as the header");
        }
        self.write(name, table.into_inner().expect("memory takes every byte"))
    }

    /// Where the files are.
    pub fn into_path(self) -> PathBuf {
        self.making
    }
}
