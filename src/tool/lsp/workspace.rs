//! The folders of the workspace and their projects.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use gen_lsp_types::{Location, TextDocumentContentChangeEvent};

use super::documents::Documents;
use super::host::Host;
use super::options::Options;
use super::position::{Positions, Units};
use super::project::Project;
use super::uri::{folder_of, path_of, shown};
use crate::rapid::text::{FileId, Span};

/// The folders of the workspace. Their modules are read when they are first needed.
#[derive(Default)]
pub(super) struct Workspace {
    pub(super) documents: Documents,
    pub(super) units: Units,
    folders: Vec<PathBuf>,
    projects: BTreeMap<PathBuf, Read>,
}

/// A project and whether it is as on disk.
struct Read {
    project: Project,
    fresh: bool,
}

/// A file as a request sees it.
#[derive(Clone, Copy)]
pub(super) struct View<'w> {
    pub(super) workspace: &'w Workspace,
    pub(super) project: &'w Project,
    pub(super) file: FileId,
}

impl Workspace {
    pub(super) fn new(units: Units, folders: Vec<PathBuf>) -> Workspace {
        Workspace { units, folders, ..Workspace::default() }
    }

    pub(super) fn folders(&self) -> &[PathBuf] {
        &self.folders
    }

    pub(super) fn set_folders(&mut self, folders: Vec<PathBuf>) {
        self.folders = folders;
        self.projects.clear();
    }

    pub(super) fn open(&mut self, uri: &str, text: String) {
        self.documents.open(uri, text);
        self.update(uri);
    }

    pub(super) fn change(&mut self, uri: &str, change: TextDocumentContentChangeEvent) {
        self.documents.change(uri, change, self.units);
        self.update(uri);
    }

    pub(super) fn close(&mut self, uri: &str) {
        self.documents.close(uri);
        self.read_again();
    }

    /// Reads all files again when they are next needed.
    pub(super) fn read_again(&mut self) {
        for read in self.projects.values_mut() {
            read.fresh = false;
        }
    }

    /// Gives the text of a document to its project.
    fn update(&mut self, uri: &str) {
        let folder = self.folder(uri);
        let (Some(document), Some(read)) =
            (self.documents.get(uri), self.projects.get_mut(&folder))
        else {
            return;
        };
        match read.project.find(&document.path) {
            Some(file) => read.project.replace(file, document),
            None => read.fresh = false,
        }
    }

    /// The folder of the project of a document: the innermost one of the workspace, or its own.
    fn folder(&self, uri: &str) -> PathBuf {
        let path = path_of(uri);
        let around = self.folders.iter().filter(|folder| path.starts_with(folder));
        let innermost = around.max_by_key(|folder| folder.components().count());
        innermost.cloned().unwrap_or_else(|| folder_of(uri))
    }

    /// Reads the project of a folder unless it is there.
    fn read(&mut self, host: &dyn Host, options: &Options, folder: &Path) {
        if self.projects.get(folder).is_some_and(|read| read.fresh) {
            return;
        }
        let old = self.projects.remove(folder).map(|read| read.project);
        let inside = |uri: &str| self.folder(uri) == folder;
        let open = self.documents.iter().filter(|(uri, _)| inside(uri)).map(|(_, file)| file);
        let project = Project::new(host.project(options, folder), open, old);
        self.projects.insert(folder.to_path_buf(), Read { project, fresh: true });
    }

    /// The file of a document; `None` if it is neither open nor in the workspace.
    pub(super) fn view(
        &mut self,
        host: &dyn Host,
        options: &Options,
        uri: &str,
    ) -> Option<View<'_>> {
        let folder = self.folder(uri);
        self.read(host, options, &folder);
        let project = &self.projects.get(&folder)?.project;
        let file = project.find(&shown(&path_of(uri)))?;
        Some(View { workspace: self, project, file })
    }

    /// The projects of the workspace and of the open documents.
    pub(super) fn projects(&mut self, host: &dyn Host, options: &Options) -> Vec<View<'_>> {
        let mut folders: BTreeSet<PathBuf> = self.folders.iter().cloned().collect();
        folders.extend(self.documents.iter().map(|(uri, _)| self.folder(uri)));
        for folder in &folders {
            self.read(host, options, folder);
        }
        let mut views = Vec::new();
        for (_, read) in self.projects.iter().filter(|(folder, _)| folders.contains(*folder)) {
            views.push(View { workspace: self, project: &read.project, file: FileId(0) });
        }
        views
    }
}

impl<'w> View<'w> {
    pub(super) fn positions_of(self, file: FileId) -> Positions<'w> {
        Positions::new(&self.project.module(file).file, self.workspace.units)
    }

    pub(super) fn positions(self) -> Positions<'w> {
        self.positions_of(self.file)
    }

    pub(super) fn uri_of(self, file: FileId) -> String {
        self.workspace.documents.uri(&self.project.module(file).file.path)
    }

    pub(super) fn location(self, span: Span) -> Location {
        let range = self.positions_of(span.file).range(span);
        Location { uri: self.uri_of(span.file).into(), range }
    }
}
