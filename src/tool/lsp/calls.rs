//! Who calls whom.

use std::collections::{BTreeMap, BTreeSet};

use gen_lsp_types::{
    CallHierarchyIncomingCall, CallHierarchyItem, CallHierarchyOutgoingCall, Range, SymbolKind,
};

use super::costs::{of_parts, sum};
use super::entity::{Declared, declared, entity};
use super::findings::Analysis;
use super::workspace::View;
use crate::rapid::names::{DeclarationId, Kind, Meaning, Names, Role, RoutineKind};
use crate::rapid::text::{FileId, Span};

/// The routines that the identifier at a byte names.
pub(super) fn prepare(view: View<'_>, byte: u32) -> Vec<CallHierarchyItem> {
    let routines = declared(view, byte).into_iter().filter(|one| is_own_routine(*one));
    routines.map(|one| item(view, one)).collect()
}

/// The calls of the routine at a byte, by the routines that contain them, with what they take in a cycle.
pub(super) fn incoming(
    view: View<'_>,
    analysis: Option<&Analysis>,
    byte: u32,
) -> Vec<CallHierarchyIncomingCall> {
    let Some(entity) = entity(view, byte) else { return Vec::new() };
    let mut callers: BTreeMap<Span, Edge> = BTreeMap::new();
    for (place, role) in entity.uses {
        if !is_call(role) {
            continue;
        }
        let Some(names) = view.project.names_of(place.file).next() else { continue };
        let Some(caller) = routine_at(names, place.file, place.start) else { continue };
        let edge = callers.entry(caller.declaration().name);
        edge.or_insert_with(|| Edge::to(view, caller)).add(place);
    }
    let call = |edge: Edge| {
        let (from, from_ranges) = edge.shown(view, analysis);
        CallHierarchyIncomingCall { from, from_ranges }
    };
    callers.into_values().map(call).collect()
}

/// The routines of a user that the routine at a byte calls, with what the calls take in a cycle.
pub(super) fn outgoing(
    view: View<'_>,
    analysis: Option<&Analysis>,
    byte: u32,
) -> Vec<CallHierarchyOutgoingCall> {
    let mut callees: BTreeMap<Span, Edge> = BTreeMap::new();
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
            let edge = callees.entry(callee.declaration().name);
            let place = Span { start: one.start, end: one.end, ..whole };
            edge.or_insert_with(|| Edge::to(view, callee)).add(place);
        }
    }
    let call = |edge: Edge| {
        let (to, from_ranges) = edge.shown(view, analysis);
        CallHierarchyOutgoingCall { to, from_ranges }
    };
    callees.into_values().map(call).collect()
}

/// The calls between two routines.
struct Edge {
    /// The other routine.
    item: CallHierarchyItem,
    /// The names in the calls.
    places: BTreeSet<Span>,
}

impl Edge {
    fn to(view: View<'_>, routine: Declared<'_>) -> Edge {
        Edge { item: item(view, routine), places: BTreeSet::new() }
    }

    fn add(&mut self, place: Span) {
        self.places.insert(place);
    }

    /// The other routine with what the calls take in a cycle, and the places of the calls.
    fn shown(self, view: View<'_>, analysis: Option<&Analysis>) -> (CallHierarchyItem, Vec<Range>) {
        let Edge { mut item, places } = self;
        let costs = analysis.and_then(|analysis| {
            let number = |place: &Span| {
                let path = &view.project.module(place.file).file.path;
                Some(Span { file: analysis.number_of(path)?, ..*place })
            };
            let mut parts: Vec<Span> = places.iter().map(number).collect::<Option<_>>()?;
            parts.sort();
            sum(of_parts(analysis, &parts).into_iter().flatten())
        });
        if let Some(costs) = costs {
            let module = item.detail.map(|module| format!("{module}, ")).unwrap_or_default();
            item.detail = Some(format!("{module}{costs} a cycle"));
        }
        let range = |place: &Span| view.positions_of(place.file).range(*place);
        (item, places.iter().map(range).collect())
    }
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
