//! The findings of the linter in open documents.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;

use super::documents::Documents;
use super::host::Host;
use super::options::Options;
use super::uri::folder_of;
use crate::arm::robot::Model;
use crate::rapid::text::{FileId, SourceFile};
use crate::tool::lint::engine::{Examined, ReadCache, examine_file};
use crate::tool::lint::{Finding, Programs};

/// The folders of the open documents, and the last analysis of each document by URI.
#[derive(Default)]
pub(super) struct Findings {
    folders: BTreeMap<PathBuf, Folder>,
    analyses: BTreeMap<String, Analysis>,
}

/// A folder as last read from disk, after a document was opened, saved or closed.
struct Folder {
    programs: Programs,
    kept: ReadCache,
}

/// The findings in a document.
pub(super) struct Analysis {
    pub(super) file: SourceFile,
    /// The paths of all files of the programs, by number.
    paths: Rc<[String]>,
    pub(super) examined: Rc<Examined>,
    pub(super) dynamics: bool,
}

impl Findings {
    /// Discards the folder of a document; the next analysis reads it from disk.
    pub(super) fn forget(&mut self, uri: &str) {
        self.folders.remove(&folder_of(uri));
    }

    /// Discards all folders.
    pub(super) fn forget_all(&mut self) {
        self.folders.clear();
    }

    pub(super) fn close(&mut self, uri: &str) {
        self.analyses.remove(uri);
        self.forget(uri);
    }

    pub(super) fn get(&self, uri: &str) -> Option<&Analysis> {
        self.analyses.get(uri)
    }

    /// Lints the programs of a document; returns the open documents of which it has new findings.
    pub(super) fn analyse(
        &mut self,
        host: &dyn Host,
        options: &Options,
        documents: &Documents,
        uri: &str,
    ) -> Vec<String> {
        let folder = folder_of(uri);
        let read =
            || Folder { programs: host.programs(options, &folder), kept: ReadCache::default() };
        let Folder { programs, kept } = self.folders.entry(folder.clone()).or_insert_with(read);
        let mut names: BTreeMap<usize, &str> = BTreeMap::new();
        for (name, file) in documents.iter().filter(|(name, _)| folder_of(name) == folder) {
            let known = programs.files.iter().position(|known| known.path == file.path);
            let index = known.unwrap_or_else(|| programs.add(file.clone()));
            programs.files[index] = SourceFile { id: FileId(index as u32), ..file.clone() };
            names.insert(index, name);
        }
        let Some(own) = names.iter().find(|(_, name)| **name == uri).map(|(index, _)| *index)
        else {
            return Vec::new();
        };
        let dynamics = programs.model.as_ref().is_some_and(Model::has_dynamics);
        let examined = Rc::new(examine_file(&programs.job(), own, kept));
        let paths: Rc<[String]> = programs.files.iter().map(|file| file.path.clone()).collect();
        let together = |index: &usize| examined.programs.iter().all(|files| files.contains(index));
        let concerned = names.into_iter().filter(|(index, _)| *index == own || together(index));
        let mut found = Vec::new();
        for (index, name) in concerned {
            let file = programs.files[index].clone();
            let (paths, examined) = (Rc::clone(&paths), Rc::clone(&examined));
            let analysis = Analysis { file, paths, examined, dynamics };
            self.analyses.insert(name.to_owned(), analysis);
            found.push(name.to_owned());
        }
        found
    }
}

impl Analysis {
    /// The number of a file in the programs of the linter.
    pub(super) fn number_of(&self, path: &str) -> Option<FileId> {
        self.paths.iter().position(|known| known == path).map(|index| FileId(index as u32))
    }

    /// The findings in the document itself.
    pub(super) fn own_findings(&self) -> impl Iterator<Item = &Finding> {
        self.examined.report.findings.iter().filter(|finding| finding.span.file == self.file.id)
    }
}
