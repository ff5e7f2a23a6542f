//! Open documents over the files of their folders, with their findings.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use gen_lsp_types::{
    TextDocumentContentChangeEvent, TextDocumentContentChangePartial as Partial,
    TextDocumentContentChangeWholeDocument as Whole,
};

use super::position::offset_of;
use crate::arm::robot::Model;
use crate::rapid::text::{FileId, SourceFile, Span};
use crate::retime::energy::EnergyParts;
use crate::retime::motion::timeline::What;
use crate::tool::lint::engine::{Examined, ReadCache, examine_file};
use crate::tool::lint::{Finding, Programs};

/// Open documents by URI, and their folders.
pub(super) struct Workspace<R> {
    /// Reads the programs of a folder.
    read: R,
    open: BTreeMap<String, SourceFile>,
    folders: BTreeMap<PathBuf, Folder>,
}

/// A folder as last read from disk, after a document was opened, saved or closed.
struct Folder {
    programs: Programs,
    kept: ReadCache,
}

/// The findings in a document.
pub(super) struct Analysis {
    pub(super) file: SourceFile,
    examined: Rc<Examined>,
    dynamics: bool,
}

/// Costs of a statement in a cycle.
pub(super) struct Costs {
    pub(super) span: Span,
    pub(super) what: String,
    pub(super) times: usize,
    pub(super) time_s: f64,
    /// `None` for robots without dynamics.
    pub(super) energy_j: Option<f64>,
}

impl<R: Fn(&Path) -> Programs> Workspace<R> {
    pub(super) fn new(read: R) -> Workspace<R> {
        Workspace { read, open: BTreeMap::new(), folders: BTreeMap::new() }
    }

    pub(super) fn open(&mut self, uri: &str, text: String) {
        let file = SourceFile::new(FileId(0), shown(&path_of(uri)), text.into_bytes());
        self.open.insert(uri.to_owned(), file);
        self.forget(uri);
    }

    /// Discards the folder of a document; the next analysis reads it from disk.
    pub(super) fn forget(&mut self, uri: &str) {
        self.folders.remove(&folder_of(uri));
    }

    /// Changes a range of a document, or the whole text if the range ends before its start.
    pub(super) fn change(&mut self, uri: &str, change: TextDocumentContentChangeEvent) {
        let Some(file) = self.open.get(uri) else { return };
        let bytes = match change {
            TextDocumentContentChangeEvent::TextDocumentContentChangePartial(Partial {
                range,
                text,
                ..
            }) => {
                let (start, end) = (offset_of(file, range.start), offset_of(file, range.end));
                if start <= end {
                    let before = &file.bytes[..start as usize];
                    [before, text.as_bytes(), &file.bytes[end as usize..]].concat()
                } else {
                    text.into_bytes()
                }
            }
            TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(Whole {
                text,
            }) => text.into_bytes(),
        };
        let file = SourceFile::new(FileId(0), file.path.clone(), bytes);
        self.open.insert(uri.to_owned(), file);
    }

    pub(super) fn close(&mut self, uri: &str) {
        self.open.remove(uri);
        self.forget(uri);
    }

    /// The open documents in the folder of a document.
    pub(super) fn open_beside(&self, uri: &str) -> BTreeSet<String> {
        let folder = folder_of(uri);
        self.open.keys().filter(|other| folder_of(other) == folder).cloned().collect()
    }

    /// Lints the programs of a document; returns the analyses of its open documents.
    pub(super) fn analyse(&mut self, uri: &str) -> Vec<(String, Analysis)> {
        let folder = folder_of(uri);
        let read = || Folder { programs: (self.read)(&folder), kept: ReadCache::default() };
        let Folder { programs, kept } = self.folders.entry(folder.clone()).or_insert_with(read);
        let mut names: BTreeMap<usize, &str> = BTreeMap::new();
        for (name, file) in
            self.open.iter().filter(|(name, _)| *name == uri || folder_of(name) == folder)
        {
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
        let together = |index: &usize| examined.programs.iter().all(|files| files.contains(index));
        let concerned = names.into_iter().filter(|(index, _)| *index == own || together(index));
        let analysis = |(index, name): (usize, &str)| {
            let file = programs.files[index].clone();
            (name.to_owned(), Analysis { file, examined: Rc::clone(&examined), dynamics })
        };
        concerned.map(analysis).collect()
    }
}

impl Analysis {
    /// The findings in the document itself.
    pub(super) fn own_findings(&self) -> impl Iterator<Item = &Finding> {
        self.examined.report.findings.iter().filter(|finding| finding.span.file == self.file.id)
    }

    /// The costs of the movement or wait at a byte.
    pub(super) fn costs_at(&self, at: u32) -> Option<Costs> {
        let mut found: Option<Costs> = None;
        for cycle in self.examined.cycles.iter().flatten() {
            for (event, parts) in cycle.simulation.events.iter().zip(&cycle.account.events) {
                let mut add = |span: Span, what: &str, time_s: f64, joules: f64| {
                    let here = span.file == self.file.id && span.start <= at && at <= span.end;
                    if !here {
                        return;
                    }
                    let energy_j = self.dynamics.then_some(0.0);
                    let what = what.to_owned();
                    let costs =
                        found.get_or_insert(Costs { span, what, times: 0, time_s: 0.0, energy_j });
                    costs.times += 1;
                    costs.time_s += time_s;
                    costs.energy_j = costs.energy_j.map(|sum| sum + joules);
                };
                match &event.what {
                    What::Run(run) => {
                        for (record, part) in run.moves.iter().zip(parts) {
                            let movement = &record.movement;
                            let joules = part.energy_j();
                            add(movement.span, &movement.instruction, record.duration, joules);
                        }
                    }
                    What::Wait(wait) => {
                        let joules = parts.iter().map(EnergyParts::energy_j).sum();
                        add(wait.wait.span, &wait.wait.instruction, event.duration, joules);
                    }
                    What::Output(..) | What::Left(_) => {}
                }
            }
        }
        found
    }
}

fn folder_of(uri: &str) -> PathBuf {
    path_of(uri).parent().map(Path::to_path_buf).unwrap_or_default()
}

/// The path of a `file:` URI, `%XX` decoded.
fn path_of(uri: &str) -> PathBuf {
    let rest = uri.strip_prefix("file://").unwrap_or(uri);
    let mut bytes = Vec::with_capacity(rest.len());
    let mut signs = rest.bytes();
    while let Some(byte) = signs.next() {
        let digits = || {
            let text: String = signs.clone().take(2).map(char::from).collect();
            u8::from_str_radix(&text, 16).ok()
        };
        match (byte, digits()) {
            (b'%', Some(decoded)) => {
                bytes.push(decoded);
                signs.nth(1);
            }
            _ => bytes.push(byte),
        }
    }
    let path = String::from_utf8_lossy(&bytes).into_owned();
    // A drive letter has a slash before it.
    let drive = path.get(2..3) == Some(":");
    PathBuf::from(if drive { path[1..].to_owned() } else { path })
}

fn shown(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}
