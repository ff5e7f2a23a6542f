//! Names that nothing declares.
//!
//! Labels and components are declared in the given text or not at all. Other names may be declared
//! elsewhere: in another module, or in the controller (signals, mechanical units). Such a name is
//! reported once: as an error where it is a visible name of the program with a typing error, else as a
//! warning. Even the backup of a whole task lacks modules that options install.

use std::collections::{BTreeMap, BTreeSet};

use super::context::{Context, Extent, Place};
use super::fault::{error, warning};
use super::parameters::call;
use super::suggest::{is_slip, nearest};
use super::types::{Type, is_basic, stated};
use crate::rapid::builtins;
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{Basic, Kind, Meaning, Role, Use};
use crate::rapid::syntax::{NodeKind, TokenKind};
use crate::rapid::text::{FileId, SourceFile, Span};

/// Number of unknown names for which similar ones are looked for, so that a large file full of
/// unknown names is checked in time.
const SUGGESTIONS: usize = 200;

/// Starts of the names that programmers give to signals.
const SIGNALS: [&str; 6] = ["ai", "ao", "di", "do", "gi", "go"];

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    let outside = Outside::new(context);
    let mut seen: BTreeMap<String, (Span, Role, usize)> = BTreeMap::new();
    for source in context.task.files {
        let uses = context.names.uses(source.file.id).iter();
        for one in uses.filter(|one| one.meaning == Meaning::Unknown) {
            let span = Span { file: source.file.id, start: one.start, end: one.end };
            let name = source.file.text(span).into_owned();
            match one.role {
                Role::Label => out.push(error(
                    "unknown-name",
                    span,
                    format!("unknown label: this routine has no label {name}"),
                    format!("write {name}: before the statement to go to"),
                )),
                Role::Component => out.push(component(source.file, one, &name)),
                Role::Argument => {}
                _ => {
                    let entry = seen.entry(name.to_lowercase()).or_insert((span, one.role, 0));
                    entry.2 += 1;
                }
            }
        }
    }
    seen.retain(|key, (span, ..)| !outside.declares(context, key, *span));
    for (number, (key, (span, role, count))) in seen.into_iter().enumerate() {
        let unknown = UnknownName { key, span, role, count };
        let own = if number < SUGGESTIONS { candidates(context, span, role) } else { Vec::new() };
        out.push(global(context, &unknown, &own));
    }
}

/// A name that nothing declares.
struct UnknownName {
    /// In lower case.
    key: String,
    /// Its first use.
    span: Span,
    role: Role,
    /// The number of its uses.
    count: usize,
}

fn component(file: &SourceFile, one: &Use, name: &str) -> Diagnostic {
    let span = Span { file: file.id, start: one.start, end: one.end };
    let message = format!("unknown component: the value before the dot has no component {name}");
    error("unknown-name", span, message, "name a component of its type".to_owned())
}

fn global(context: &Context<'_>, unknown: &UnknownName, own: &[String]) -> Diagnostic {
    let UnknownName { key, span, role, count } = unknown;
    let span = *span;
    let file = context.task.files.iter().find(|source| source.file.id == span.file);
    let name = file.map_or_else(|| key.clone(), |source| source.file.text(span).into_owned());
    let kind = match role {
        Role::Type => "type",
        Role::Procedure => "procedure",
        Role::Function => "function",
        Role::Trap => "TRAP",
        _ => "name",
    };
    let more = match count {
        1 => String::new(),
        count => format!(" ({count} uses)"),
    };
    let near = nearest(key, own.iter().map(String::as_str));
    // A routine of a user may have a name like a predefined one.
    let slip = near.is_some_and(|near| is_slip(key, near));
    let is_called = matches!(role, Role::Procedure | Role::Function);
    let near = near.or_else(|| nearest(key, builtins::routine_names().filter(|_| is_called)));
    let help = match near {
        Some(near) => format!("did you mean {near}?"),
        None => "correct the name, or give the module that declares it, too".to_owned(),
    };
    let (where_from, elsewhere) = match context.task.extent {
        Extent::All(_) => ("no module of the task", "an installed module may"),
        Extent::Task | Extent::Program | Extent::Some => ("no given file", "another module may"),
    };
    let message = format!("unknown {kind}: {where_from} declares {name}{more}");
    if slip && *context.task.extent != Extent::Some {
        return error("unknown-name", span, message, help);
    }
    warning("unknown-name", span, format!("{message}; {elsewhere}"), help)
}

/// The names of the task that could be meant at a place.
fn candidates(context: &Context<'_>, span: Span, role: Role) -> Vec<String> {
    let names = &context.names;
    let fits = |kind: Kind| match role {
        Role::Type => matches!(kind, Kind::Record | Kind::Alias | Kind::Basic(_)),
        Role::Procedure | Role::Function | Role::Trap => matches!(kind, Kind::Routine(_)),
        _ => matches!(kind, Kind::Data(_) | Kind::Parameter(_) | Kind::Counter),
    };
    let visible = names.visible(span.file, span.start).into_iter();
    let own = visible.filter(|id| fits(names.declaration(*id).kind));
    let own = own.map(|id| context.name(names.declaration(id)));
    let controller = match context.task.extent {
        Extent::All(names) if role == Role::Value => names.clone(),
        _ => Vec::new(),
    };
    own.chain(controller).collect()
}

/// What the controller declares, as far as it is known or the program shows it.
struct Outside {
    /// In lower case.
    signals: BTreeSet<String>,
    /// Names that are used elsewhere than where a name of the controller can stand.
    others: BTreeSet<String>,
}

impl Outside {
    fn new(context: &Context<'_>) -> Outside {
        let mut outside = Outside { signals: BTreeSet::new(), others: BTreeSet::new() };
        let mut open: BTreeSet<(FileId, u32)> = BTreeSet::new();
        for place in context.nodes() {
            match place.kind() {
                NodeKind::CallStatement | NodeKind::FunctionCall => {
                    outside.call(context, place, &mut open);
                }
                NodeKind::BinaryExpression => levels(place, &mut open),
                _ => {}
            }
        }
        for source in context.task.files {
            let id = source.file.id;
            for one in context.names.uses(id) {
                let free = one.meaning == Meaning::Unknown && !open.contains(&(id, one.start));
                if free {
                    let span = Span { file: id, start: one.start, end: one.end };
                    outside.others.insert(source.file.text(span).to_lowercase());
                }
            }
        }
        outside
    }

    /// Signals are arguments of routines that take signals. The first argument of a routine with
    /// unknown parameters may be a mechanical unit.
    fn call(
        &mut self,
        context: &Context<'_>,
        place: Place<'_>,
        open: &mut BTreeSet<(FileId, u32)>,
    ) {
        let Some((callee, arguments)) = call(place) else { return };
        let name = callee.text().to_lowercase();
        let declared = context.declared(callee);
        let first_is_signal = declared.is_none()
            && (builtins::instruction(&name).is_some_and(|known| known.signal().is_some())
                || builtins::function(&name).is_some_and(|known| known.signal().is_some()));
        let positional = arguments.iter().filter(|one| !one.is_optional());
        for (index, argument) in positional.enumerate() {
            let Some(value) = argument.value.filter(|one| one.kind() == NodeKind::Reference) else {
                continue;
            };
            let of_parameter = declared.is_some_and(|id| takes_signal(context, id, index));
            if of_parameter || first_is_signal && index == 0 {
                self.signals.insert(value.text().to_lowercase());
            } else if declared.is_none() && index == 0 {
                open.insert((value.file.id, value.node.range().start));
            }
        }
        let optional = arguments.iter().filter(|one| one.is_optional() && declared.is_none());
        for value in optional.filter_map(|one| one.value) {
            open.insert((value.file.id, value.node.range().start));
        }
    }

    fn declares(&self, context: &Context<'_>, key: &str, span: Span) -> bool {
        if let Extent::All(names) = context.task.extent {
            return names.iter().any(|name| name == key);
        }
        let file = context.task.files.iter().find(|source| source.file.id == span.file);
        let is_named_so = file.is_some_and(|source| is_named_as_signal(&source.file.text(span)));
        self.signals.contains(key) || !self.others.contains(key) || is_named_so
    }
}

/// `diPart`, `DI_PART`, `di1`
fn is_named_as_signal(name: &str) -> bool {
    let (start, rest) = (name.get(..2), name.get(2..).and_then(|rest| rest.chars().next()));
    let (Some(start), Some(third)) = (start, rest) else { return false };
    let is_start = SIGNALS.contains(&start.to_lowercase().as_str());
    let is_word = start.ends_with(char::is_uppercase);
    is_start && (third == '_' || third.is_numeric() || third.is_uppercase() && !is_word)
}

/// Whether the required parameter with this number is a signal.
fn takes_signal(
    context: &Context<'_>,
    routine: crate::rapid::names::DeclarationId,
    index: usize,
) -> bool {
    let required = super::parameters::parameters(context, routine);
    let parameter = required.iter().filter(|one| one.group.is_none()).nth(index);
    parameter.is_some_and(|one| {
        let ty = stated(&context.names, context.names.declaration(one.id).value);
        matches!(ty, Type::Of(base, _) if is_basic(&context.names, base, &[Basic::SemiValue]))
    })
}

/// `di1 = 1`: a name that is compared with a level may be a signal.
fn levels(place: Place<'_>, open: &mut BTreeSet<(FileId, u32)>) {
    let mut sides = place.children();
    let (Some(left), Some(right)) = (sides.next(), sides.next()) else { return };
    let compares = place
        .node
        .own_tokens()
        .any(|token| matches!(token.kind(), TokenKind::Equal | TokenKind::NotEqual));
    let is_level =
        |side: Place<'_>| matches!(side.text().to_lowercase().as_str(), "0" | "1" | "high" | "low");
    for (name, level) in [(left, right), (right, left)] {
        if compares && name.kind() == NodeKind::Reference && is_level(level) {
            open.insert((name.file.id, name.node.range().start));
        }
    }
}
