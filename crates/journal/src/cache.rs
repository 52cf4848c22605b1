//! Curves that outlive their run: a file each in a folder of the user's, called after its key.
//!
//! A file is a record as in a journal, whose sum is right or which counts as absent, and appears whole:
//! it is written under another name first. What cannot be kept is computed again another time, and no
//! reason to stop.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::record;
use crate::{Key, Kind};

/// The folder, and whether what lies there is taken.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
    is_read: bool,
}

impl Cache {
    /// In a folder, which need not be there. What it holds is taken unless all is to be computed anew.
    pub fn new(folder: PathBuf, fresh: bool) -> Self {
        Self { folder, is_read: !fresh }
    }

    /// Whether such work is worth keeping for other runs: it is small, and takes long.
    pub(crate) fn is_for(kind: Kind) -> bool {
        matches!(kind, Kind::Look | Kind::Curve)
    }

    /// What lies under a key, if it is there and whole.
    pub(crate) fn get(&self, kind: Kind, key: &Key) -> Option<Vec<u8>> {
        if !self.is_read {
            return None;
        }
        let mut file = fs::File::open(self.path(key)).ok()?;
        let n_bytes = file.metadata().ok()?.len();
        let contents = record::scan(&mut file, n_bytes).ok()?;
        let found =
            contents.records.first().filter(|found| (found.kind, found.key) == (kind, *key))?;
        record::payload(&mut file, found).ok()
    }

    /// Keeps a payload under a key.
    pub(crate) fn put(&self, kind: Kind, key: &Key, payload: &[u8]) -> io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        let mut file = NamedTempFile::new_in(&self.folder)?;
        record::write(&mut file, kind, key, payload)?;
        file.persist(self.path(key))?;
        Ok(())
    }

    /// The folder.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    fn path(&self, key: &Key) -> PathBuf {
        self.folder.join(key.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_put_is_got_and_what_was_damaged_is_absent() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(folder.path().join("deep/er"), false);
        let key = Key::of("program", Kind::Curve, &1u8);
        assert_eq!(cache.get(Kind::Curve, &key), None);
        cache.put(Kind::Curve, &key, b"payload").unwrap();
        assert_eq!(cache.get(Kind::Curve, &key).as_deref(), Some(&b"payload"[..]));
        assert_eq!(Cache::new(cache.folder.clone(), true).get(Kind::Curve, &key), None);
        assert_eq!(fs::read_dir(&cache.folder).unwrap().count(), 1, "nothing else lies there");
        let path = cache.path(&key);
        let whole = fs::read(&path).unwrap();
        for place in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[place] ^= 1;
            fs::write(&path, &damaged).unwrap();
            assert_eq!(cache.get(Kind::Curve, &key), None, "a bit of byte {place}");
            fs::write(&path, &whole[..place]).unwrap();
            assert_eq!(cache.get(Kind::Curve, &key), None, "cut off at {place}");
        }
    }
}
