//! Writing files: into a temporary file first, then renamed.

use std::io::Write;
use std::path::Path;

use anyhow::Context;

/// Writes a file whole or not at all.
///
/// # Errors
/// The folder can't be made or written.
pub fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let failed =
        || format!("cannot write '{}'; check the folder and its permissions", path.display());
    let closed = || {
        format!(
            "cannot write into the folder '{}'; name another one or check its permissions",
            folder.display()
        )
    };
    std::fs::create_dir_all(folder).with_context(closed)?;
    let mut file = tempfile::NamedTempFile::new_in(folder).with_context(closed)?;
    file.write_all(bytes).with_context(failed)?;
    // A temporary file is private; what stands for a program is not.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = std::fs::metadata(path).map_or(0o644, |m| m.permissions().mode());
        let permissions = std::fs::Permissions::from_mode(mode);
        file.as_file().set_permissions(permissions).with_context(failed)?;
    }
    file.persist(path).map_err(|error| error.error).with_context(failed)?;
    Ok(())
}
