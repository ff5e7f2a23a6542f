//! The comparison of two sides.

use std::collections::{BTreeMap, BTreeSet};

use super::change::Change;
use super::cycle::{Cycle, Run, Runs, cycle, run};
use super::program::changes;
use super::side::{Group, Half, Read, Side};
use crate::arm::robot::Model;
use crate::retime::energy::plausible::Robots;
use crate::retime::motion::Options;

/// What both programs are simulated with.
#[derive(Clone, Copy)]
pub enum Robot<'r> {
    /// A robot.
    Known {
        /// The robot.
        model: &'r Model,
        /// Options of the simulation.
        options: &'r Options,
        /// Draws of plausible robots, if intervals are asked for.
        plausible: Option<&'r Robots>,
    },
    /// None, and why.
    Unknown(&'r str),
}

/// What changed between two sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// By task and module; in the order of the new program.
    pub changes: Vec<Change>,
    /// The cycles, one per task or program.
    pub cycles: Vec<Cycle>,
    /// Number of `PERS` values that differ and that the controller saves with a program.
    pub state: usize,
    /// Files with syntax errors, old and new: index and number of errors.
    pub errors: [Vec<(usize, usize)>; 2],
}

/// Compares two sides, and the cycles of the programs in them.
#[must_use]
pub fn compare(old: &Side, new: &Side, robot: Robot<'_>) -> Comparison {
    let (old_read, new_read) = (Read::new(old), Read::new(new));
    let mut comparison = Comparison {
        changes: Vec::new(),
        cycles: Vec::new(),
        state: 0,
        errors: [old_read.errors().collect(), new_read.errors().collect()],
    };
    let (old_groups, new_groups) = (split(old, &old_read), split(new, &new_read));
    for (a, b) in pairs(&old_groups, &new_groups) {
        let empty = Group::default();
        let before = old_read.half(old, a.unwrap_or(&empty));
        let after = new_read.half(new, b.unwrap_or(&empty));
        let name = b.or(a).map_or("", |group| group.name.as_str());
        let found = changes(name, &before, &after);
        let changed: BTreeSet<String> =
            found.list.iter().filter_map(|change| change.routine.clone()).collect();
        let runs = [(a, &before), (b, &after)].map(|(group, half)| simulated(group, half, robot));
        let (model, robots) = match robot {
            Robot::Known { model, plausible, .. } => (Some(model), plausible),
            Robot::Unknown(_) => (None, None),
        };
        let of = Runs {
            task: name,
            both: runs.each_ref(),
            renamed: &found.routines,
            changed: &changed,
            model,
            robots,
        };
        comparison.cycles.push(cycle(&of));
        comparison.changes.extend(found.list);
        comparison.state += found.state;
    }
    comparison
}

fn simulated(group: Option<&Group>, half: &Half<'_>, robot: Robot<'_>) -> Result<Run, String> {
    match (group, robot) {
        (None, _) => Err("there is no such program".to_owned()),
        (_, Robot::Unknown(why)) => Err(why.to_owned()),
        (Some(group), Robot::Known { model, options, .. }) => {
            run(&half.program, &group.entry, model, options)
        }
    }
}

/// Groups with the same name correspond; two that are the only ones do, too.
fn pairs<'g>(old: &'g [Group], new: &'g [Group]) -> Vec<(Option<&'g Group>, Option<&'g Group>)> {
    if let ([a], [b]) = (old, new) {
        return vec![(Some(a), Some(b))];
    }
    let mut free: Vec<&Group> = new.iter().collect();
    let mut found = Vec::new();
    for a in old {
        let at = free.iter().position(|b| b.name == a.name);
        found.push((Some(a), at.map(|at| free.remove(at))));
    }
    found.extend(free.into_iter().map(|b| (None, Some(b))));
    found
}

/// A group with several entries is split by folder, and a folder with several entries by file.
fn split(side: &Side, read: &Read) -> Vec<Group> {
    let mut groups = Vec::new();
    for group in &side.groups {
        let entry = group.entry.to_lowercase();
        let entries =
            |files: &[usize]| files.iter().map(|file| read.entries(*file, &entry)).sum::<usize>();
        if entries(&group.files) <= 1 {
            groups.push(group.clone());
            continue;
        }
        let path = |file: usize| side.relative[file].as_str();
        let mut folders: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for file in &group.files {
            let folder = path(*file).rsplit_once('/').map_or("", |(folder, _)| folder);
            folders.entry(folder.to_owned()).or_default().push(*file);
        }
        for (folder, files) in folders {
            if entries(&files) <= 1 {
                groups.push(Group { name: folder, files, ..group.clone() });
            } else {
                let alone = |file| Group {
                    name: path(file).to_owned(),
                    files: vec![file],
                    ..group.clone()
                };
                groups.extend(files.into_iter().map(alone));
            }
        }
    }
    groups
}
