//! One of the two programs that are compared.

use rayon::prelude::*;

use super::unread::{Unread, unread};
use crate::rapid::ir::hir::Module;
use crate::rapid::ir::lower;
use crate::rapid::ir::program::Program;
use crate::rapid::syntax;
use crate::rapid::text::SourceFile;

/// The files of one side.
#[derive(Clone, Debug, Default)]
pub struct Side {
    /// The files; their ids count from 0.
    pub files: Vec<SourceFile>,
    /// Their paths below what was named, with `/`: equal ones name the same program on both sides.
    pub relative: Vec<String>,
    /// The programs that they form.
    pub groups: Vec<Group>,
}

/// Files that belong together: a task of a controller, or the files that were named.
#[derive(Clone, Debug, Default)]
pub struct Group {
    /// The task; empty for files that are not of a controller's backup.
    pub name: String,
    /// Indices of its files.
    pub files: Vec<usize>,
    /// Indices of the files whose names it sees, but which belong to all tasks.
    pub shared: Vec<usize>,
    /// The routine that starts it.
    pub entry: String,
}

/// The parsed files of a side.
pub(super) struct Read {
    /// Modules, unreadable text and number of syntax errors by file.
    files: Vec<ReadFile>,
}

struct ReadFile {
    modules: Vec<Module>,
    unread: Vec<Unread>,
    errors: usize,
}

/// A program of a side, with its symbols.
pub(super) struct Half<'a> {
    pub(super) files: &'a [SourceFile],
    pub(super) program: Program,
    /// Number of modules that are compared; the others are only visible to them.
    pub(super) own: usize,
    /// Text outside of everything that can be read.
    pub(super) unread: Vec<&'a Unread>,
}

impl Read {
    pub(super) fn new(side: &Side) -> Read {
        let read = |file: &SourceFile| {
            let parse = syntax::parse(&file.bytes);
            let modules = lower(file.id, &parse, &file.bytes);
            let unread = unread(file, &parse);
            ReadFile { modules, unread, errors: parse.errors.len() }
        };
        Read { files: side.files.par_iter().map(read).collect() }
    }

    /// The files with syntax errors, and the number of errors.
    pub(super) fn errors(&self) -> impl Iterator<Item = (usize, usize)> {
        let files = self.files.iter().enumerate();
        files.map(|(index, file)| (index, file.errors)).filter(|(_, errors)| *errors > 0)
    }

    /// Number of declarations of a routine in a file.
    pub(super) fn entries(&self, file: usize, entry: &str) -> usize {
        let routines = self.files[file].modules.iter().flat_map(|module| &module.routines);
        routines.filter(|routine| routine.name.key == entry).count()
    }

    /// The program of a group.
    pub(super) fn half<'a>(&'a self, side: &'a Side, group: &Group) -> Half<'a> {
        let modules = |files: &[usize]| {
            files.iter().flat_map(|file| self.files[*file].modules.clone()).collect()
        };
        let mut all: Vec<Module> = modules(&group.files);
        let own = all.len();
        let shared: Vec<Module> = modules(&group.shared);
        all.extend(shared);
        let unread = group.files.iter().flat_map(|file| &self.files[*file].unread);
        Half { files: &side.files, program: Program::new(all), own, unread: unread.collect() }
    }
}
