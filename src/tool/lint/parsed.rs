//! The parsed files of a job, and the programs that they form.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

use super::group::Group;
use super::job::Job;
use super::known::Known;
use super::suppress::{Suppression, suppressions};
use crate::arm::robot::Model;
use crate::rapid::ir::hir::Module;
use crate::rapid::ir::lower;
use crate::rapid::ir::program::Program;
use crate::rapid::syntax::{self, SyntaxError};
use crate::rapid::text::SourceFile;

/// A parsed file.
pub(super) struct ParsedFile {
    pub(super) modules: Vec<Module>,
    pub(super) errors: Vec<SyntaxError>,
    pub(super) suppressions: Vec<Suppression>,
}

impl ParsedFile {
    pub(super) fn new(file: &SourceFile) -> ParsedFile {
        let parse = syntax::parse(&file.bytes);
        let modules = lower(file.id, &parse, &file.bytes);
        let suppressions = suppressions(file, &parse);
        ParsedFile { modules, errors: parse.errors, suppressions }
    }
}

/// The parsed files and the simulated movements of the last runs: what did not change is neither parsed nor
/// simulated again.
#[derive(Default)]
pub struct ReadCache {
    files: Vec<(Vec<u8>, Arc<ParsedFile>)>,
    known: Option<Known>,
}

impl ReadCache {
    /// What is known of simulations with a robot.
    pub(super) fn known(&mut self, model: Option<&Model>) -> Option<Known> {
        self.known = match (self.known.take(), model) {
            (Some(known), Some(model)) if known.is_of(model) => Some(known),
            (_, model) => model.map(Known::new),
        };
        self.known.clone()
    }

    /// The parsed files of a job; they are kept for the next one.
    pub(super) fn read(&mut self, job: &Job<'_>) -> Vec<Arc<ParsedFile>> {
        let one = |(index, file): (usize, &SourceFile)| match self.files.get(index) {
            Some((bytes, read)) if *bytes == file.bytes => read.clone(),
            _ => Arc::new(ParsedFile::new(file)),
        };
        let read: Vec<Arc<ParsedFile>> = job.files.par_iter().enumerate().map(one).collect();
        let bytes = job.files.iter().map(|file| file.bytes.clone());
        self.files = bytes.zip(read.iter().cloned()).collect();
        read
    }
}

/// The parsed files of a job.
pub(super) fn read(job: &Job<'_>) -> Vec<Arc<ParsedFile>> {
    job.files.par_iter().map(|file| Arc::new(ParsedFile::new(file))).collect()
}

/// The program of a group.
pub(super) fn program(group: &Group, read: &[Arc<ParsedFile>]) -> Program {
    let files = group.files.iter().map(|file| &read[*file]);
    Program::new(files.flat_map(|file| file.modules.iter().cloned()).collect())
}

/// The programs of a job. A group with several entries is split by folder, and a folder with several
/// entries by file.
pub(super) fn programs(job: &Job<'_>, read: &[Arc<ParsedFile>]) -> Vec<Group> {
    let mut groups = Vec::new();
    for group in &job.groups {
        let entry = group.entry.to_lowercase();
        let entries = |file: &usize| {
            let modules = read[*file].modules.iter();
            modules.flat_map(|m| &m.routines).filter(|r| r.name.key == entry).count()
        };
        if group.files.iter().map(entries).sum::<usize>() <= 1 {
            groups.push(group.clone());
            continue;
        }
        let mut folders: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for file in &group.files {
            let path = &job.files[*file].path;
            let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
            folders.entry(folder).or_default().push(*file);
        }
        for files in folders.into_values() {
            if files.iter().map(entries).sum::<usize>() <= 1 {
                groups.push(Group { files, ..group.clone() });
            } else {
                let alone = |file| Group { files: vec![file], ..group.clone() };
                groups.extend(files.into_iter().map(alone));
            }
        }
    }
    groups
}
