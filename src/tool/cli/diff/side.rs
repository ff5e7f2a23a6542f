//! The two sides of a comparison: from arguments to files.

use std::path::{Path, PathBuf};

use anyhow::bail;
use tempfile::TempDir;

use super::git::{self, Repository};
use crate::rapid::text::SourceFile;
use crate::tool::cli::backup::is_shared;
use crate::tool::cli::input::{self, Input};
use crate::tool::compare::{Group, Side};

/// The path of a file that does not exist, as git names it.
const NOTHING: &str = "/dev/null";

/// A side that was named.
pub(super) struct Named {
    /// As shown.
    pub(super) name: String,
    /// A path on disk, for the configuration beside it.
    pub(super) path: Option<PathBuf>,
    source: Source,
}

enum Source {
    /// No file: it was added or deleted.
    Nothing,
    Path(PathBuf),
    /// A revision that was written into a folder.
    Revision {
        /// Removed at the end.
        folder: TempDir,
        /// The file or folder in it.
        path: PathBuf,
        /// What stands in messages for the folder.
        prefix: String,
    },
}

/// A side that was read.
pub(super) struct Read {
    pub(super) name: String,
    pub(super) side: Side,
    /// The files on disk that were read.
    pub(super) files: Vec<PathBuf>,
    /// The first backup that names a robot, and the robot.
    pub(super) robot: Option<(PathBuf, String)>,
    pub(super) notes: Vec<String>,
    /// The folder of a revision, until the robot of its backup is read.
    _folder: Option<TempDir>,
}

/// What an argument of the command line means.
enum Argument {
    Nothing,
    Path(PathBuf),
    Revision { revision: String, path: Option<String> },
}

impl Argument {
    fn new(text: &Path) -> anyhow::Result<Argument> {
        if text == Path::new(NOTHING) {
            return Ok(Argument::Nothing);
        }
        let shown = text.to_string_lossy();
        if text.exists() {
            return Ok(Argument::Path(text.to_owned()));
        }
        let (revision, path) = match shown.split_once(':') {
            Some((revision, path)) => (revision, Some(path.to_owned())),
            None => (&*shown, None),
        };
        let repository = Repository::at(Path::new("."));
        let known = repository.and_then(|repository| repository.tree(revision).map(drop));
        match known {
            Ok(()) => Ok(Argument::Revision { revision: revision.to_owned(), path }),
            Err(why) => bail!("'{shown}' is no file or folder, and no git revision: {why}"),
        }
    }
}

/// Two sides by name. A revision without a path has the path of the other side.
pub(super) fn named(old: &Path, new: &Path) -> anyhow::Result<[Named; 2]> {
    let [old, new] = [Argument::new(old)?, Argument::new(new)?];
    let path_of = |argument: &Argument| -> anyhow::Result<Option<String>> {
        Ok(match argument {
            Argument::Nothing => None,
            Argument::Path(path) => Some(Repository::at(path)?.inner_path(path)?),
            Argument::Revision { path, .. } => path.clone(),
        })
    };
    let side = |argument: &Argument, other: &Argument| -> anyhow::Result<Named> {
        Ok(match argument {
            Argument::Nothing => {
                Named { name: NOTHING.to_owned(), path: None, source: Source::Nothing }
            }
            Argument::Path(path) => of_path(path),
            Argument::Revision { revision, path } => {
                // The files of a path on disk may be in another repository than the present folder.
                let place = match (path, other) {
                    (None, Argument::Path(on_disk)) => on_disk.as_path(),
                    _ => Path::new("."),
                };
                let path = match path {
                    Some(path) => Some(path.clone()),
                    None => path_of(other)?,
                };
                of_revision(place, revision, path.as_deref().unwrap_or(""))?
            }
        })
    };
    Ok([side(&old, &new)?, side(&new, &old)?])
}

/// A path at a revision, and in the working tree.
pub(super) fn of_working_tree(revision: &str, path: &Path) -> anyhow::Result<[Named; 2]> {
    let repository = Repository::at(path)?;
    let inner = repository.inner_path(path)?;
    let new = if path.exists() {
        of_path(path)
    } else {
        Named { name: path.display().to_string(), path: None, source: Source::Nothing }
    };
    Ok([of_revision(path, revision, &inner)?, new])
}

fn of_path(path: &Path) -> Named {
    Named {
        name: path.display().to_string(),
        path: Some(path.to_owned()),
        source: Source::Path(path.to_owned()),
    }
}

fn of_revision(place: &Path, revision: &str, path: &str) -> anyhow::Result<Named> {
    let repository = Repository::at(place)?;
    let tree = repository.tree(revision)?;
    let path = repository.resolved(path)?;
    let folder = tempfile::tempdir()?;
    git::write(&repository, revision, &tree, &path, folder.path())?;
    let inside = if path.is_empty() { folder.path().to_owned() } else { folder.path().join(&path) };
    let name = if path.is_empty() { revision.to_owned() } else { format!("{revision}:{path}") };
    let source = Source::Revision { folder, path: inside, prefix: format!("{revision}:") };
    Ok(Named { name, path: None, source })
}

/// Reads a side; `entry` starts its programs, if it is stated.
pub(super) fn read(named: Named, entry: Option<&str>) -> anyhow::Result<Read> {
    let Named { name, source, .. } = named;
    let (path, root) = match &source {
        Source::Nothing => {
            return Ok(Read {
                name,
                side: Side::default(),
                files: Vec::new(),
                robot: None,
                notes: Vec::new(),
                _folder: None,
            });
        }
        Source::Path(path) => (path.clone(), None),
        Source::Revision { folder, path, prefix } => {
            (path.clone(), Some((folder.path().to_string_lossy().into_owned() + "/", prefix)))
        }
    };
    let shown = |text: &str| match &root {
        Some((folder, prefix)) => text.replace(folder.as_str(), prefix),
        None => text.to_owned(),
    };
    let input = input::read(std::slice::from_ref(&path))
        .map_err(|error| anyhow::anyhow!("{}", shown(&error.to_string())))?;
    let skipped = input.unreadable.iter();
    let notes = skipped.map(|it| format!("skipped '{}': {}", shown(&it.path), it.reason)).collect();
    let files = match &source {
        Source::Path(_) => {
            input.files.iter().map(|file| PathBuf::from(&file.source.path)).collect()
        }
        _ => Vec::new(),
    };
    let robot = input.backups.iter().find_map(|(root, backup)| {
        let robot = backup.tasks.iter().find_map(|task| task.robot.clone())?;
        Some((root.clone(), robot))
    });
    let mut side = side(&input, entry);
    for file in &mut side.files {
        file.path = shown(&file.path);
    }
    let folder = match source {
        Source::Revision { folder, .. } => Some(folder),
        _ => None,
    };
    Ok(Read { name, side, files, robot, notes, _folder: folder })
}

/// The programs of an input: one for each task of a controller, else one.
fn side(input: &Input, entry: Option<&str>) -> Side {
    let entry_of = |of_task: Option<&String>| {
        let of_task = of_task.map(String::as_str);
        entry.or(of_task).unwrap_or("main").to_owned()
    };
    let mut groups: Vec<Group> = Vec::new();
    let mut shared: Vec<usize> = Vec::new();
    for (index, file) in input.files.iter().enumerate() {
        let (name, stated) = match &file.place {
            Some(place) if is_shared(&place.folder) => {
                shared.push(index);
                (place.folder.clone(), None)
            }
            Some(place) => {
                let backup = &input.backups[place.backup].1;
                let task = backup.tasks.iter().find(|task| task.folder == place.folder);
                (
                    backup.task_name(&place.folder).to_owned(),
                    task.and_then(|task| task.entry.as_ref()),
                )
            }
            None => (String::new(), None),
        };
        match groups.iter_mut().find(|group| group.name == name) {
            Some(group) => group.files.push(index),
            None => groups.push(Group {
                name,
                files: vec![index],
                shared: Vec::new(),
                entry: entry_of(stated),
            }),
        }
    }
    for group in &mut groups {
        group.shared = shared.iter().copied().filter(|file| !group.files.contains(file)).collect();
    }
    let files: Vec<SourceFile> = input.files.iter().map(|file| file.source.clone()).collect();
    let relative = input.files.iter().map(|file| file.relative.clone()).collect();
    Side { files, relative, groups }
}
