//! Records the changes of `optimize --in-place` and undoes them.
//!
//! The undo folder lies next to the program's folder (of a backup: next to the backup, so that a
//! restore does not read it). It contains the original files at their relative paths and a
//! manifest. The manifest lists every changed and new file with a checksum of its written content:
//! a file that was edited since is neither restored nor deleted.

use std::borrow::Cow;
use std::fs;
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, bail};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::output;

/// Suffix of the undo folder's name.
const SUFFIX: &str = ".joulepath-undo";
const MANIFEST: &str = "manifest.json";
/// The folder of the originals.
const ORIGINALS: &str = "files";
/// Format version of the manifest.
const VERSION: u32 = 1;

/// A file to write in place.
pub(super) struct Change<'a> {
    /// Its path.
    pub(super) path: PathBuf,
    /// The content that undo restores; `None` for a new file.
    pub(super) before: Option<Vec<u8>>,
    /// Its new content.
    pub(super) after: Cow<'a, [u8]>,
}

#[derive(Serialize, Deserialize)]
struct Manifest {
    version: u32,
    files: Vec<Entry>,
    /// Folders created for new files, outer ones first.
    folders: Vec<String>,
}

#[derive(Serialize, Deserialize)]
struct Entry {
    /// Path relative to the program's folder, with `/`.
    path: String,
    change: Kind,
    /// Checksum of the written content.
    sha256: String,
}

#[derive(Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Changed,
    Added,
}

/// An undo folder that is not written yet.
pub(super) struct Plan<'a> {
    folder: PathBuf,
    files: Vec<(PathBuf, Cow<'a, [u8]>)>,
}

/// Plans the undo of changes to files below `root`. When streams are replaced, their modules may
/// already exist; the undo folder of the earlier retrofit is outdated and is replaced.
///
/// # Errors
/// The undo folder or a new file already exists, or a file lies outside `root`.
pub(super) fn plan<'a>(
    root: &Path,
    changes: &'a [Change<'_>],
    streams: &[PathBuf],
) -> anyhow::Result<Plan<'a>> {
    let root = canonical(root)?;
    let folder = undo_folder(&root)?;
    if folder.exists() && streams.is_empty() {
        bail!(
            "'{}' holds the originals of an earlier --in-place: undo that first (joulepath \
             optimize {} --undo), or move the folder away to keep its changes",
            folder.display(),
            root.display()
        );
    }
    let mut files = Vec::new();
    let mut folders = Vec::new();
    let mut kept: Vec<(PathBuf, Cow<'_, [u8]>)> = Vec::new();
    for change in changes {
        let path = relative_path(&root, &change.path)?;
        let kind = if let Some(before) = &change.before {
            kept.push((Path::new(ORIGINALS).join(&path), before.into()));
            Kind::Changed
        } else {
            if change.path.exists() && !streams.contains(&change.path) {
                bail!(
                    "'{}' exists already and would be overwritten: move it away first, or use --out",
                    change.path.display()
                );
            }
            add_missing_folders(&root, &path, &mut folders);
            Kind::Added
        };
        files.push(Entry {
            path: with_slashes(&path),
            change: kind,
            sha256: checksum(&change.after),
        });
    }
    let manifest = serde_json::to_vec_pretty(&Manifest { version: VERSION, files, folders })?;
    kept.push((MANIFEST.into(), manifest.into()));
    Ok(Plan { folder, files: kept })
}

impl Plan<'_> {
    /// Writes the undo folder and returns its path; the program is not changed. An older undo folder is
    /// kept until the new one is there.
    pub(super) fn write(&self) -> anyhow::Result<PathBuf> {
        let failed = || format!("cannot replace '{}'", self.folder.display());
        let mut older = self.folder.clone().into_os_string();
        older.push(".older");
        let older = PathBuf::from(older);
        let has_older = self.folder.exists();
        if has_older {
            if older.exists() {
                fs::remove_dir_all(&older).with_context(failed)?;
            }
            fs::rename(&self.folder, &older).with_context(failed)?;
        }
        let files = self.files.iter().map(|(path, bytes)| (path, bytes));
        let written = output::write_folder(&self.folder, files);
        if has_older {
            match &written {
                Ok(()) => fs::remove_dir_all(&older).with_context(failed)?,
                Err(error) => fs::rename(&older, &self.folder).with_context(|| {
                    format!("{error:#}; the originals are in '{}' now", older.display())
                })?,
            }
        }
        written?;
        Ok(self.folder.clone())
    }
}

/// Undoes the changes of the program at `path`; returns a description per file.
///
/// # Errors
/// There is nothing to undo, or a file was edited since.
pub(super) fn undo(path: &Path) -> anyhow::Result<Vec<String>> {
    let absolute = canonical(path)?;
    let found = absolute.ancestors().find_map(|root| {
        let folder = undo_folder(root).ok()?;
        folder.join(MANIFEST).is_file().then(|| (root.to_owned(), folder))
    });
    let Some((root, folder)) = found else {
        bail!(
            "nothing to undo: no folder '….{}' lies beside '{}' or a folder above it; name the \
             path that --in-place was given",
            SUFFIX.trim_start_matches('.'),
            path.display()
        );
    };
    let manifest = read(&folder)?;
    let original = |entry: &Entry| {
        let path = folder.join(ORIGINALS).join(&entry.path);
        fs::read(&path).with_context(|| format!("cannot read the original '{}'", path.display()))
    };
    // Checks all files before the first change.
    let (mut restored, mut deleted, mut done) = (Vec::new(), Vec::new(), Vec::new());
    for entry in &manifest.files {
        let path = root.join(&entry.path);
        let now = fs::read(&path).ok();
        let as_written = now.as_ref().is_some_and(|now| checksum(now) == entry.sha256);
        match entry.change {
            Kind::Changed => {
                let before = original(entry)?;
                if now.as_ref() == Some(&before) {
                    continue;
                }
                if !as_written {
                    return Err(changed_since(&path, &folder));
                }
                restored.push(output::stage(&path, &before)?);
                done.push(format!("restored {}", path.display()));
            }
            Kind::Added if now.is_none() => {}
            Kind::Added if as_written => {
                done.push(format!("deleted {}", path.display()));
                deleted.push(path);
            }
            Kind::Added => return Err(changed_since(&path, &folder)),
        }
    }
    restored.into_iter().try_for_each(output::Staged::put)?;
    for path in deleted {
        fs::remove_file(&path).with_context(|| format!("cannot delete '{}'", path.display()))?;
    }
    for made in manifest.folders.iter().rev() {
        // Not removed if it contains other files.
        let _ = fs::remove_dir(root.join(made));
    }
    fs::remove_dir_all(&folder).with_context(|| format!("cannot delete '{}'", folder.display()))?;
    done.push(format!("deleted {}", folder.display()));
    Ok(done)
}

fn changed_since(path: &Path, folder: &Path) -> anyhow::Error {
    anyhow::anyhow!(
        "'{}' was changed since --in-place wrote it, so nothing is undone: to keep the change and take \
         the streams out, run joulepath refresh with --in-place on the program and then --undo; to \
         lose it, copy the originals from '{}' yourself",
        path.display(),
        folder.join(ORIGINALS).display()
    )
}

fn read(folder: &Path) -> anyhow::Result<Manifest> {
    let path = folder.join(MANIFEST);
    let unreadable = || {
        format!(
            "'{}' is not as --in-place wrote it: copy the originals from '{}' yourself",
            path.display(),
            folder.join(ORIGINALS).display()
        )
    };
    let manifest: Manifest = serde_json::from_slice(&fs::read(&path).with_context(unreadable)?)
        .with_context(unreadable)?;
    let plain = |path: &String| {
        Path::new(path).components().all(|part| matches!(part, Component::Normal(_)))
    };
    let inside = manifest.files.iter().map(|entry| &entry.path).chain(&manifest.folders).all(plain);
    if manifest.version != VERSION || !inside {
        bail!(unreadable());
    }
    Ok(manifest)
}

/// The undo folder of a program's folder.
fn undo_folder(root: &Path) -> anyhow::Result<PathBuf> {
    let name = root.file_name().with_context(|| {
        format!("'{}' has no folder beside it: move the program into a folder", root.display())
    })?;
    let mut name = name.to_owned();
    name.push(SUFFIX);
    Ok(root.with_file_name(name))
}

/// The path of a file relative to the program's folder. The file may be a link.
fn relative_path(root: &Path, path: &Path) -> anyhow::Result<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    // A missing folder is created under this name.
    let known = folder.ancestors().find(|folder| folder.exists()).unwrap_or(Path::new("."));
    let rest = folder.strip_prefix(known).unwrap_or(Path::new(""));
    let absolute = canonical(known)?.join(rest).join(path.file_name().unwrap_or_default());
    let relative = absolute.strip_prefix(root).with_context(|| {
        format!(
            "'{}' does not lie below '{}': name the folder that holds the whole program",
            path.display(),
            root.display()
        )
    })?;
    Ok(relative.to_owned())
}

/// Adds the missing folders that a new file needs.
fn add_missing_folders(root: &Path, path: &Path, folders: &mut Vec<String>) {
    let needed: Vec<&Path> = path.ancestors().skip(1).collect();
    for folder in needed.into_iter().rev() {
        let name = with_slashes(folder);
        if !name.is_empty() && !root.join(folder).exists() && !folders.contains(&name) {
            folders.push(name);
        }
    }
}

fn canonical(path: &Path) -> anyhow::Result<PathBuf> {
    path.canonicalize().with_context(|| format!("cannot find '{}'; check the path", path.display()))
}

fn with_slashes(path: &Path) -> String {
    let parts: Vec<_> = path.components().map(|part| part.as_os_str().to_string_lossy()).collect();
    parts.join("/")
}

fn checksum(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}
