//! The programs of `fixtures/cells`.

use std::collections::BTreeMap;
use std::path::Path;

use joulepath::retime::motion::Options;
use joulepath::tool::retrofit::Source;

use super::support::{module_paths, read};

const FOLDER: &str = "fixtures/cells";

/// A program, and the levels of its inputs with which it does its work.
pub(crate) struct Cell {
    pub(crate) name: String,
    pub(crate) files: Vec<Source>,
    pub(crate) levels: BTreeMap<String, f64>,
}

impl Cell {
    pub(crate) fn options(&self) -> Options {
        Options { levels: self.levels.clone(), ..Options::default() }
    }
}

/// The programs in the table of the README.
pub(crate) fn cells() -> Vec<Cell> {
    let readme = std::fs::read_to_string(Path::new(FOLDER).join("README.md")).unwrap();
    readme.lines().filter_map(cell).collect()
}

/// A row: program, what it does, style, options of the command line.
fn cell(row: &str) -> Option<Cell> {
    let columns: Vec<&str> = row.split('|').map(str::trim).collect();
    let [_, name, _, _, inputs, _] = columns.as_slice() else { return None };
    let name = name.strip_prefix('`')?.strip_suffix('`')?;
    let paths = match name.strip_suffix('/') {
        Some(folder) => module_paths(&format!("cells/{folder}")),
        None => vec![Path::new(FOLDER).join(format!("{name}.mod"))],
    };
    let levels = inputs.trim_matches('`').split("--assume ").filter_map(|option| {
        let (signal, level) = option.trim().split_once('=')?;
        Some((signal.to_lowercase(), level.parse().unwrap()))
    });
    Some(Cell { name: name.to_owned(), files: read(&paths), levels: levels.collect() })
}
