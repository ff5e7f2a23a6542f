//! Rust sources as tokens, to find the paths and macros that they name.

pub(crate) mod tokens;

use std::fs;
use std::path::Path;

/// A file of the crate.
#[derive(Clone)]
pub(crate) struct SourceFile {
    /// Below the crate's root, with `/`.
    pub(crate) path: String,
    /// Its text.
    pub(crate) text: String,
}

/// The `.rs` files below the folders, sorted by path. Cargo runs tests in the crate's root.
pub(crate) fn files(folders: &[&str]) -> Vec<SourceFile> {
    let mut found = Vec::new();
    let mut open: Vec<String> = folders.iter().map(|folder| (*folder).to_owned()).collect();
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let entry = entry.unwrap();
            let path = format!("{folder}/{}", entry.file_name().to_str().unwrap());
            if entry.file_type().unwrap().is_dir() {
                open.push(path);
            } else if Path::new(&path).extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(entry.path()).unwrap();
                found.push(SourceFile { path, text });
            }
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}
