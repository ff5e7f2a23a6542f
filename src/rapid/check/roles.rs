//! Names that are used as what they are not: a function as a statement, a procedure in an
//! expression, a TRAP that is called.

use super::context::{Context, Extent};
use super::fault::{error, with_place};
use crate::rapid::builtins;
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{Kind, Meaning, Role, RoutineKind, Use};
use crate::rapid::text::{SourceFile, Span};

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    for source in context.task.files {
        for one in context.names.uses(source.file.id) {
            match one.meaning {
                Meaning::Declared(id) => {
                    let kind = context.names.declaration(id).kind;
                    // A module that is not given may declare the name, and hide the predefined one.
                    let hidden =
                        context.names.is_predefined(id) && *context.task.extent == Extent::Some;
                    if hidden {
                        continue;
                    }
                    if let Some((is, help)) = misuse(one.role, kind) {
                        let finding = wrong(source.file, one, is, help);
                        let declared = context.names.declaration(id).name;
                        out.push(if context.names.is_predefined(id) {
                            finding
                        } else {
                            with_place(finding, declared, "declared here")
                        });
                    }
                }
                Meaning::Known if *context.task.extent != Extent::Some => {
                    let name = text(source.file, one).to_lowercase();
                    let function = builtins::function(&name).is_some();
                    let instruction = builtins::instruction(&name).is_some();
                    let kind = match (function, instruction) {
                        (true, false) => RoutineKind::Func,
                        (false, true) => RoutineKind::Proc,
                        _ => continue,
                    };
                    if let Some((is, help)) = misuse(one.role, Kind::Routine(kind)) {
                        out.push(wrong(source.file, one, is, help));
                    }
                }
                _ => {}
            }
        }
    }
}

fn text(file: &SourceFile, one: &Use) -> String {
    file.text(Span { file: file.id, start: one.start, end: one.end }).into_owned()
}

fn wrong(file: &SourceFile, one: &Use, is: &str, help: &str) -> Diagnostic {
    let span = Span { file: file.id, start: one.start, end: one.end };
    let message = format!("{} is {is}", text(file, one));
    error("use", span, message, help.to_owned())
}

/// What a name is that does not fit its place, and the way out.
fn misuse(role: Role, kind: Kind) -> Option<(&'static str, &'static str)> {
    match (role, kind) {
        (Role::Procedure, Kind::Routine(RoutineKind::Func)) => {
            Some(("a function, its value is not used", "assign its value: x := …"))
        }
        (Role::Procedure | Role::Function, Kind::Routine(RoutineKind::Trap)) => Some((
            "a TRAP and cannot be called",
            "make it a PROC, or connect an interrupt to it: CONNECT … WITH …",
        )),
        (Role::Function, Kind::Routine(RoutineKind::Proc)) => {
            Some(("a procedure and has no value", "call it in a statement of its own"))
        }
        (Role::Trap, Kind::Routine(RoutineKind::Proc | RoutineKind::Func)) => {
            Some(("no TRAP", "declare the routine of the interrupt as TRAP"))
        }
        (
            Role::Procedure | Role::Function | Role::Trap,
            Kind::Data(_) | Kind::Parameter(_) | Kind::Counter,
        ) => Some(("no routine", "an index stands in braces: a{1}")),
        (Role::Value, Kind::Routine(RoutineKind::Func)) => {
            Some(("a function, its arguments are missing", "write its arguments in parentheses"))
        }
        (Role::Value, Kind::Routine(_)) => Some(("a routine and has no value", "name data here")),
        (Role::Value, Kind::Record | Kind::Alias | Kind::Basic(_)) => {
            Some(("a type and has no value", "name data of this type"))
        }
        _ => None,
    }
}
