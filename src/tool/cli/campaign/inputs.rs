//! What each step of a campaign was made from: a change is noticed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::Context;
use sha2::{Digest, Sha256};

use crate::tool::cli::output;

/// Hashes of files, by path.
type Hashes = BTreeMap<String, String>;

/// The inputs of the steps, by the file of their result.
pub(super) struct Inputs {
    path: PathBuf,
    of: BTreeMap<String, Hashes>,
}

impl Inputs {
    /// Those that the folder of a campaign has noted.
    pub(super) fn read(folder: &Path) -> anyhow::Result<Inputs> {
        let path = folder.join("inputs.json");
        let of = match std::fs::read_to_string(&path) {
            Ok(text) => serde_json::from_str(&text).with_context(|| {
                format!("'{}' is not what joulepath wrote; delete it", path.display())
            })?,
            Err(_) => BTreeMap::new(),
        };
        Ok(Inputs { path, of })
    }

    /// What differs from the files that a step was made from, in words.
    pub(super) fn changes(&self, step: &str, paths: &[PathBuf]) -> anyhow::Result<Vec<String>> {
        let (now, none) = (hashes(paths)?, Hashes::new());
        let then = self.of.get(step).unwrap_or(&none);
        let newer = now.iter().filter_map(|(path, hash)| match then.get(path) {
            None => Some(format!("{path} is new")),
            Some(old) if old != hash => Some(format!("{path} has changed")),
            Some(_) => None,
        });
        let gone = then.keys().filter(|path| !now.contains_key(*path));
        Ok(newer.chain(gone.map(|path| format!("{path} is gone"))).collect())
    }

    /// Notes the files that a step was made from.
    pub(super) fn note(&mut self, step: &str, paths: &[PathBuf]) -> anyhow::Result<()> {
        self.of.insert(step.to_owned(), hashes(paths)?);
        output::write(&self.path, serde_json::to_string_pretty(&self.of)?.as_bytes())
    }
}

/// The hashes of files, and of all files in folders.
fn hashes(paths: &[PathBuf]) -> anyhow::Result<Hashes> {
    let mut open = paths.to_vec();
    let mut found = Hashes::new();
    while let Some(path) = open.pop() {
        let failed = || format!("cannot read '{}'", path.display());
        if path.is_dir() {
            for entry in std::fs::read_dir(&path).with_context(failed)? {
                open.push(entry.with_context(failed)?.path());
            }
        } else if path.exists() {
            let bytes = std::fs::read(&path).with_context(failed)?;
            found.insert(path.display().to_string(), format!("{:x}", Sha256::digest(&bytes)));
        }
    }
    Ok(found)
}
