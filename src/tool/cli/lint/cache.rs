//! The folder in which `joulepath lint --cache` keeps what it found.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use anyhow::Context;

use crate::tool::cli::output;
use crate::tool::lint::Store;

/// A folder with one file for each program.
pub(super) struct Cache {
    folder: PathBuf,
    version: String,
}

impl Cache {
    /// The cache in a folder, which is made if it is missing. Version control ignores it.
    pub(super) fn open(folder: &Path) -> anyhow::Result<Cache> {
        let shown = folder.display();
        let ignore = folder.join(".gitignore");
        if !ignore.exists() {
            let of =
                || format!("cannot write the cache '{shown}'; --cache=FOLDER names another one");
            output::write(&ignore, b"*\n").with_context(of)?;
        }
        Ok(Cache { folder: folder.to_owned(), version: version()? })
    }
}

/// What tells two builds of this program apart.
fn version() -> anyhow::Result<String> {
    let program = std::env::current_exe().context("cannot find the joulepath that runs")?;
    let of = || format!("cannot read '{}'", program.display());
    let file = fs::metadata(&program).with_context(of)?;
    let written = file.modified().with_context(of)?.duration_since(UNIX_EPOCH).unwrap_or_default();
    Ok(format!("{} {} {}", env!("CARGO_PKG_VERSION"), file.len(), written.as_nanos()))
}

impl Store for Cache {
    fn version(&self) -> &str {
        &self.version
    }

    fn read(&self, name: &str) -> Option<String> {
        fs::read_to_string(self.folder.join(name)).ok()
    }

    fn write(&self, name: &str, text: &str) {
        // Without this file the program is linted again: no error.
        let _ = output::write(&self.folder.join(name), text.as_bytes());
    }
}
