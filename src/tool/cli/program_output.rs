//! Writes a changed program into a folder or in place.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use similar::TextDiff;

use super::common::Job;
use super::input::Input;
use super::output::is_same_file;
use super::{output, undo};
use crate::rapid::text::{FileId, SourceFile, charset};
use crate::tool::retrofit::{OutputFile, OutputKind, Retrofit, Source};

/// The backup, if the command line names all of it.
pub(super) fn whole_backup<'i>(paths: &[PathBuf], input: &'i Input) -> Option<&'i Path> {
    let [path] = paths else { return None };
    let [(root, _)] = input.backups.as_slice() else { return None };
    (path.canonicalize().ok()? == *root).then_some(root.as_path())
}

/// The folder of the program: its backup, or the deepest common folder of all named paths.
fn program_folder(paths: &[PathBuf], job: &Job) -> anyhow::Result<PathBuf> {
    let mut shared: Option<PathBuf> = job.input.backups.first().map(|(root, _)| root.clone());
    for path in paths {
        let mut folder =
            path.canonicalize().with_context(|| format!("cannot find '{}'", path.display()))?;
        if !folder.is_dir() {
            folder.pop();
        }
        let mut common = shared.unwrap_or_else(|| folder.clone());
        while !folder.starts_with(&common) && common.pop() {}
        shared = Some(common);
    }
    shared.context("no file or folder given")
}

/// The files of a backup that are not outputs, with their relative paths, without `removed`.
fn rest_of_backup(
    root: &Path,
    out: &Path,
    removed: &[PathBuf],
    outputs: &[OutputFile],
) -> anyhow::Result<Vec<(PathBuf, Vec<u8>)>> {
    let known: BTreeSet<PathBuf> = outputs.iter().map(|file| PathBuf::from(&file.path)).collect();
    let is_removed = |path: &Path| removed.iter().any(|one| is_same_file(one, path));
    let mut rest = Vec::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        let failed = || format!("cannot read the backup's '{}'", folder.display());
        for entry in std::fs::read_dir(&folder).with_context(failed)? {
            let path = entry.with_context(failed)?.path();
            let kind = std::fs::symlink_metadata(&path).with_context(failed)?;
            let relative = path.strip_prefix(root).unwrap_or(&path).to_owned();
            if kind.is_dir() && path != out {
                folders.push(path);
            } else if kind.is_file() && !known.contains(&relative) && !is_removed(&path) {
                let bytes = std::fs::read(&path)
                    .with_context(|| format!("cannot read '{}'", path.display()))?;
                rest.push((relative, bytes));
            }
        }
    }
    rest.sort();
    Ok(rest)
}

/// Refuses an output folder inside an input folder.
pub(super) fn refuse_nested_output(folder: &Path, paths: &[PathBuf]) -> anyhow::Result<()> {
    let wanted = std::path::absolute(folder)?;
    let mut ancestors = wanted.ancestors();
    let real = ancestors.find_map(|path| path.canonicalize().ok());
    let around = |path: &&PathBuf| {
        let root = path.canonicalize().ok().filter(|root| root.is_dir());
        // The input folder itself is refused later, with the file that would be overwritten.
        root.is_some_and(|root| {
            real.as_ref().is_some_and(|real| real.starts_with(&root))
                && wanted.canonicalize().ok() != Some(root)
        })
    };
    if let Some(root) = paths.iter().find(around) {
        bail!(
            "'{}' lies in '{}', so that it would be read as a part of the program next time; name a \
             folder outside of that, or give --in-place",
            folder.display(),
            root.display()
        );
    }
    Ok(())
}

/// Writes the complete program into a folder; of a backup all files but `removed`. `files`: those of
/// the program.
pub(super) fn write_folder(
    folder: &Path,
    (files, removed): (&[Source], &[PathBuf]),
    outputs: &[OutputFile],
    backup: Option<&Path>,
) -> anyhow::Result<Vec<String>> {
    for file in outputs {
        let path = folder.join(&file.path);
        if files.iter().any(|source| is_same_file(&path, Path::new(&source.file.path))) {
            bail!(
                "'{}' is a file of the program itself; name another folder, or give --in-place, \
                 which keeps the originals",
                path.display()
            );
        }
    }
    let rest = match backup {
        Some(root) => {
            let out = std::path::absolute(folder)?;
            rest_of_backup(root, &out.canonicalize().unwrap_or(out), removed, outputs)?
        }
        None => Vec::new(),
    };
    let changed =
        new_first(outputs).map(|file| (Path::new(&file.path), encoded(files, file, &file.bytes)));
    let unchanged = rest.iter().map(|(path, bytes)| (path.as_path(), Cow::from(bytes)));
    output::write_folder(folder, changed.chain(unchanged))?;
    let written = outputs.iter().map(|file| folder.join(&file.path));
    let written = written.chain(rest.iter().map(|(path, _)| folder.join(path)));
    Ok(written.map(|path| path.display().to_string()).collect())
}

/// New files before the files that call them: an interrupted write leaves a working program.
pub(super) fn new_first(outputs: &[OutputFile]) -> impl Iterator<Item = &OutputFile> {
    let of = |new: bool| outputs.iter().filter(move |file| (file.kind == OutputKind::New) == new);
    of(true).chain(of(false))
}

/// Replaces the changed files, keeps the originals for undo, and adds the new files.
pub(super) fn write_in_place(
    paths: &[PathBuf],
    job: &Job,
    result: &Retrofit,
) -> anyhow::Result<Vec<String>> {
    let mut changes = Vec::new();
    for file in new_first(&result.outputs) {
        let (path, after) = (path_in_tree(job, file), encoded(&job.files, file, &file.bytes));
        let before = match input_file(job, file) {
            Some((path, bytes)) => {
                // An unreadable file could not be restored.
                let now = std::fs::read(path).with_context(|| format!("cannot read '{path}'"))?;
                // For a program with streams, undo restores the text without them.
                let before = if job.is_refreshed() {
                    encoded(&job.files, file, bytes)
                } else {
                    (&now).into()
                };
                if before == after && now == *after {
                    continue;
                }
                Some(before.into_owned())
            }
            None => None,
        };
        changes.push(undo::Change { path, before, after });
    }
    if changes.is_empty() {
        return Ok(Vec::new());
    }
    let plan = undo::plan(&program_folder(paths, job)?, &changes, &job.streams.modules)?;
    let staged: anyhow::Result<Vec<output::Staged>> =
        changes.iter().map(|change| output::stage(&change.path, &change.after)).collect();
    let staged = staged?;
    let kept = plan.write()?;
    staged.into_iter().try_for_each(output::Staged::put)?;
    let is_written = |path: &&PathBuf| changes.iter().any(|change| change.path == **path);
    for path in job.streams.modules.iter().filter(|path| !is_written(path)) {
        std::fs::remove_file(path)
            .with_context(|| format!("cannot delete '{}'", path.display()))?;
    }
    let paths = std::iter::once(&kept).chain(changes.iter().map(|change| &change.path));
    Ok(paths.map(|path| path.display().to_string()).collect())
}

/// Bytes of an output in the encoding of its original file.
fn encoded<'a>(files: &[Source], file: &OutputFile, bytes: &'a [u8]) -> Cow<'a, [u8]> {
    match file.input.and_then(|i| files.get(i)) {
        Some(source) => source.file.stored(bytes),
        None => Cow::Borrowed(bytes),
    }
}

/// The current content of the user's file for an output, decoded in the same way.
fn current_bytes(job: &Job, file: &OutputFile) -> Option<Vec<u8>> {
    if !job.is_refreshed() {
        return input_file(job, file).map(|(_, bytes)| bytes.to_vec());
    }
    let path = path_in_tree(job, file);
    let bytes = std::fs::read(&path).ok()?;
    Some(SourceFile::new(FileId(0), path.display().to_string(), bytes).bytes)
}

/// Path and bytes of the input file of an output.
pub(super) fn input_file<'a>(job: &'a Job, file: &OutputFile) -> Option<(&'a str, &'a [u8])> {
    match (file.kind, file.input) {
        (OutputKind::New, _) => None,
        (_, Some(i)) => job.files.get(i).map(|s| (s.file.path.as_str(), s.file.bytes.as_slice())),
        (_, None) => {
            let listing = job.input.listings.iter().find(|l| l.relative == file.path);
            let listing = listing.map(|l| (l.path.as_str(), l.bytes.as_slice()));
            let information = job.input.information.iter().find(|i| i.relative == file.path);
            listing.or_else(|| information.map(|i| (i.path.as_str(), i.bytes.as_slice())))
        }
    }
}

/// The path of an output in the user's own tree.
pub(super) fn path_in_tree(job: &Job, file: &OutputFile) -> PathBuf {
    if let Some((path, _)) = input_file(job, file) {
        return PathBuf::from(path);
    }
    let folder = |path: &str| Path::new(path).parent().map_or_else(PathBuf::new, Path::to_path_buf);
    // A new file goes next to a file of its output folder, or else to the start of the relative
    // paths.
    let beside = job.files.iter().find(|s| folder(&s.relative) == folder(&file.path));
    if let (Some(source), Some(name)) = (beside, Path::new(&file.path).file_name()) {
        return folder(&source.file.path).join(name);
    }
    let root = job.files.first().and_then(|source| source.file.path.strip_suffix(&source.relative));
    PathBuf::from(root.unwrap_or_default()).join(&file.path)
}

/// The changes of a program as a unified diff.
pub(super) fn diff(job: &Job, result: &Retrofit) -> String {
    let mut text = String::new();
    for file in &result.outputs {
        let before = current_bytes(job, file).unwrap_or_default();
        if before == file.bytes {
            continue;
        }
        let charset = charset(&file.bytes);
        let (old, new) = (charset.decode(&before), charset.decode(&file.bytes));
        let from =
            if before.is_empty() { "/dev/null".to_owned() } else { format!("a/{}", file.path) };
        let diff = TextDiff::from_lines(old.as_ref(), new.as_ref());
        text.push_str(&diff.unified_diff().header(&from, &format!("b/{}", file.path)).to_string());
    }
    text
}
