//! Finds and reads the RAPID files that the command line names.
//!
//! A named file is read whatever its extension; a folder is searched for RAPID files; a `.pgf`
//! represents the modules that it lists. All modules of a controller backup are read, each with its
//! task.

mod search;

pub(super) use search::{InputError, Unreadable, is_module};

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use self::search::{FoundFile, bytes_of, find, make_distinct, relative_text, shown};
use super::backup::{self, Backup};
use crate::rapid::text::{FileId, SourceFile};

/// A file that was read.
#[derive(Clone, Debug)]
pub(super) struct InputFile {
    /// Its bytes; its path is the given one, joined with `/`.
    pub(super) source: SourceFile,
    /// Its path relative to the input, with `/`; also its path below `--out`.
    pub(super) relative: String,
    /// Its place in a controller backup, if it is a module of a task.
    pub(super) place: Option<Place>,
    /// Whether the command line names it, directly or by a program file.
    pub(super) named: bool,
}

/// A place in a controller backup.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Index of the backup in [`Input::backups`].
    pub(super) backup: usize,
    /// The task's folder, `TASK1` ….
    pub(super) folder: String,
}

/// A program file that was read.
#[derive(Clone, Debug)]
pub(super) struct Listing {
    /// Its path, joined with `/`.
    pub(super) path: String,
    /// Its path relative to the input, with `/`.
    pub(super) relative: String,
    /// Its bytes.
    pub(super) bytes: Vec<u8>,
    /// The paths of the modules that it lists.
    pub(super) modules: Vec<String>,
}

/// The file of a controller backup that lists its modules.
#[derive(Clone, Debug)]
pub(super) struct Information {
    /// Its path, joined with `/`.
    pub(super) path: String,
    /// Its path relative to the backup, with `/`.
    pub(super) relative: String,
    /// Its bytes.
    pub(super) bytes: Vec<u8>,
}

/// The input of the command line, sorted by path within each argument.
#[derive(Clone, Debug, Default)]
pub(super) struct Input {
    /// The files; their ids count from 0 in this order.
    pub(super) files: Vec<InputFile>,
    /// The program files that list some of them.
    pub(super) listings: Vec<Listing>,
    /// Files and folders that could not be read.
    pub(super) unreadable: Vec<Unreadable>,
    /// The controller backups of the files, with their folders.
    pub(super) backups: Vec<(PathBuf, Backup)>,
    /// The module lists of these backups.
    pub(super) information: Vec<Information>,
}

/// Reads the files of `paths`. A file named twice is read once.
///
/// # Errors
/// Nothing can be read (the error concerns the first path), or a `.pgf` lists files outside its
/// folder. If some files can be read, the others are listed in [`Input::unreadable`].
pub(super) fn read(paths: &[PathBuf]) -> Result<Input, InputError> {
    let mut first_error = None;
    let mut input = Input::default();
    let mut found: Vec<FoundFile> = Vec::new();
    let mut seen = BTreeSet::new();
    for path in paths {
        match find(path, &mut input.unreadable) {
            Ok(files) => {
                let place =
                    |file: &FoundFile| fs::canonicalize(&file.path).unwrap_or(file.path.clone());
                found.extend(files.into_iter().filter(|file| seen.insert(place(file))));
            }
            Err(error @ InputError::Outside { .. }) => return Err(error),
            Err(error) => {
                input.unreadable.push(Unreadable { path: shown(path), reason: error.to_string() });
                first_error.get_or_insert(error);
            }
        }
    }
    make_distinct(&mut found);
    let (listings, found): (Vec<FoundFile>, Vec<FoundFile>) =
        found.into_iter().partition(|file| file.modules.is_some());
    for file in listings {
        if let (Some(modules), Ok(bytes)) = (file.modules, bytes_of(&file.path)) {
            let (path, relative) = (shown(&file.path), file.relative);
            input.listings.push(Listing { path, relative, bytes, modules });
        }
    }
    let sources: Vec<Result<SourceFile, String>> = found
        .par_iter()
        .map(|file| Ok(SourceFile::new(FileId(0), shown(&file.path), bytes_of(&file.path)?)))
        .collect();
    for (file, source) in found.into_iter().zip(sources) {
        match source {
            Ok(source) => {
                let id = FileId(input.files.len() as u32);
                let place = place(&file.path, &mut input);
                let source = SourceFile { id, ..source };
                let FoundFile { relative, named, .. } = file;
                input.files.push(InputFile { source, relative, place, named });
            }
            Err(reason) => {
                let unreadable = Unreadable { path: shown(&file.path), reason };
                first_error.get_or_insert_with(|| InputError::Unreadable(unreadable.clone()));
                input.unreadable.push(unreadable);
            }
        }
    }
    match first_error {
        _ if !input.files.is_empty() => Ok(input),
        Some(error) => Err(error),
        None => Err(InputError::Nothing),
    }
}

/// The place of a file in a backup; the first file of a backup also reads the backup.
fn place(path: &Path, input: &mut Input) -> Option<Place> {
    let (root, folder) = backup::place(&fs::canonicalize(path).ok()?)?;
    let known = input.backups.iter().position(|(known, _)| *known == root);
    let backup = known.unwrap_or_else(|| {
        input.information.extend(information(&root));
        let backup = backup::read(&root);
        input.backups.push((root, backup));
        input.backups.len() - 1
    });
    Some(Place { backup, folder })
}

fn information(root: &Path) -> Option<Information> {
    let path = backup::information(root)?;
    let bytes = bytes_of(&path).ok()?;
    let relative = relative_text(path.strip_prefix(root).ok()?);
    Some(Information { path: shown(&path), relative, bytes })
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a file that cannot be made fails the test")]
mod tests {
    use super::*;

    fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (path, text) in files {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        folder
    }

    fn relatives<'a>(files: impl Iterator<Item = &'a InputFile>) -> Vec<&'a str> {
        files.map(|file| file.relative.as_str()).collect()
    }

    #[test]
    fn folders_are_walked_in_order() {
        let folder = folder(&[("b.MOD", ""), ("a/z.sys", ""), ("a/note.txt", ""), ("c.modx", "")]);
        let input = read(&[folder.path().to_path_buf()]).unwrap();
        assert_eq!(relatives(input.files.iter()), ["a/z.sys", "b.MOD", "c.modx"]);
        let prefix = shown(folder.path());
        assert_eq!(input.files[0].source.path, format!("{prefix}/a/z.sys"));
        assert_eq!(input.files[2].source.id, FileId(2));
    }

    #[test]
    fn a_named_file_is_read_whatever_its_extension_and_once() {
        let folder = folder(&[("program.txt", "MODULE a ENDMODULE")]);
        let path = folder.path().join("program.txt");
        let same = folder.path().join(".").join("program.txt");
        let input = read(&[path.clone(), path, same]).unwrap();
        assert_eq!(relatives(input.files.iter()), ["program.txt"]);
        assert_eq!(input.files[0].source.bytes, b"MODULE a ENDMODULE");
    }

    #[test]
    fn a_program_stands_for_its_modules() {
        let list = "<?xml version=\"1.0\"?>\r\n<Program>\r\n  <Module>MAIN.MOD</Module>\r\n  \
                    <Module>sub\\Lib.mod</Module>\r\n  <Module>gone &amp; lost.mod</Module>\r\n</Program>\r\n";
        let folder =
            folder(&[("cell.pgf", list), ("Main.mod", ""), ("sub/Lib.mod", ""), ("other.mod", "")]);
        let input = read(&[folder.path().join("cell.pgf")]).unwrap();
        assert_eq!(relatives(input.files.iter()), ["Main.mod", "sub/Lib.mod"]);
        assert!(input.unreadable[0].path.ends_with("gone & lost.mod"));
        assert_eq!(input.listings[0].relative, "cell.pgf");
        assert_eq!(input.listings[0].bytes, list.as_bytes());
    }

    #[test]
    fn a_program_lists_nothing_outside_of_its_folder() {
        for (name, why) in [
            ("../x.mod", "has '..'"),
            ("sub\\..\\..\\x.mod", "has '..'"),
            ("/tmp/x.mod", "is absolute"),
            ("\\x.mod", "is absolute"),
            ("C:\\x.mod", "names a drive or device"),
            ("HOME:/x.mod", "names a drive or device"),
        ] {
            let list = format!("<Program>\n<Module>m.mod</Module>\n<Module>{name}</Module>\n");
            let folder = folder(&[("p/cell.pgf", &list), ("p/m.mod", ""), ("x.mod", "")]);
            // Named directly or found in a folder, next to a readable file.
            for path in ["p/cell.pgf", "p"].map(|path| folder.path().join(path)) {
                let error = read(&[folder.path().join("x.mod"), path]).unwrap_err().to_string();
                assert!(error.contains(&format!("cell.pgf:3: '{name}'")), "{error}");
                assert!(error.contains(why) && error.contains("move it there"), "{error}");
            }
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_of_a_program_stay_below_its_folder() {
        use std::os::unix::fs::symlink;
        let list = "<Program><Module>m.mod</Module></Program>";
        let folder = folder(&[("p/cell.pgf", list), ("p/own.mod", ""), ("x.mod", "")]);
        let link = folder.path().join("p/m.mod");
        symlink("own.mod", &link).unwrap();
        assert!(read(&[folder.path().join("p/cell.pgf")]).is_ok());
        fs::remove_file(&link).unwrap();
        symlink("../x.mod", &link).unwrap();
        let error = read(&[folder.path().join("p/cell.pgf")]).unwrap_err().to_string();
        assert!(error.contains("cell.pgf:1: 'm.mod'") && error.contains("link"), "{error}");
    }

    #[test]
    fn files_of_one_name_keep_their_folders() {
        let folder = folder(&[("x/a.mod", ""), ("y/deep/a.mod", "")]);
        let paths = ["x/a.mod", "y/deep/a.mod"].map(|path| folder.path().join(path));
        let input = read(&paths).unwrap();
        assert_eq!(relatives(input.files.iter()), ["x/a.mod", "y/deep/a.mod"]);
    }

    #[test]
    fn nothing_to_read_names_the_way_out() {
        let folder = folder(&[("note.txt", "")]);
        let error = read(&[folder.path().to_path_buf()]).unwrap_err().to_string();
        assert!(error.contains(".mod") && error.contains(".pgf"), "{error}");
        let gone = folder.path().join("gone.mod");
        let error = read(std::slice::from_ref(&gone)).unwrap_err().to_string();
        assert!(error.contains("gone.mod"), "{error}");
        // With readable input, it is only listed.
        let input = read(&[gone, folder.path().join("note.txt")]).unwrap();
        assert_eq!((input.files.len(), input.unreadable.len()), (1, 1));
    }
}
