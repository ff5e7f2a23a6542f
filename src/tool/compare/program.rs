//! Changes between two programs.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::canonical::Writer;
use super::change::{Action, Change, Subject};
use super::context::{Context, source};
use super::data::{self, Compared};
use super::declared;
use super::matching::{Matching, matching, uses};
use super::names::{LocalNames, Names, locals};
use super::print::{attributes, header, type_text};
use super::side::Half;
use super::statement::Found;
use super::statements::statements;
use crate::rapid::ir::hir::{Data, Module, Routine, RoutineKind, TypeDef};
use crate::rapid::ir::program::{DataId, RoutineId};
use crate::rapid::text::is_encoded_module;

/// The changes of a program, with the routines that correspond.
pub(super) struct Changes {
    pub(super) list: Vec<Change>,
    /// Number of `PERS` values that differ and are only state.
    pub(super) state: usize,
    /// Names of routines in lower case, old to new.
    pub(super) routines: BTreeMap<String, String>,
}

/// Compares two programs.
pub(super) fn changes(task: &str, old: &Half<'_>, new: &Half<'_>) -> Changes {
    let matching = matching(old, new);
    let uses = uses(new);
    let modules = old.program.modules.iter().enumerate();
    let local: Vec<LocalNames<'_>> =
        modules.map(|(index, module)| LocalNames::new(module, index, &matching.renames)).collect();
    let mut list = List {
        task,
        old,
        new,
        matching: &matching,
        local: &local,
        uses: &uses,
        changes: Vec::new(),
        state: 0,
    };
    list.modules();
    list.data();
    list.routines();
    list.unreadable();
    let (mut changes, state) = (list.changes, list.state);
    changes.sort_by_key(|(order, _)| *order);
    let name = |(old_id, new_id): &(RoutineId, RoutineId)| {
        let key = |half: &Half<'_>, id: RoutineId| half.program.routine(id).name.key.clone();
        (key(old, *old_id), key(new, *new_id))
    };
    Changes {
        list: changes.into_iter().map(|(_, change)| change).collect(),
        state,
        routines: matching.routines.iter().map(name).collect(),
    }
}

/// Where a change stands in the list: module, routine or data, place in it.
type Order = (usize, u8, usize, usize);

struct List<'l> {
    task: &'l str,
    old: &'l Half<'l>,
    new: &'l Half<'l>,
    matching: &'l Matching,
    /// By old module.
    local: &'l [LocalNames<'l>],
    uses: &'l BTreeMap<String, usize>,
    changes: Vec<(Order, Change)>,
    state: usize,
}

impl List<'_> {
    fn add(&mut self, order: Order, module: &str, routine: Option<&str>, found: Found) {
        let Found { subject, action, spans: [old, new], mut message, differences } = found;
        if message.trim().is_empty() {
            // Something is missing in the text.
            "without a name".clone_into(&mut message);
        }
        let change = Change {
            subject,
            action,
            task: self.task.to_owned(),
            module: module.to_owned(),
            routine: routine.map(str::to_owned),
            old,
            new,
            message,
            differences,
        };
        self.changes.push((order, change));
    }

    fn new_module(&self, old: usize) -> Option<usize> {
        let pair = self.matching.modules.iter().find(|(a, _)| *a == old);
        pair.map(|(_, b)| *b)
    }

    /// The place of an old module among the new ones.
    fn module_order(&self, old: usize) -> usize {
        self.new_module(old).unwrap_or(self.new.own + old)
    }

    // --- modules and types ---

    fn modules(&mut self) {
        let (old_half, new_half) = (self.old, self.new);
        for (a, b) in &self.matching.modules {
            let (before, after) = (&old_half.program.modules[*a], &new_half.program.modules[*b]);
            let spans = [Some(before.name.span), Some(after.name.span)];
            let name = after.name.text.as_str();
            if before.name.key != after.name.key {
                let message = format!("module {} → {name}", before.name.text);
                let found = plain(Subject::Module, Action::Renamed, spans, message);
                self.add((*b, 0, 0, 0), name, None, found);
            }
            let [from, to] = [before, after].map(attributes);
            if from != to {
                let shown = |text: &str| match text.trim() {
                    "" => "none".to_owned(),
                    text => text.to_owned(),
                };
                let message = format!("attributes {} → {}", shown(&from), shown(&to));
                let found = plain(Subject::Module, Action::Changed, spans, message);
                self.add((*b, 0, 0, 1), name, None, found);
            }
            self.types(*b, before, after);
        }
        for (index, module) in old_half.program.modules.iter().take(old_half.own).enumerate() {
            if self.new_module(index).is_none() {
                let found = whole(module, Action::Removed);
                self.add((self.module_order(index), 0, 0, 0), &module.name.text, None, found);
            }
        }
        for (index, module) in new_half.program.modules.iter().take(new_half.own).enumerate() {
            if self.matching.modules.iter().all(|(_, b)| *b != index) {
                self.add((index, 0, 0, 0), &module.name.text, None, whole(module, Action::Added));
            }
        }
    }

    fn types(&mut self, order: usize, old: &Module, new: &Module) {
        let name = new.name.text.as_str();
        let mut free: Vec<&TypeDef> = new.types.iter().collect();
        let mut left: Vec<&TypeDef> = Vec::new();
        for before in &old.types {
            match free.iter().position(|after| type_text(after) == type_text(before)) {
                Some(at) => drop(free.remove(at)),
                None => left.push(before),
            }
        }
        for before in left {
            let at = free.iter().position(|after| after.name.key == before.name.key);
            let after = at.map(|at| free.remove(at));
            let (action, message) = match after {
                Some(after) => {
                    (Action::Changed, format!("{} → {}", type_text(before), type_text(after)))
                }
                None => (Action::Removed, type_text(before)),
            };
            let spans = [Some(before.name.span), after.map(|after| after.name.span)];
            self.add((order, 1, 0, 0), name, None, plain(Subject::Type, action, spans, message));
        }
        for after in free {
            let spans = [None, Some(after.name.span)];
            let found = plain(Subject::Type, Action::Added, spans, type_text(after));
            self.add((order, 1, 0, 1), name, None, found);
        }
    }

    // --- data of modules ---

    fn data(&mut self) {
        let (old_half, new_half) = (self.old, self.new);
        for (a, b) in &self.matching.data {
            let (before, after) = (old_half.program.data(*a), new_half.program.data(*b));
            let module = new_half.program.modules[b.module].name.text.as_str();
            let order = (b.module, 2, b.index, 0);
            if before.name.key != after.name.key {
                self.add(order, module, None, data::renamed(before, after));
            }
            if self.new_module(a.module) != Some(b.module) {
                let from = &old_half.program.modules[a.module].name.text;
                let spans = [Some(before.span), Some(after.span)];
                let message = format!("{} from module {from} to {module}", after.name.text);
                let subject = data::subject(&after.type_name.key);
                self.add(order, module, None, plain(subject, Action::Moved, spans, message));
            }
            let names = Names::of_module(&self.local[a.module], &self.matching.renames);
            let context = Context {
                old: old_half,
                new: new_half,
                modules: [a.module, b.module],
                names: &names,
                locals: [BTreeSet::new(), BTreeSet::new()],
            };
            match data::compare(&context, before, after) {
                Compared::Same => {}
                Compared::State => self.state += 1,
                Compared::Changed(mut found) => {
                    if let Some(count @ 2..) = self.uses.get(&after.name.key) {
                        let _ = write!(found.message, ", used {count} times");
                    }
                    self.add(order, module, None, found);
                }
            }
        }
        let olds: BTreeSet<DataId> = self.matching.data.iter().map(|(a, _)| *a).collect();
        let news: BTreeSet<DataId> = self.matching.data.iter().map(|(_, b)| *b).collect();
        let paired: BTreeSet<usize> = self.matching.modules.iter().map(|(_, b)| *b).collect();
        for (a, b) in &self.matching.modules {
            let module = new_half.program.modules[*b].name.text.as_str();
            for (index, data) in old_half.program.modules[*a].data.iter().enumerate() {
                if !olds.contains(&DataId { module: *a, index }) {
                    let found = data::alone(old_half.files, data, Action::Removed);
                    self.add((*b, 2, index, 1), module, None, found);
                }
            }
        }
        for b in paired {
            let module = &new_half.program.modules[b];
            for (index, data) in module.data.iter().enumerate() {
                if !news.contains(&DataId { module: b, index }) {
                    let found = data::alone(new_half.files, data, Action::Added);
                    self.add((b, 2, index, 1), &module.name.text, None, found);
                }
            }
        }
    }

    // --- routines ---

    fn routines(&mut self) {
        let (old_half, new_half) = (self.old, self.new);
        for (a, b) in &self.matching.routines {
            self.routine(*a, *b);
        }
        let olds: BTreeSet<RoutineId> = self.matching.routines.iter().map(|(a, _)| *a).collect();
        let news: BTreeSet<RoutineId> = self.matching.routines.iter().map(|(_, b)| *b).collect();
        for (a, b) in &self.matching.modules {
            let module = new_half.program.modules[*b].name.text.as_str();
            for (index, routine) in old_half.program.modules[*a].routines.iter().enumerate() {
                if !olds.contains(&RoutineId { module: *a, index }) {
                    let found = alone(routine, Action::Removed);
                    self.add((*b, 3, index, 0), module, Some(&routine.name.text), found);
                }
            }
            for (index, routine) in new_half.program.modules[*b].routines.iter().enumerate() {
                if !news.contains(&RoutineId { module: *b, index }) {
                    let found = alone(routine, Action::Added);
                    self.add((*b, 3, index, 0), module, Some(&routine.name.text), found);
                }
            }
        }
    }

    fn routine(&mut self, a: RoutineId, b: RoutineId) {
        let (old_half, new_half) = (self.old, self.new);
        let (before, after) = (old_half.program.routine(a), new_half.program.routine(b));
        let module = new_half.program.modules[b.module].name.text.as_str();
        let name = Some(after.name.text.as_str());
        let spans = [Some(before.name.span), Some(after.name.span)];
        let order = |place: usize| (b.module, 3, b.index, place);
        if before.name.key != after.name.key {
            let message = format!("{} → {}", before.name.text, after.name.text);
            let found = plain(Subject::Routine, Action::Renamed, spans, message);
            self.add(order(0), module, name, found);
        }
        if self.new_module(a.module) != Some(b.module) {
            let from = &old_half.program.modules[a.module].name.text;
            let message = format!("{} from module {from} to {module}", after.name.text);
            let found = plain(Subject::Routine, Action::Moved, spans, message);
            self.add(order(0), module, name, found);
        }
        let renamed = renamed_locals(before, after);
        let names = Names::of_module(&self.local[a.module], &self.matching.renames)
            .in_routine(before, &renamed);
        let identity = Names::default();
        let old_writer = Writer { files: old_half.files, names: &names };
        let new_writer = Writer { files: new_half.files, names: &identity };
        let [from, to] = [header(&old_writer, before), header(&new_writer, after)];
        if from != to {
            let found = plain(Subject::Routine, Action::Changed, spans, format!("{from} → {to}"));
            self.add(order(1), module, name, found);
        }
        let context = Context {
            old: old_half,
            new: new_half,
            modules: [a.module, b.module],
            names: &names,
            locals: [locals(before), locals(after)],
        };
        for found in local_data(&context, before, after, &renamed) {
            self.add(order(2), module, name, found);
        }
        for (index, found) in statements(&context, before, after).into_iter().enumerate() {
            self.add(order(3 + index), module, name, found);
        }
    }

    // --- text that cannot be read ---

    fn unreadable(&mut self) {
        let mut free: Vec<_> = self.new.unread.clone();
        for text in self.old.unread.clone() {
            if let Some(at) = free.iter().position(|other| other.words == text.words) {
                free.remove(at);
                continue;
            }
            let found = plain(
                Subject::Unreadable,
                Action::Removed,
                [Some(text.span), None],
                shown(self.old, text.span),
            );
            self.add((usize::MAX, 0, 0, 0), "", None, found);
        }
        for text in free {
            let found = plain(
                Subject::Unreadable,
                Action::Added,
                [None, Some(text.span)],
                shown(self.new, text.span),
            );
            self.add((usize::MAX, 0, 0, 1), "", None, found);
        }
    }
}

fn shown(half: &Half<'_>, span: crate::rapid::text::Span) -> String {
    match half.files.get(span.file.0 as usize) {
        Some(file) if is_encoded_module(&file.bytes) => "an encoded module".to_owned(),
        _ => source(half.files, span),
    }
}

/// The changes of the data that a routine declares.
fn local_data(
    context: &Context<'_>,
    old: &Routine,
    new: &Routine,
    renamed: &BTreeMap<String, String>,
) -> Vec<Found> {
    let mut free: Vec<&Data> = declared::data(new).collect();
    let mut found = Vec::new();
    for before in declared::data(old) {
        let name = renamed.get(&before.name.key).unwrap_or(&before.name.key);
        let Some(at) = free.iter().position(|data| data.name.key == *name) else {
            found.push(data::alone(context.old.files, before, Action::Removed));
            continue;
        };
        let after = free.remove(at);
        if before.name.key != after.name.key {
            found.push(data::renamed(before, after));
        }
        if let Compared::Changed(change) = data::compare(context, before, after) {
            found.push(change);
        }
    }
    found.extend(free.into_iter().map(|data| data::alone(context.new.files, data, Action::Added)));
    found
}

/// Names of a routine that have another name in the new one: parameters by their place, data by their
/// declaration.
fn renamed_locals(old: &Routine, new: &Routine) -> BTreeMap<String, String> {
    let mut renamed = BTreeMap::new();
    let same_params = old.params.len() == new.params.len()
        && old.params.iter().zip(&new.params).all(|(a, b)| {
            a.mode == b.mode && a.optional == b.optional && a.type_name.key == b.type_name.key
        });
    let (known_old, known_new) = (locals(old), locals(new));
    if same_params {
        for (a, b) in old.params.iter().zip(&new.params) {
            if a.name.key != b.name.key
                && !known_new.contains(a.name.key.as_str())
                && !known_old.contains(b.name.key.as_str())
            {
                renamed.insert(a.name.key.clone(), b.name.key.clone());
            }
        }
    }
    let is_alike = |a: &Data, b: &Data| {
        a.kind == b.kind && a.type_name.key == b.type_name.key && a.dims.len() == b.dims.len()
    };
    let mut free: Vec<&Data> =
        declared::data(new).filter(|data| !known_old.contains(data.name.key.as_str())).collect();
    for data in declared::data(old).filter(|data| !known_new.contains(data.name.key.as_str())) {
        let uses = |routine: &Routine, key: &str| {
            let exprs = routine.statements().flat_map(|stmt| stmt.kind.exprs());
            exprs.flat_map(super::context::read_names).filter(|name| *name == key).count()
        };
        let count = uses(old, &data.name.key);
        let to = free
            .iter()
            .position(|other| is_alike(data, other) && uses(new, &other.name.key) == count);
        if let Some(at) = to {
            renamed.insert(data.name.key.clone(), free.remove(at).name.key.clone());
        }
    }
    renamed
}

fn plain(
    subject: Subject,
    action: Action,
    spans: [Option<crate::rapid::text::Span>; 2],
    message: String,
) -> Found {
    Found { subject, action, spans, message, differences: Vec::new() }
}

fn one_sided(
    span: crate::rapid::text::Span,
    action: Action,
) -> [Option<crate::rapid::text::Span>; 2] {
    if action == Action::Removed { [Some(span), None] } else { [None, Some(span)] }
}

/// A module that only one side has.
fn whole(module: &Module, action: Action) -> Found {
    let count = |count: usize, what: &str| match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    };
    let message = format!(
        "module {} with {} and {} of data",
        module.name.text,
        count(module.routines.len(), "routine"),
        count(module.data.len(), "declaration"),
    );
    plain(Subject::Module, action, one_sided(module.name.span, action), message)
}

/// A routine that only one side has.
fn alone(routine: &Routine, action: Action) -> Found {
    let kind = match routine.kind {
        RoutineKind::Proc => "PROC",
        RoutineKind::Func => "FUNC",
        RoutineKind::Trap => "TRAP",
    };
    let statements = routine.statements().count();
    let message = format!("{kind} {} with {statements} statements", routine.name.text);
    plain(Subject::Routine, action, one_sided(routine.name.span, action), message)
}
