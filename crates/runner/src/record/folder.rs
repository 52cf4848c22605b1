//! The results folder of one run, written beside its place and renamed when whole, so that nothing
//! unfinished ever looks finished.

use std::fs;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::problem::{Problem, Result};

/// Sees to it that there is a folder for results that can be written to, before hours are spent on
/// what could not be kept. The file made as a trial has no name, so that nothing of it can stay.
pub fn check_writable(results: &Path) -> Result<()> {
    fs::create_dir_all(results)
        .and_then(|()| tempfile::tempfile_in(results))
        .map(drop)
        .map_err(|error| Problem::from_error("cannot be written to", error).in_file(results))
}

/// A results folder in the making.
pub struct Folder {
    making: tempfile::TempDir,
    place: PathBuf,
}

impl Folder {
    /// Starts the folder `results/<id>` and removes what killed runs of it have left.
    pub fn start(results: &Path, id: &str) -> Result<Self> {
        let failed = |error: std::io::Error| {
            Problem::from_error("cannot be written to", error).in_file(results)
        };
        fs::create_dir_all(results).map_err(failed)?;
        let prefix = format!(".{id}.unfinished-");
        for entry in fs::read_dir(results).map_err(failed)?.flatten() {
            if entry.file_name().to_string_lossy().starts_with(&prefix) {
                fs::remove_dir_all(entry.path()).map_err(failed)?;
            }
        }
        let making =
            tempfile::Builder::new().prefix(&prefix).tempdir_in(results).map_err(failed)?;
        Ok(Self { making, place: results.join(id) })
    }

    /// Writes one file of the folder.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<()> {
        fs::write(self.making.path().join(name), content).map_err(|error| {
            Problem::from_error("cannot be written", error).in_file(&self.place.join(name))
        })
    }

    /// Writes a file too large to be held as a whole, through a buffer.
    pub fn write_through(
        &self,
        name: &str,
        content: impl FnOnce(&mut BufWriter<fs::File>) -> std::io::Result<()>,
    ) -> Result<()> {
        let written = fs::File::create(self.making.path().join(name)).and_then(|file| {
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

    /// Puts the whole folder in its place, in exchange for an older one.
    pub fn finish(self) -> Result<PathBuf> {
        let Self { making, place } = self;
        let failed = |error: std::io::Error| {
            Problem::from_error("cannot be put in place", error).in_file(&place)
        };
        let whole = making.keep();
        // Named like an unfinished folder, so that a run killed right here is cleaned up after.
        let mut aside = whole.clone().into_os_string();
        aside.push("-replaced");
        if place.exists() {
            fs::rename(&place, &aside).map_err(failed)?;
        }
        fs::rename(&whole, &place).map_err(failed)?;
        if Path::new(&aside).exists() {
            fs::remove_dir_all(&aside).map_err(failed)?;
        }
        Ok(place)
    }
}
