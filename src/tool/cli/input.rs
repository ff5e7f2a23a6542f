//! Finding and reading the RAPID files that the command line names.
//!
//! A file that is named is read whatever it is called; a folder is walked for
//! RAPID files; a `.pgf` stands for the modules it lists. Of a controller
//! backup every file is read, and each knows its task.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use rayon::prelude::*;
use thiserror::Error;

use super::backup::{self, Backup};
use crate::rapid::text::{FileId, SourceFile};

/// Extensions of files with RAPID text, in lower case.
const MODULES: [&str; 5] = ["mod", "sys", "prg", "modx", "sysx"];
/// Extension of a program file, which lists modules.
const PROGRAM: &str = "pgf";
/// What a folder was searched for, for messages.
const SOUGHT: &str = ".mod, .sys, .prg, .modx, .sysx or .pgf";
/// Deepest folder that is searched.
const MAX_FOLDERS: usize = 32;

/// A file that was read.
#[derive(Clone, Debug)]
pub struct InputFile {
    /// Its bytes; its path is the one given, joined with `/`.
    pub source: SourceFile,
    /// Its path below the input, with `/`: where it goes below `--out`.
    pub relative: String,
    /// Its place in a controller backup, if it is one of a task's modules.
    pub place: Option<Place>,
    /// Whether the command line names it, or a program file that lists it.
    pub named: bool,
}

/// A place in a controller backup.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Index of the backup in [`Input::backups`].
    pub backup: usize,
    /// The task's folder, `TASK1` ….
    pub folder: String,
}

/// A program file that was read.
#[derive(Clone, Debug)]
pub struct Listing {
    /// Its path, joined with `/`.
    pub path: String,
    /// Its path below the input, with `/`.
    pub relative: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// The paths of the modules that it lists.
    pub modules: Vec<String>,
}

/// The file of a controller backup that lists its modules.
#[derive(Clone, Debug)]
pub struct Information {
    /// Its path, joined with `/`.
    pub path: String,
    /// Its path below the backup, with `/`.
    pub relative: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// A file or folder that could not be read.
#[derive(Clone, Debug)]
pub struct Unreadable {
    /// Its path.
    pub path: String,
    /// Why.
    pub reason: String,
}

/// What the command line names, sorted by path within each of its arguments.
#[derive(Clone, Debug, Default)]
pub struct Input {
    /// The files; their ids count from 0 in this order.
    pub files: Vec<InputFile>,
    /// The program files that stand for some of them.
    pub listings: Vec<Listing>,
    /// What could not be read beside them.
    pub unreadable: Vec<Unreadable>,
    /// The controller backups that the files are of, with their folders.
    pub backups: Vec<(PathBuf, Backup)>,
    /// What lists the modules of these backups.
    pub information: Vec<Information>,
}

/// Why nothing was read.
#[derive(Debug, Error)]
pub enum InputError {
    /// No path was given.
    #[error("no file or folder given; name a RAPID file, a folder or a .pgf program")]
    Nothing,
    /// A folder without RAPID.
    #[error(
        "no RAPID in '{path}': looked in it and its folders for {SOUGHT}; name a file to read it \
         whatever its extension"
    )]
    NoRapid {
        /// The folder.
        path: String,
    },
    /// A `.pgf` whose modules are not there.
    #[error("'{path}' lists no module that can be read; name the module files themselves")]
    EmptyProgram {
        /// The program file.
        path: String,
    },
    /// A `.pgf` that lists a file outside of its folder: such a file would be copied and changed
    /// with the program.
    #[error(
        "{program}:{line}: '{module}' is not a file below the folder of the program ({why}); move \
         it there and list it by its name, or name the module files in place of the .pgf"
    )]
    Outside {
        /// The program file.
        program: String,
        /// From 1.
        line: usize,
        /// As listed.
        module: String,
        /// What leads outside.
        why: &'static str,
    },
    /// Something that cannot be read.
    #[error("cannot read '{path}': {reason}; check the path and its permissions")]
    Unreadable {
        /// The path.
        path: String,
        /// Why.
        reason: String,
    },
}

/// Reads what `paths` name. A file named twice is read once.
///
/// # Errors
/// When nothing can be read; the error is about the first path then. Otherwise
/// what cannot be read is listed in [`Input::unreadable`]. A `.pgf` that lists files outside of
/// its folder.
pub fn read(paths: &[PathBuf]) -> Result<Input, InputError> {
    let mut first_error = None;
    let mut input = Input::default();
    let mut found: Vec<Found> = Vec::new();
    let mut seen = BTreeSet::new();
    for path in paths {
        match find(path, &mut input.unreadable) {
            Ok(files) => {
                let place =
                    |file: &Found| fs::canonicalize(&file.path).unwrap_or(file.path.clone());
                found.extend(files.into_iter().filter(|file| seen.insert(place(file))));
            }
            Err(error @ InputError::Outside { .. }) => return Err(error),
            Err(error) => {
                input.unreadable.push(Unreadable { path: shown(path), reason: error.to_string() });
                first_error.get_or_insert(error);
            }
        }
    }
    tell_apart(&mut found);
    let (listings, found): (Vec<Found>, Vec<Found>) =
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
                let Found { relative, named, .. } = file;
                input.files.push(InputFile { source, relative, place, named });
            }
            Err(reason) => {
                let path = shown(&file.path);
                first_error.get_or_insert_with(|| InputError::Unreadable {
                    path: path.clone(),
                    reason: reason.clone(),
                });
                input.unreadable.push(Unreadable { path, reason });
            }
        }
    }
    match first_error {
        _ if !input.files.is_empty() => Ok(input),
        Some(error) => Err(error),
        None => Err(InputError::Nothing),
    }
}

/// The place of a file in one of the backups, which is read with its first file.
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
    let relative = below(path.strip_prefix(root).ok()?);
    Some(Information { path: shown(&path), relative, bytes })
}

/// A file to be read.
struct Found {
    path: PathBuf,
    relative: String,
    named: bool,
    /// Of a program file: the paths of its modules.
    modules: Option<Vec<String>>,
}

fn find(path: &Path, unreadable: &mut Vec<Unreadable>) -> Result<Vec<Found>, InputError> {
    let metadata = fs::metadata(path)
        .map_err(|error| InputError::Unreadable { path: shown(path), reason: error.to_string() })?;
    if metadata.is_dir() {
        if let Err(error) = fs::read_dir(path) {
            let reason = error.to_string();
            return Err(InputError::Unreadable { path: shown(path), reason });
        }
        let mut files = Vec::new();
        walk(path, 0, &mut files, unreadable);
        let (programs, mut modules): (Vec<PathBuf>, Vec<PathBuf>) =
            files.into_iter().partition(|file| has_extension(file, &[PROGRAM]));
        let mut listings = Vec::new();
        for program in programs {
            let of_program = match listed(&program) {
                Err(error @ InputError::Outside { .. }) => return Err(error),
                listed => listed.unwrap_or_default(),
            };
            listings.push(found_listing(path, program, &of_program));
            modules.extend(of_program.into_iter().filter(|module| module.is_file()));
        }
        modules.sort_by_key(|file| shown(file));
        modules.dedup_by_key(|file| shown(file));
        if modules.is_empty() {
            return Err(InputError::NoRapid { path: shown(path) });
        }
        let modules = modules.into_iter().map(|file| found_below(path, file, false));
        return Ok(modules.chain(listings).collect());
    }
    if has_extension(path, &[PROGRAM]) {
        return program(path, unreadable);
    }
    Ok(vec![found_below(path.parent().unwrap_or(Path::new("")), path.to_path_buf(), true)])
}

fn found_below(root: &Path, path: PathBuf, named: bool) -> Found {
    let relative = path.strip_prefix(root).map_or_else(|_| file_name(&path), below);
    Found { path, relative, named, modules: None }
}

fn found_listing(root: &Path, path: PathBuf, modules: &[PathBuf]) -> Found {
    let modules = modules.iter().map(|module| shown(module)).collect();
    Found { modules: Some(modules), ..found_below(root, path, true) }
}

/// Where two files would go to the same place below `--out`, all of them go below the deepest
/// folder that they share.
fn tell_apart(found: &mut [Found]) {
    let mut places = BTreeSet::new();
    if found.iter().all(|file| places.insert(file.relative.clone())) {
        return;
    }
    let absolute: Vec<PathBuf> = found
        .iter()
        .map(|file| fs::canonicalize(&file.path).unwrap_or_else(|_| file.path.clone()))
        .collect();
    let mut shared = absolute[0].parent().map_or_else(PathBuf::new, Path::to_path_buf);
    while !absolute.iter().all(|path| path.starts_with(&shared)) && shared.pop() {}
    for (file, absolute) in found.iter_mut().zip(&absolute) {
        file.relative = below(absolute.strip_prefix(&shared).unwrap_or(absolute));
    }
}

/// A path without anything that would lead out of a folder.
fn below(path: &Path) -> String {
    let parts = path.components().filter_map(|part| match part {
        Component::Normal(name) => Some(name.to_string_lossy()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The modules that a program file lists.
fn program(path: &Path, unreadable: &mut Vec<Unreadable>) -> Result<Vec<Found>, InputError> {
    let modules = listed(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files = Vec::new();
    let listing = found_listing(folder, path.to_path_buf(), &modules);
    for module in modules {
        if module.is_file() {
            files.push(found_below(folder, module, true));
        } else {
            let reason = format!("listed in '{}' but not there", shown(path));
            unreadable.push(Unreadable { path: shown(&module), reason });
        }
    }
    if files.is_empty() {
        return Err(InputError::EmptyProgram { path: shown(path) });
    }
    files.push(listing);
    Ok(files)
}

/// The paths between `<Module>` and `</Module>`, relative to the program file.
fn listed(path: &Path) -> Result<Vec<PathBuf>, InputError> {
    const BEGIN: &str = "<Module>";
    let unreadable = |reason| InputError::Unreadable { path: shown(path), reason };
    let bytes = bytes_of(path).map_err(unreadable)?;
    let text = crate::rapid::text::decode(&bytes).text;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut modules = Vec::new();
    for (at, _) in text.match_indices(BEGIN) {
        let rest = &text[at + BEGIN.len()..];
        let name = unescaped(rest.split("</Module>").next().unwrap_or_default().trim());
        if name.is_empty() {
            continue;
        }
        let module = below_in_any_case(folder, &name);
        if let Some(why) = leads_outside(folder, &name, &module) {
            let line = 1 + text[..at].matches('\n').count();
            return Err(InputError::Outside { program: shown(path), line, module: name, why });
        }
        modules.push(module);
    }
    Ok(modules)
}

/// What leads out of the folder of a program file in the name of a module that it lists.
fn leads_outside(folder: &Path, name: &str, module: &Path) -> Option<&'static str> {
    if name.starts_with(['/', '\\']) {
        return Some("the path is absolute");
    }
    if name.contains(':') {
        return Some("the path names a drive or device");
    }
    if name.split(['/', '\\']).any(|part| part == "..") {
        return Some("the path has '..'");
    }
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let (Ok(module), Ok(folder)) = (fs::canonicalize(module), fs::canonicalize(folder)) else {
        return None;
    };
    (!module.starts_with(folder)).then_some("a symbolic link leads out of it")
}

/// A path of a controller, whose file system has its own separators and knows no case.
fn below_in_any_case(folder: &Path, path: &str) -> PathBuf {
    let parts = path.split(['/', '\\']).filter(|part| !part.is_empty());
    parts.fold(folder.to_path_buf(), |folder, part| {
        backup::child(&folder, part).unwrap_or_else(|| folder.join(part))
    })
}

/// XML text without its escapes.
fn unescaped(text: &str) -> String {
    let escapes = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
    escapes.iter().fold(text.to_owned(), |text, (escape, sign)| text.replace(escape, sign))
}

/// Collects the files with RAPID below a folder. Links to folders are not
/// followed: they could lead in a circle.
fn walk(folder: &Path, depth: usize, files: &mut Vec<PathBuf>, unreadable: &mut Vec<Unreadable>) {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) => {
            unreadable.push(Unreadable { path: shown(folder), reason: error.to_string() });
            return;
        }
    };
    for entry in entries.filter_map(Result::ok) {
        let path = entry.path();
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if is_folder && depth < MAX_FOLDERS {
            walk(&path, depth + 1, files, unreadable);
        } else if (has_extension(&path, &MODULES) || has_extension(&path, &[PROGRAM]))
            && path.is_file()
        {
            files.push(path);
        }
    }
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    path.extension()
        .and_then(|extension| extension.to_str())
        .is_some_and(|extension| extensions.contains(&extension.to_ascii_lowercase().as_str()))
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, String> {
    let bytes = fs::read(path).map_err(|error| error.to_string())?;
    if u32::try_from(bytes.len()).is_err() {
        return Err("larger than 4 GiB".to_owned());
    }
    Ok(bytes)
}

/// A path as it is shown, with `/`.
fn shown(path: &Path) -> String {
    let text = path.to_string_lossy();
    if std::path::MAIN_SEPARATOR == '/' { text.into_owned() } else { text.replace('\\', "/") }
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
            // Named or found, beside what can be read or not.
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
        // Beside something that can be read it is only listed.
        let input = read(&[gone, folder.path().join("note.txt")]).unwrap();
        assert_eq!((input.files.len(), input.unreadable.len()), (1, 1));
    }
}
