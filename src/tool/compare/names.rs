//! Names of the old side as the new side has them.

use std::collections::{BTreeMap, BTreeSet};

use crate::rapid::ir::hir::{Module, Routine, Scope};

/// Renamed names: lower case, from old to new.
#[derive(Clone, Debug, Default)]
pub(super) struct Renames {
    /// Names that the whole task sees.
    pub(super) global: BTreeMap<String, String>,
    /// `LOCAL` names, by the old module's index.
    pub(super) local: BTreeMap<usize, BTreeMap<String, String>>,
}

/// The `LOCAL` names of an old module, with their new names.
#[derive(Debug)]
pub(super) struct LocalNames<'a> {
    names: BTreeMap<&'a str, &'a str>,
}

impl<'a> LocalNames<'a> {
    pub(super) fn new(module: &'a Module, index: usize, renames: &'a Renames) -> LocalNames<'a> {
        let renamed = renames.local.get(&index);
        let data = module.data.iter().map(|data| (data.scope, &data.name));
        let routines = module.routines.iter().map(|routine| (routine.scope, &routine.name));
        let locals = data.chain(routines).filter(|(scope, _)| *scope == Scope::Local);
        let new = |key: &'a String| {
            renamed.and_then(|names| names.get(key)).map_or(key.as_str(), String::as_str)
        };
        LocalNames { names: locals.map(|(_, name)| (name.key.as_str(), new(&name.key))).collect() }
    }
}

/// What the names in a routine, or in the data of a module, mean; by default what they say.
#[derive(Clone, Debug, Default)]
pub(super) struct Names<'a> {
    /// Names of the routine, with their new names.
    routine: BTreeMap<&'a str, &'a str>,
    module: Option<&'a LocalNames<'a>>,
    global: Option<&'a BTreeMap<String, String>>,
}

impl<'a> Names<'a> {
    /// The names of the data of an old module.
    pub(super) fn of_module(local: &'a LocalNames<'a>, renames: &'a Renames) -> Names<'a> {
        Names { routine: BTreeMap::new(), module: Some(local), global: Some(&renames.global) }
    }

    /// The names in an old routine; `renamed` are those of the routine itself.
    #[must_use]
    pub(super) fn in_routine(
        mut self,
        routine: &'a Routine,
        renamed: &'a BTreeMap<String, String>,
    ) -> Names<'a> {
        for key in locals(routine) {
            self.routine.insert(key, renamed.get(key).map_or(key, String::as_str));
        }
        self
    }

    /// The new name.
    pub(super) fn of<'k>(&self, key: &'k str) -> &'k str
    where
        'a: 'k,
    {
        let of_module = || self.module.and_then(|local| local.names.get(key));
        let known = self.routine.get(key).or_else(of_module).copied();
        let global = || self.global.and_then(|names| names.get(key)).map(String::as_str);
        known.or_else(global).unwrap_or(key)
    }
}

/// The names of data and parameters that a routine declares.
pub(super) fn locals(routine: &Routine) -> BTreeSet<&str> {
    let params = routine.params.iter().map(|param| param.name.key.as_str());
    params.chain(super::declared::data(routine).map(|data| data.name.key.as_str())).collect()
}
