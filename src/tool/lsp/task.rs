//! The files that a controller loads together.

use std::cell::OnceCell;

use super::host::TaskFiles;
use super::module::Module;
use crate::rapid::check::{self, check};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{Names, SourceText};

/// A task. What its names mean, and its faults, are found when they are first needed.
pub(super) struct Task {
    pub(super) files: TaskFiles,
    names: OnceCell<Names>,
    faults: OnceCell<Vec<Diagnostic>>,
}

impl Task {
    pub(super) fn new(files: TaskFiles) -> Task {
        Task { files, names: OnceCell::new(), faults: OnceCell::new() }
    }

    /// Forgets what was found, because a file has changed.
    pub(super) fn forget(&mut self) {
        self.names.take();
        self.faults.take();
    }

    pub(super) fn sources<'m>(&self, modules: &'m [Module]) -> Vec<SourceText<'m>> {
        self.files.files.iter().map(|index| modules[*index].source()).collect()
    }

    pub(super) fn names(&self, modules: &[Module]) -> &Names {
        self.names.get_or_init(|| Names::new(&self.sources(modules)))
    }

    /// Why a controller would not load it.
    pub(super) fn faults(&self, modules: &[Module]) -> &[Diagnostic] {
        self.faults.get_or_init(|| {
            let TaskFiles { extent, entry, .. } = &self.files;
            check(&check::Task { files: &self.sources(modules), extent, entry })
        })
    }
}
