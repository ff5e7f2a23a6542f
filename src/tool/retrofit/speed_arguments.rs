//! Arguments that determine the speed of movements.

use std::collections::BTreeMap;

use super::files::Source;
use super::statements::calls;
use crate::rapid::builtins::{MoveForm, movement};
use crate::rapid::ir::hir::{Arg, ArgKind, Expr, ExprKind, Routine};
use crate::rapid::ir::program::Program;
use crate::rapid::text::Span;

/// The speed argument of a movement.
#[derive(Clone)]
pub(super) struct Argument {
    pub(super) span: Span,
    /// The text of a datum; `None` for literal numbers.
    pub(super) datum: Option<String>,
}

/// The speed argument of each movement that has no other argument for its speed.
pub(super) fn speed_arguments(program: &Program, files: &[Source]) -> BTreeMap<Span, Argument> {
    let mut found = BTreeMap::new();
    let routines = program.modules.iter().flat_map(|module| &module.routines);
    for (stmt, name, call) in routines.flat_map(Routine::blocks).flat_map(calls) {
        let Some(signature) = movement(&name.key) else { continue };
        let via = usize::from(signature.form == MoveForm::Circular);
        let mut positional =
            call.args.iter().filter(|arg| matches!(arg.kind, ArgKind::Positional(_)));
        let speed = positional.nth(signature.before + via + 1).and_then(Arg::value);
        let plain = call.args.iter().all(|arg| match &arg.kind {
            ArgKind::Positional(_) => true,
            ArgKind::Optional(name, _) => name.key != "v" && name.key != "t",
            ArgKind::Named(name, _) => name.key == "wobj" || name.key == "z",
            ArgKind::Conditional(..) => false,
        });
        let speed = speed.filter(|_| plain);
        let argument = speed.and_then(|speed| argument(program, files, speed));
        found.extend(argument.map(|argument| (stmt.span, argument)));
    }
    found
}

/// How a speed argument is written; `None` if its text cannot be repeated.
fn argument(program: &Program, files: &[Source], speed: &Expr) -> Option<Argument> {
    let span = speed.span;
    let is_number = |part: &Expr| matches!(part.kind, ExprKind::Num(_));
    let datum = match &speed.kind {
        ExprKind::Aggregate(parts) if parts.iter().all(is_number) => None,
        // Its value depends on the controller.
        ExprKind::Ref(name) if name.key == "vmax" && program.resolve_global("vmax").is_none() => {
            None
        }
        _ if is_datum(speed) => {
            let bytes = &files[span.file.0 as usize].file.bytes;
            let text = std::str::from_utf8(&bytes[span.start as usize..span.end as usize]).ok()?;
            if text.contains(['\r', '\n']) {
                return None;
            }
            Some(text.to_owned())
        }
        _ => return None,
    };
    Some(Argument { span, datum })
}

/// Whether it is a name with components and elements, without calls.
fn is_datum(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Ref(_) => true,
        ExprKind::Field(base, _) => is_datum(base),
        ExprKind::Index(base, indices) => {
            let is_index = |index: &Expr| matches!(index.kind, ExprKind::Num(_)) || is_datum(index);
            is_datum(base) && indices.iter().all(is_index)
        }
        _ => false,
    }
}
