//! Names of results folders, and paths that stay right when everything is moved together.

use std::path::{Component, Path, PathBuf};

use user::{Problem, Result};

/// Where files are written, in the hidden folder.
pub const FILES: &str = "files";
/// The same when all are there; after an exchange the older results.
pub const WHOLE: &str = "whole";
/// The older results, where the system cannot exchange two folders in one step.
pub const REPLACED: &str = "replaced";

/// Ending of the results of a quick run beside those of a full one.
const QUICK: &str = ".quick";

/// What the results made from a file are called: its name without the ending.
pub fn id(file: &Path) -> Result<String> {
    let refused = |why: &str| {
        let message = format!("its results cannot be called after it: {why}");
        Problem::new(message).in_file(file).hint("give the file another name")
    };
    let Some(stem) = file.file_stem() else { return Err(refused("it has no name")) };
    let Some(id) = stem.to_str() else {
        return Err(refused("its name is no text in UTF-8"));
    };
    if id.chars().any(char::is_control) {
        return Err(refused("its name has control characters"));
    }
    if id.starts_with('.') {
        return Err(refused("its name begins with a dot, and so do hidden folders"));
    }
    if id.ends_with(QUICK) {
        return Err(refused("names that end in `.quick` are kept for the results of quick runs"));
    }
    Ok(id.to_owned())
}

/// Where a quick run of an experiment goes that has full results.
pub fn quick(results: &Path, id: &str) -> PathBuf {
    results.join(format!("{id}{QUICK}"))
}

/// Where a run works. A quick look does not touch what a long run can go on from.
pub fn hidden(results: &Path, id: &str, quick: bool) -> PathBuf {
    results.join(format!(".{id}.unfinished{}", if quick { "-quick" } else { "" }))
}

/// The name of the experiment whose runs work in a folder of this name, if any does.
pub fn id_of_hidden(name: &str) -> Option<&str> {
    let name = name.strip_prefix('.')?;
    let id = name.strip_suffix(".unfinished").or_else(|| name.strip_suffix(".unfinished-quick"))?;
    (!id.is_empty()).then_some(id)
}

/// A path as seen from a folder. Both are absolute, without links and `..`; where they have nothing
/// in common but the root, the path climbs up to it, and where not even that, it stays absolute.
pub fn relative(path: &Path, folder: &Path) -> PathBuf {
    let (mut to, mut from) = (path.components().peekable(), folder.components().peekable());
    if to.peek() != from.peek() {
        return path.to_owned();
    }
    while to.peek().is_some() && to.peek() == from.peek() {
        to.next();
        from.next();
    }
    from.map(|_| Component::ParentDir).chain(to).collect()
}

#[cfg(test)]
mod tests {
    use std::os::unix::ffi::OsStrExt;

    use super::*;

    #[test]
    fn names_that_could_mean_another_place_are_refused() {
        for name in ["...toml", "..toml", ".toml", ".hidden.toml", "x.quick.toml", "a\nb.toml", "/"]
        {
            assert!(id(Path::new(name)).is_err(), "{name:?}");
        }
        assert_eq!(id(Path::new("a/b.c.toml")).unwrap(), "b.c");
        assert!(id(Path::new(std::ffi::OsStr::from_bytes(b"a\xff.toml"))).is_err());
    }

    #[test]
    fn a_relative_path_leads_from_the_folder_to_the_file() {
        let from = |path, folder| relative(Path::new(path), Path::new(folder));
        assert_eq!(from("/a/b/net.edges", "/a/results/net"), Path::new("../../b/net.edges"));
        assert_eq!(from("/data/net", "/home/x"), Path::new("../../data/net"));
        assert_eq!(from("/a/net", "/a"), Path::new("net"));
        assert_eq!(from("net", "/a"), Path::new("net"));
    }

    #[test]
    fn hidden_folders_tell_whose_they_are() {
        for quick in [false, true] {
            let hidden = hidden(Path::new(""), "a.b", quick);
            assert_eq!(id_of_hidden(hidden.to_str().unwrap()), Some("a.b"));
        }
        for other in ["a.unfinished", ".git", ".a.unfinished-Ab12Cd", "..unfinished"] {
            assert_eq!(id_of_hidden(other), None, "{other}");
        }
    }
}
