//! Writes files atomically: to a temporary file that is then renamed.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};

/// A written file that is not yet at its final path.
pub(super) struct Staged {
    file: tempfile::NamedTempFile,
    path: PathBuf,
}

/// Writes a file completely or not at all.
pub(super) fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    stage(path, bytes)?.put()
}

/// Writes a temporary file next to the final path.
///
/// # Errors
/// As [`write()`]; also if a read-only file exists at the path.
pub(super) fn stage(path: &Path, bytes: &[u8]) -> anyhow::Result<Staged> {
    // A link stays a link: its target is written.
    let path = &path.canonicalize().unwrap_or_else(|_| path.to_owned());
    if std::fs::metadata(path).is_ok_and(|metadata| metadata.permissions().readonly()) {
        bail!("'{}' is read-only; make it writable to have it changed", path.display());
    }
    if path.is_dir() {
        bail!("'{}' is a folder; name a file in it", path.display());
    }
    let folder = parent(path);
    let closed = || {
        format!(
            "cannot write into the folder '{}'; name another one or check its permissions",
            folder.display()
        )
    };
    std::fs::create_dir_all(folder).with_context(closed)?;
    let mut file = tempfile::NamedTempFile::new_in(folder).with_context(closed)?;
    file.write_all(bytes).with_context(|| failed(path))?;
    // Temporary files are private, so the permissions are reset.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = std::fs::metadata(path).map_or(0o644, |m| m.permissions().mode());
        let permissions = std::fs::Permissions::from_mode(mode);
        file.as_file().set_permissions(permissions).with_context(|| failed(path))?;
    }
    Ok(Staged { file, path: path.to_owned() })
}

impl Staged {
    /// Moves the file to its path and replaces an existing one.
    pub(super) fn put(self) -> anyhow::Result<()> {
        let path = self.path;
        self.file.persist(&path).map_err(|error| error.error).with_context(|| failed(&path))?;
        Ok(())
    }
}

/// Writes files; none is replaced before all are written.
pub(super) fn write_all<P: AsRef<Path>, B: AsRef<[u8]>>(
    files: impl IntoIterator<Item = (P, B)>,
) -> anyhow::Result<()> {
    let staged: anyhow::Result<Vec<Staged>> =
        files.into_iter().map(|(path, bytes)| stage(path.as_ref(), bytes.as_ref())).collect();
    staged?.into_iter().try_for_each(Staged::put)
}

/// Whether two paths lead to the same existing file.
pub(super) fn is_same_file(a: &Path, b: &Path) -> bool {
    a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}

/// Refuses an output that is a file which the command reads, and two outputs that are one file.
pub(super) fn refuse_inputs<'a>(
    outputs: &[(&str, Option<&PathBuf>)],
    inputs: impl IntoIterator<Item = &'a Path>,
) -> anyhow::Result<()> {
    let inputs: Vec<&Path> = inputs.into_iter().collect();
    let mut before: Vec<(&str, &PathBuf)> = Vec::new();
    for (option, path) in outputs {
        let Some(path) = path else { continue };
        if inputs.iter().any(|input| is_same_file(input, path)) {
            bail!("{option} {}: this file is read; give another name", path.display());
        }
        let same = before.iter().find(|(_, other)| other == path || is_same_file(other, path));
        if let Some((other, _)) = same {
            bail!("{option} {}: {other} writes this file; give another name", path.display());
        }
        before.push((option, path));
    }
    Ok(())
}

/// Writes files into a folder, with paths relative to it. A new folder appears all at once; in an
/// existing one, no file is replaced before all are written.
pub(super) fn write_folder<P: AsRef<Path>, B: AsRef<[u8]>>(
    folder: &Path,
    files: impl IntoIterator<Item = (P, B)>,
) -> anyhow::Result<()> {
    if folder.exists() {
        return write_all(files.into_iter().map(|(path, bytes)| (folder.join(path), bytes)));
    }
    let beside = parent(folder);
    std::fs::create_dir_all(beside).with_context(|| failed(folder))?;
    let whole = tempfile::Builder::new()
        .prefix(".joulepath")
        .tempdir_in(beside)
        .with_context(|| failed(folder))?;
    for (path, bytes) in files {
        write(&whole.path().join(path), bytes.as_ref())?;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let permissions = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(whole.path(), permissions).with_context(|| failed(folder))?;
    }
    std::fs::rename(whole.path(), folder).with_context(|| failed(folder))?;
    // The temporary folder was renamed, so nothing is to be removed.
    let _ = whole.keep();
    Ok(())
}

fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn failed(path: &Path) -> String {
    format!("cannot write '{}'; check the folder and its permissions", path.display())
}
