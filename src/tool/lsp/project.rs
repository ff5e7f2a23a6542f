//! The modules of a folder, with the text of the editor where it has a file open.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::host::{ProjectFiles, TaskFiles};
use super::module::Module;
use super::task::Task;
use crate::rapid::check::Extent;
use crate::rapid::names::Names;
use crate::rapid::text::{FileId, SourceFile, Span};

/// The procedure that starts a program of which nothing else is known.
const ENTRY: &str = "main";

/// The modules of a folder, by number, and which of them are loaded together.
pub(super) struct Project {
    pub(super) modules: Vec<Module>,
    pub(super) tasks: Vec<Task>,
    by_path: BTreeMap<String, usize>,
}

impl Project {
    /// A project with the files of a folder. `open` are the documents of the editor, in the order of
    /// their paths. Trees of files that `old` has with the same bytes are kept.
    pub(super) fn new<'d>(
        read: ProjectFiles,
        open: impl Iterator<Item = &'d SourceFile>,
        old: Option<Project>,
    ) -> Project {
        let ProjectFiles { mut files, mut tasks } = read;
        let mut by_path: BTreeMap<String, usize> =
            files.iter().enumerate().map(|(index, file)| (file.path.clone(), index)).collect();
        for document in open {
            let next = files.len();
            let index = *by_path.entry(document.path.clone()).or_insert(next);
            if index == next {
                join(next, document, &files, &mut tasks);
                files.push(document.clone());
            } else {
                files[index] = document.clone();
            }
        }
        let mut kept: BTreeMap<String, Module> = BTreeMap::new();
        for module in old.into_iter().flat_map(|old| old.modules) {
            kept.insert(module.file.path.clone(), module);
        }
        let module = |(index, file): (usize, SourceFile)| {
            let id = FileId(index as u32);
            match kept.remove(&file.path) {
                Some(mut module) if module.file.bytes == file.bytes => {
                    module.file.id = id;
                    module
                }
                _ => Module::new(SourceFile { id, ..file }),
            }
        };
        Project {
            modules: files.into_iter().enumerate().map(module).collect(),
            tasks: tasks.into_iter().map(Task::new).collect(),
            by_path,
        }
    }

    /// The number of a file.
    pub(super) fn find(&self, path: &str) -> Option<FileId> {
        self.by_path.get(path).map(|index| FileId(*index as u32))
    }

    pub(super) fn module(&self, file: FileId) -> &Module {
        &self.modules[file.0 as usize]
    }

    /// The text of a span of a file.
    pub(super) fn text(&self, span: Span) -> Cow<'_, str> {
        self.module(span.file).file.text(span)
    }

    /// Gives a file another text. Only its own tree is made again.
    pub(super) fn replace(&mut self, id: FileId, file: &SourceFile) {
        let index = id.0 as usize;
        if self.modules[index].file.bytes == file.bytes {
            return;
        }
        self.modules[index] = Module::new(SourceFile { id, ..file.clone() });
        for task in self.tasks.iter_mut().filter(|task| task.files.files.contains(&index)) {
            task.forget();
        }
    }

    /// The tasks that load a file.
    pub(super) fn tasks_of(&self, file: FileId) -> impl Iterator<Item = &Task> {
        self.tasks.iter().filter(move |task| task.files.files.contains(&(file.0 as usize)))
    }

    /// The names of the tasks that load a file.
    pub(super) fn names_of(&self, file: FileId) -> impl Iterator<Item = &Names> {
        self.tasks_of(file).map(|task| task.names(&self.modules))
    }
}

/// Adds a file that is not on disk to the tasks of its folder, or makes one for it.
fn join(index: usize, document: &SourceFile, files: &[SourceFile], tasks: &mut Vec<TaskFiles>) {
    let folder = |path: &str| path.rsplit_once('/').map(|(folder, _)| folder.to_owned());
    let own = folder(&document.path);
    let beside = |task: &TaskFiles| task.files.iter().any(|one| folder(&files[*one].path) == own);
    let mut joined = false;
    for task in tasks.iter_mut().filter(|task| beside(task)) {
        task.files.push(index);
        joined = true;
    }
    if !joined {
        tasks.push(TaskFiles {
            files: vec![index],
            extent: Extent::Some,
            entry: ENTRY.to_owned(),
            controller: usize::MAX,
        });
    }
}
