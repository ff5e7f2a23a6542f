//! Who calls whom.

use std::collections::BTreeMap;

use gen_lsp_types::{
    CallHierarchyIncomingCall, CallHierarchyItem, CallHierarchyOutgoingCall, Range, SymbolKind,
};

use super::entity::{Declared, declared, entity};
use super::workspace::View;
use crate::rapid::names::{DeclarationId, Kind, Meaning, Names, Role, RoutineKind};
use crate::rapid::text::{FileId, Span};

/// The routines that the identifier at a byte names.
pub(super) fn prepare(view: View<'_>, byte: u32) -> Vec<CallHierarchyItem> {
    let routines = declared(view, byte).into_iter().filter(|one| is_own_routine(*one));
    routines.map(|one| item(view, one)).collect()
}

/// The calls of the routine at a byte, by the routines that contain them.
pub(super) fn incoming(view: View<'_>, byte: u32) -> Vec<CallHierarchyIncomingCall> {
    let Some(entity) = entity(view, byte) else { return Vec::new() };
    let mut callers: BTreeMap<Span, (CallHierarchyItem, Vec<Range>)> = BTreeMap::new();
    for (place, role) in entity.uses {
        if !is_call(role) {
            continue;
        }
        let Some(names) = view.project.names_of(place.file).next() else { continue };
        let Some(caller) = routine_at(names, place.file, place.start) else { continue };
        let one = || (item(view, caller), Vec::new());
        let (_, ranges) = callers.entry(caller.declaration().name).or_insert_with(one);
        ranges.push(view.positions_of(place.file).range(place));
    }
    let call = |(from, from_ranges)| CallHierarchyIncomingCall { from, from_ranges };
    callers.into_values().map(call).collect()
}

/// The routines of a user that the routine at a byte calls.
pub(super) fn outgoing(view: View<'_>, byte: u32) -> Vec<CallHierarchyOutgoingCall> {
    let mut callees: BTreeMap<Span, (CallHierarchyItem, Vec<Range>)> = BTreeMap::new();
    let Some(caller) = declared(view, byte).into_iter().find(|one| is_own_routine(*one)) else {
        return Vec::new();
    };
    let whole = caller.declaration().whole;
    for names in view.project.names_of(whole.file) {
        for one in names.uses(whole.file) {
            let inside = whole.start <= one.start && one.end <= whole.end;
            let Meaning::Declared(id) = one.meaning else { continue };
            let callee = Declared { names, id };
            if !inside || !is_call(one.role) || !is_own_routine(callee) {
                continue;
            }
            let first = || (item(view, callee), Vec::new());
            let (_, ranges) = callees.entry(callee.declaration().name).or_insert_with(first);
            let place = Span { start: one.start, end: one.end, ..whole };
            let range = view.positions_of(whole.file).range(place);
            if !ranges.contains(&range) {
                ranges.push(range);
            }
        }
    }
    let call = |(to, from_ranges)| CallHierarchyOutgoingCall { to, from_ranges };
    callees.into_values().map(call).collect()
}

fn is_call(role: Role) -> bool {
    matches!(role, Role::Procedure | Role::Function | Role::Trap)
}

fn is_own_routine(one: Declared<'_>) -> bool {
    matches!(one.declaration().kind, Kind::Routine(_)) && !one.names.is_predefined(one.id)
}

/// The routine around a byte.
fn routine_at(names: &Names, file: FileId, byte: u32) -> Option<Declared<'_>> {
    let around = |id: &DeclarationId| {
        let whole = names.declaration(*id).whole;
        whole.file == file && whole.start <= byte && byte < whole.end
    };
    let module = names.modules().find(around)?;
    let id = names.inside(module).find(around)?;
    let one = Declared { names, id };
    is_own_routine(one).then_some(one)
}

fn item(view: View<'_>, one: Declared<'_>) -> CallHierarchyItem {
    let declaration = one.declaration();
    let place = declaration.name;
    let module = one.names.module_of(one.id).map(|id| one.names.declaration(id).name);
    let trap = declaration.kind == Kind::Routine(RoutineKind::Trap);
    let positions = view.positions_of(place.file);
    CallHierarchyItem {
        name: view.project.text(place).into_owned(),
        kind: if trap { SymbolKind::Event } else { SymbolKind::Function },
        tags: None,
        detail: module.map(|name| view.project.text(name).into_owned()),
        uri: view.uri_of(place.file).into(),
        range: positions.range(declaration.whole),
        selection_range: positions.range(place),
        data: None,
    }
}
