//! Finds the files of the library, so that an oscillator is added by adding its file.

use std::fmt::Write;
use std::path::Path;
use std::{env, fs};

const FOLDER: &str = "library";

fn main() {
    println!("cargo::rerun-if-changed={FOLDER}");
    let folder = Path::new(&env::var_os("CARGO_MANIFEST_DIR").expect("cargo says it")).join(FOLDER);
    let entries = fs::read_dir(&folder).expect("the library is a folder");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("it can be listed").path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    let mut list = String::from("[");
    for file in files {
        let name = file.file_stem().expect("a file has a name").to_string_lossy();
        writeln!(list, "({name:?}, include_str!({file:?})),").expect("a string grows");
    }
    list.push(']');
    let to = Path::new(&env::var_os("OUT_DIR").expect("cargo says it")).join("library.rs");
    fs::write(to, list).expect("the folder for what is generated can be written");
}
