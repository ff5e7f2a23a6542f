//! Which files are loaded together.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::arm::robot::system_parameters;
use crate::rapid::check::Extent;
use crate::rapid::syntax::{NodeKind, Parse};
use crate::rapid::text::{self, is_encoded_module};
use crate::tool::cli::backup::{self, is_shared};
use crate::tool::cli::input::{self, Input, InputFile};

/// Most programs of one folder, times the files that they share, for which the shared files are
/// checked with each program.
const SHARED: usize = 4_000;

/// The files of a task.
pub(in crate::tool::cli) struct TaskFiles {
    /// Their numbers.
    pub(in crate::tool::cli) files: Vec<usize>,
    /// How much of the task they are.
    pub(in crate::tool::cli) extent: Extent,
    /// The procedure that starts it.
    pub(in crate::tool::cli) entry: String,
    /// Whether they have it.
    pub(in crate::tool::cli) starts: bool,
}

/// The tasks of the input: those of backups, the programs of `.pgf` files, and the rest, which is
/// one program if it has one entry. With several, each is a program together with the files of its
/// folder that have none.
pub(in crate::tool::cli) fn tasks(input: &Input, parses: &[Parse], entry: &str) -> Vec<TaskFiles> {
    let mut tasks = of_backups(input, parses, entry);
    let mut taken: BTreeSet<usize> = tasks.iter().flat_map(|task| task.files.clone()).collect();
    let facts = Facts { input, parses, entry };
    for listing in &input.listings {
        let files: Vec<usize> = input
            .files
            .iter()
            .enumerate()
            .filter(|(index, file)| {
                !taken.contains(index)
                    && listing.modules.iter().any(|path| same(path, &file.source.path))
            })
            .map(|(index, _)| index)
            .collect();
        taken.extend(files.iter().copied());
        if !files.is_empty() {
            tasks.push(facts.task(files, Extent::Task));
        }
    }
    let rest: Vec<usize> = (0..input.files.len()).filter(|index| !taken.contains(index)).collect();
    facts.split(rest, &mut tasks);
    tasks
}

fn same(a: &str, b: &str) -> bool {
    a == b || matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b)
}

/// The names in the declarations of a file with this kind.
fn names(file: &InputFile, parse: &Parse, kind: NodeKind) -> Vec<String> {
    let nodes = parse.tree.nodes().filter(|node| node.kind() == kind);
    let names = nodes.filter_map(|node| node.child(NodeKind::Name));
    names.map(|name| text(file, name.text(&file.source.bytes)).to_lowercase()).collect()
}

fn text(file: &InputFile, bytes: &[u8]) -> String {
    file.source.charset.decode(bytes).into_owned()
}

struct Facts<'i> {
    input: &'i Input,
    parses: &'i [Parse],
    entry: &'i str,
}

impl Facts<'_> {
    /// The number of procedures of a file that start a program: one for each program in it.
    fn entries(&self, file: usize) -> usize {
        let entry = self.entry.to_lowercase();
        let procedures =
            names(&self.input.files[file], &self.parses[file], NodeKind::ProcDeclaration);
        procedures.iter().filter(|name| **name == entry).count()
    }

    fn starts(&self, file: usize) -> bool {
        self.entries(file) > 0
    }

    fn task(&self, files: Vec<usize>, extent: Extent) -> TaskFiles {
        let starts = files.iter().any(|file| self.starts(*file));
        TaskFiles { files, extent, entry: self.entry.to_owned(), starts }
    }

    /// Files without a stated task.
    fn split(&self, files: Vec<usize>, tasks: &mut Vec<TaskFiles>) {
        if files.is_empty() {
            return;
        }
        let starting = files.iter().filter(|file| self.starts(**file)).count();
        if starting <= 1 {
            tasks.push(self.one_entry(files));
            return;
        }
        let mut folders: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for file in files {
            let path = &self.input.files[file].source.path;
            let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
            folders.entry(folder).or_default().push(file);
        }
        for files in folders.into_values() {
            let (with, without): (Vec<usize>, Vec<usize>) =
                files.iter().copied().partition(|file| self.starts(*file));
            match with.as_slice() {
                [] => tasks.push(self.task(without, Extent::Some)),
                [_] => tasks.push(self.one_entry(files)),
                several if several.len() * without.len() > SHARED => {
                    tasks.extend(several.iter().map(|one| self.one_entry(vec![*one])));
                    tasks.push(self.task(without, Extent::Some));
                }
                several if without.is_empty() => {
                    tasks.extend(several.iter().map(|one| self.one_entry(vec![*one])));
                }
                several => tasks.extend(several.iter().map(|one| {
                    let files = std::iter::once(*one).chain(without.iter().copied()).collect();
                    self.task(files, Extent::Some)
                })),
            }
        }
    }

    /// Files of which at most one has an entry. A file with several entries is a collection of
    /// programs.
    fn one_entry(&self, files: Vec<usize>) -> TaskFiles {
        let entries: usize = files.iter().map(|file| self.entries(*file)).sum();
        let is_program = entries == 1 && !self.has_alternatives(&files);
        self.task(files, if is_program { Extent::Program } else { Extent::Some })
    }

    /// Whether two files that were found in a folder have modules of one name: they are variants,
    /// and not loaded together.
    fn has_alternatives(&self, files: &[usize]) -> bool {
        let found = files.iter().filter(|file| !self.input.files[**file].named);
        let mut seen = BTreeSet::new();
        let modules = found.flat_map(|file| {
            names(&self.input.files[*file], &self.parses[*file], NodeKind::Module)
        });
        modules.into_iter().any(|name| !seen.insert(name))
    }
}

fn of_backups(input: &Input, parses: &[Parse], entry: &str) -> Vec<TaskFiles> {
    let places =
        || input.files.iter().enumerate().filter_map(|(i, file)| Some((i, file.place.as_ref()?)));
    let mut folders: Vec<(usize, &str)> = Vec::new();
    for (_, place) in places() {
        let task = (place.backup, place.folder.as_str());
        if !is_shared(&place.folder) && !folders.contains(&task) {
            folders.push(task);
        }
    }
    let mut tasks = Vec::new();
    for (number, folder) in folders {
        let (root, backup) = &input.backups[number];
        let own = places().filter(|(_, place)| {
            place.backup == number && (place.folder == folder || is_shared(&place.folder))
        });
        let files: Vec<usize> = own.map(|(file, _)| file).collect();
        let stated = backup.tasks.iter().find(|task| task.folder == folder);
        let entry = stated.and_then(|task| task.entry.clone()).unwrap_or_else(|| entry.to_owned());
        let facts = Facts { input, parses, entry: &entry };
        let extent = match controller_names(root) {
            Some(names) if is_complete(root, folder, input, &files) => Extent::All(names),
            _ if files.len() > 1 => Extent::Task,
            _ => Extent::Some,
        };
        tasks.push(facts.task(files, extent));
    }
    tasks
}

/// Whether all modules of a task were read, and as text.
fn is_complete(root: &Path, folder: &str, input: &Input, files: &[usize]) -> bool {
    let read: BTreeSet<_> = files
        .iter()
        .filter_map(|file| fs::canonicalize(&input.files[*file].source.path).ok())
        .collect();
    let encoded = files.iter().any(|file| is_encoded_module(&input.files[*file].source.bytes));
    let files = backup::files(root, folder);
    let mut modules = files.iter().filter(|path| input::is_module(path));
    !encoded && modules.all(|path| fs::canonicalize(path).is_ok_and(|path| read.contains(&path)))
}

/// The names that the configuration of a backup declares (signals, mechanical units, tasks), in
/// lower case; `None` without its signals.
fn controller_names(root: &Path) -> Option<Vec<String>> {
    let folder = backup::child(root, "SYSPAR")?;
    let signals = backup::child(&folder, "EIO.cfg")?;
    let others = ["MOC.cfg", "SYS.cfg", "PROC.cfg", "SIO.cfg"];
    let others = others.iter().filter_map(|name| backup::child(&folder, name));
    let mut names = Vec::new();
    for path in std::iter::once(signals).chain(others) {
        let text = text::decode(&fs::read(path).ok()?).text;
        names.extend(system_parameters::names(&text).iter().map(|name| name.to_lowercase()));
    }
    // A task has predefined data of type taskid.
    let tasks: Vec<String> = names.iter().map(|name| format!("{name}id")).collect();
    names.extend(tasks);
    Some(names)
}
