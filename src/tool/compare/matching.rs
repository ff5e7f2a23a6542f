//! Which modules, routines and data of two programs correspond.
//!
//! By name first. What is left over may have moved to another module, or have another name and
//! otherwise be the same.

use std::collections::{BTreeMap, BTreeSet};

use super::canonical::Writer;
use super::context::read_names;
use super::names::{LocalNames, Names, Renames};
use super::print::routine_text;
use super::side::Half;
use crate::rapid::ir::hir::{Callee, Data, Expr, Routine, Scope, StmtKind};
use crate::rapid::ir::program::{DataId, RoutineId};

/// Corresponding parts of two programs, old and new.
#[derive(Debug, Default)]
pub(super) struct Matching {
    pub(super) modules: Vec<(usize, usize)>,
    pub(super) routines: Vec<(RoutineId, RoutineId)>,
    pub(super) data: Vec<(DataId, DataId)>,
    pub(super) renames: Renames,
}

/// Matches two programs.
pub(super) fn matching(old: &Half<'_>, new: &Half<'_>) -> Matching {
    let mut found = Matching { modules: modules(old, new), ..Matching::default() };
    let new_of: BTreeMap<usize, usize> = found.modules.iter().copied().collect();
    let mut free = Free::new(old, new);
    // In the same module first, then in any.
    for same_module in [true, false] {
        let old_place = |module: usize| same_module.then(|| new_of.get(&module).copied());
        let new_place = |module: usize| same_module.then_some(Some(module));
        let routines = by_name(
            &free.old_routines,
            &free.new_routines,
            |id| (old_place(id.module), &old.program.routine(id).name.key),
            |id| (new_place(id.module), &new.program.routine(id).name.key),
        );
        for (a, b) in routines {
            free.take_routines(a, b);
            found.routines.push((a, b));
        }
        let data = by_name(
            &free.old_data,
            &free.new_data,
            |id| (old_place(id.module), &old.program.data(id).name.key),
            |id| (new_place(id.module), &new.program.data(id).name.key),
        );
        for (a, b) in data {
            free.take_data(a, b);
            found.data.push((a, b));
        }
    }
    renamed_data(old, new, &mut free, &mut found);
    // A renamed routine may be called by another one.
    while renamed_routines(old, new, &mut free, &mut found) {}
    found
}

/// Pairs with equal keys; those with the same key in their order.
fn by_name<I: Copy, K: Ord>(
    old: &BTreeSet<I>,
    new: &BTreeSet<I>,
    old_key: impl Fn(I) -> K,
    new_key: impl Fn(I) -> K,
) -> Vec<(I, I)> {
    let mut waiting: BTreeMap<K, Vec<I>> = BTreeMap::new();
    for b in new.iter().rev() {
        waiting.entry(new_key(*b)).or_default().push(*b);
    }
    let pair = |a: &I| Some((*a, waiting.get_mut(&old_key(*a))?.pop()?));
    old.iter().filter_map(pair).collect()
}

/// Modules with the same name; among equal names, those at the same place of the order. Two that are
/// the only ones left over correspond.
fn modules(old: &Half<'_>, new: &Half<'_>) -> Vec<(usize, usize)> {
    let mut free: Vec<usize> = (0..new.own).collect();
    let mut pairs = Vec::new();
    let mut left = Vec::new();
    for a in 0..old.own {
        let key = &old.program.modules[a].name.key;
        match free.iter().position(|b| new.program.modules[*b].name.key == *key) {
            Some(at) => pairs.push((a, free.remove(at))),
            None => left.push(a),
        }
    }
    if let ([a], [b]) = (left.as_slice(), free.as_slice()) {
        pairs.push((*a, *b));
    }
    pairs.sort_unstable();
    pairs
}

/// What has no counterpart yet.
struct Free {
    old_routines: BTreeSet<RoutineId>,
    new_routines: BTreeSet<RoutineId>,
    old_data: BTreeSet<DataId>,
    new_data: BTreeSet<DataId>,
}

impl Free {
    fn new(old: &Half<'_>, new: &Half<'_>) -> Free {
        let routines = |half: &Half<'_>| {
            let all = half.program.routines().map(|(id, _)| id);
            all.filter(|id| id.module < half.own).collect()
        };
        let data = |half: &Half<'_>| {
            let modules = half.program.modules.iter().enumerate().take(half.own);
            let ids = |(module, body): (usize, &crate::rapid::ir::hir::Module)| {
                (0..body.data.len()).map(move |index| DataId { module, index })
            };
            modules.flat_map(ids).collect()
        };
        Free {
            old_routines: routines(old),
            new_routines: routines(new),
            old_data: data(old),
            new_data: data(new),
        }
    }

    fn take_routines(&mut self, old: RoutineId, new: RoutineId) {
        self.old_routines.remove(&old);
        self.new_routines.remove(&new);
    }

    fn take_data(&mut self, old: DataId, new: DataId) {
        self.old_data.remove(&old);
        self.new_data.remove(&new);
    }
}

/// Data with another name, the same declaration, and as many uses.
fn renamed_data(old: &Half<'_>, new: &Half<'_>, free: &mut Free, found: &mut Matching) {
    if free.old_data.is_empty() || free.new_data.is_empty() {
        return;
    }
    let (old_uses, new_uses) = (uses(old), uses(new));
    let count = |uses: &BTreeMap<String, usize>, data: &Data| {
        uses.get(&data.name.key).copied().unwrap_or(0)
    };
    let names = Names::default();
    let text = |half: &Half<'_>, data: &Data| {
        let writer = Writer { files: half.files, names: &names };
        // Every name is the name of the type, so that the texts differ only by the rest.
        writer.data(&Data { name: data.type_name.clone(), ..data.clone() })
    };
    let mut waiting: BTreeMap<(String, usize), Vec<DataId>> = BTreeMap::new();
    for b in free.new_data.iter().rev() {
        let data = new.program.data(*b);
        waiting.entry((text(new, data), count(&new_uses, data))).or_default().push(*b);
    }
    for a in free.old_data.clone() {
        let data = old.program.data(a);
        let key = (text(old, data), count(&old_uses, data));
        let Some(b) = waiting.get_mut(&key).and_then(Vec::pop) else { continue };
        free.take_data(a, b);
        found.data.push((a, b));
        let new_name = new.program.data(b).name.key.clone();
        add(&mut found.renames, a.module, data.scope, &data.name.key, new_name);
    }
}

/// Routines with another name and the same text. Returns whether there are any.
fn renamed_routines(old: &Half<'_>, new: &Half<'_>, free: &mut Free, found: &mut Matching) -> bool {
    if free.old_routines.is_empty() || free.new_routines.is_empty() {
        return false;
    }
    let identity = Names::default();
    let mut waiting: BTreeMap<String, Vec<RoutineId>> = BTreeMap::new();
    for b in free.new_routines.iter().rev() {
        let writer = Writer { files: new.files, names: &identity };
        let text = routine_text(&writer, new.program.routine(*b), "");
        waiting.entry(text).or_default().push(*b);
    }
    let none = BTreeMap::new();
    let mut pairs = Vec::new();
    for a in &free.old_routines {
        let routine = old.program.routine(*a);
        let module = &old.program.modules[a.module];
        let local = LocalNames::new(module, a.module, &found.renames);
        let names = Names::of_module(&local, &found.renames).in_routine(routine, &none);
        let text = routine_text(&Writer { files: old.files, names: &names }, routine, "");
        if let Some(b) = waiting.get_mut(&text).and_then(Vec::pop) {
            pairs.push((*a, b));
        }
    }
    for (a, b) in &pairs {
        free.take_routines(*a, *b);
        let (routine, other) = (old.program.routine(*a), new.program.routine(*b));
        add(&mut found.renames, a.module, routine.scope, &routine.name.key, other.name.key.clone());
    }
    found.routines.extend(&pairs);
    !pairs.is_empty()
}

fn add(renames: &mut Renames, module: usize, scope: Scope, old: &str, new: String) {
    let table = match scope {
        Scope::Local => renames.local.entry(module).or_default(),
        Scope::Global | Scope::Task => &mut renames.global,
    };
    table.insert(old.to_owned(), new);
}

/// How often each name is used in statements and values.
pub(super) fn uses(half: &Half<'_>) -> BTreeMap<String, usize> {
    let mut uses: BTreeMap<String, usize> = BTreeMap::new();
    let mut add = |name: &str| *uses.entry(name.to_owned()).or_default() += 1;
    for module in &half.program.modules {
        let data = module.data.iter().flat_map(|data| data.dims.iter().chain(&data.init));
        let routines = module.routines.iter().flat_map(exprs_of);
        data.chain(routines).flat_map(read_names).for_each(&mut add);
        for statement in module.routines.iter().flat_map(Routine::statements) {
            match &statement.kind {
                StmtKind::Call(call) => {
                    if let Callee::Name(name) = &call.callee {
                        add(&name.key);
                    }
                }
                StmtKind::Connect { trap, .. } => add(&trap.key),
                _ => {}
            }
        }
    }
    uses
}

fn exprs_of(routine: &Routine) -> impl Iterator<Item = &Expr> {
    let data = routine.data.iter().flat_map(|data| data.dims.iter().chain(&data.init));
    data.chain(routine.statements().flat_map(|stmt| stmt.kind.exprs()))
}
