//! Finds the files of a path: a file, a folder to search, or the modules of a `.pgf`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use thiserror::Error;

use crate::rapid::text::decode;
use crate::tool::cli::backup;

/// Extensions of files with RAPID text, in lower case.
const MODULES: [&str; 5] = ["mod", "sys", "prg", "modx", "sysx"];
/// Extension of a program file, which lists modules.
const PROGRAM: &str = "pgf";
/// Searched extensions, for messages.
const EXTENSIONS: &str = ".mod, .sys, .prg, .modx, .sysx or .pgf";
/// Maximum depth of folders.
const MAX_FOLDERS: usize = 32;

/// A file or folder that could not be read.
#[derive(Clone, Debug)]
pub(in crate::tool::cli) struct Unreadable {
    /// Its path.
    pub(in crate::tool::cli) path: String,
    /// The reason.
    pub(in crate::tool::cli) reason: String,
}

/// Why nothing was read.
#[derive(Debug, Error)]
pub(in crate::tool::cli) enum InputError {
    /// No path was given.
    #[error("no file or folder given; name a RAPID file, a folder or a .pgf program")]
    Nothing,
    /// The folder contains no RAPID.
    #[error(
        "no RAPID in '{0}': looked in it and its folders for {EXTENSIONS}; name a file to read it \
         whatever its extension"
    )]
    NoRapid(String),
    /// None of the modules of a `.pgf` exists.
    #[error("'{0}' lists no module that can be read; name the module files themselves")]
    EmptyProgram(String),
    /// A `.pgf` lists a file outside its folder, which would be copied and changed with the
    /// program.
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
        /// The part that leads outside.
        why: &'static str,
    },
    /// The path cannot be read.
    #[error("cannot read '{}': {}; check the path and its permissions", .0.path, .0.reason)]
    Unreadable(Unreadable),
}

pub(super) struct FoundFile {
    pub(super) path: PathBuf,
    /// Its path relative to the input, with `/`.
    pub(super) relative: String,
    /// Whether the command line names it, directly or by a program file.
    pub(super) named: bool,
    /// The paths of the modules of a program file.
    pub(super) modules: Option<Vec<String>>,
}

/// The files of a path; unreadable parts of a folder are added to `unreadable`.
pub(super) fn find(
    path: &Path,
    unreadable: &mut Vec<Unreadable>,
) -> Result<Vec<FoundFile>, InputError> {
    let unusable = |error: std::io::Error| unreadable_input(path, error.to_string());
    if fs::metadata(path).map_err(unusable)?.is_dir() {
        fs::read_dir(path).map_err(unusable)?;
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
            return Err(InputError::NoRapid(shown(path)));
        }
        let modules = modules.into_iter().map(|file| found_below(path, file, false));
        return Ok(modules.chain(listings).collect());
    }
    if has_extension(path, &[PROGRAM]) {
        return program(path, unreadable);
    }
    Ok(vec![found_below(path.parent().unwrap_or(Path::new("")), path.to_path_buf(), true)])
}

fn unreadable_input(path: &Path, reason: String) -> InputError {
    InputError::Unreadable(Unreadable { path: shown(path), reason })
}

fn found_below(root: &Path, path: PathBuf, named: bool) -> FoundFile {
    let relative = path.strip_prefix(root).map_or_else(|_| file_name(&path), relative_text);
    FoundFile { path, relative, named, modules: None }
}

fn found_listing(root: &Path, path: PathBuf, modules: &[PathBuf]) -> FoundFile {
    let modules = modules.iter().map(|module| shown(module)).collect();
    FoundFile { modules: Some(modules), ..found_below(root, path, true) }
}

/// Gives files with equal paths below `--out` distinct ones, relative to their deepest common
/// folder.
pub(super) fn make_distinct(found: &mut [FoundFile]) {
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
        file.relative = relative_text(absolute.strip_prefix(&shared).unwrap_or(absolute));
    }
}

/// A path without components that lead out of a folder.
pub(super) fn relative_text(path: &Path) -> String {
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
fn program(path: &Path, unreadable: &mut Vec<Unreadable>) -> Result<Vec<FoundFile>, InputError> {
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
        return Err(InputError::EmptyProgram(shown(path)));
    }
    files.push(listing);
    Ok(files)
}

/// The paths between `<Module>` and `</Module>`, relative to the program file.
fn listed(path: &Path) -> Result<Vec<PathBuf>, InputError> {
    const BEGIN: &str = "<Module>";
    let bytes = bytes_of(path).map_err(|reason| unreadable_input(path, reason))?;
    let text = decode(&bytes).text;
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

/// Why a listed module lies outside the folder of its program file; `None` if it does not.
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

/// Resolves a path of a controller, which accepts both separators and ignores case.
fn below_in_any_case(folder: &Path, path: &str) -> PathBuf {
    let parts = path.split(['/', '\\']).filter(|part| !part.is_empty());
    parts.fold(folder.to_path_buf(), |folder, part| {
        backup::child(&folder, part).unwrap_or_else(|| folder.join(part))
    })
}

/// Resolves the escapes of XML text.
fn unescaped(text: &str) -> String {
    let escapes = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
    escapes.iter().fold(text.to_owned(), |text, (escape, sign)| text.replace(escape, sign))
}

/// Collects the RAPID files below a folder. Links to folders are not followed, as they may be
/// cyclic.
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
        } else if (is_module(&path) || has_extension(&path, &[PROGRAM])) && path.is_file() {
            files.push(path);
        }
    }
}

/// Whether a file of this name is searched for in folders as a module.
pub(in crate::tool::cli) fn is_module(path: &Path) -> bool {
    has_extension(path, &MODULES)
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    path.extension()
        .and_then(|extension| extension.to_str())
        .is_some_and(|extension| extensions.contains(&extension.to_ascii_lowercase().as_str()))
}

pub(super) fn bytes_of(path: &Path) -> Result<Vec<u8>, String> {
    let bytes = fs::read(path).map_err(|error| error.to_string())?;
    if u32::try_from(bytes.len()).is_err() {
        return Err("larger than 4 GiB".to_owned());
    }
    Ok(bytes)
}

/// A path for display, with `/`.
pub(super) fn shown(path: &Path) -> String {
    let text = path.to_string_lossy();
    if std::path::MAIN_SEPARATOR == '/' { text.into_owned() } else { text.replace('\\', "/") }
}
