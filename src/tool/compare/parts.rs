//! The arguments of a statement by what they are for.

use crate::rapid::builtins::{self, MoveForm};
use crate::rapid::ir::hir::{Arg, ArgKind, Call, Callee, Expr, Stmt, StmtKind};

/// What an argument is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role<'a> {
    /// Where a movement goes.
    Target,
    /// The point on the way of a circle.
    Via,
    Speed,
    Zone,
    Tool,
    /// Another argument, by its number among the positional ones.
    Position(usize),
    /// An argument with a name, in lower case.
    Name(&'a str),
}

/// An argument.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part<'a> {
    pub(super) role: Role<'a>,
    /// Its value; none for a switch.
    pub(super) value: Option<&'a Expr>,
}

impl Role<'_> {
    /// Whether it tells which of several equal instructions this is.
    pub(super) fn is_identity(self) -> bool {
        matches!(self, Role::Target | Role::Position(0))
    }
}

/// The arguments of a call or the sides of an assignment.
pub(super) fn parts(stmt: &Stmt) -> Vec<Part<'_>> {
    match &stmt.kind {
        StmtKind::Call(call) => of_call(call),
        StmtKind::Assign { target, value } => {
            let part = |(index, value)| Part { role: Role::Position(index), value: Some(value) };
            [target, value].into_iter().enumerate().map(part).collect()
        }
        _ => Vec::new(),
    }
}

fn of_call(call: &Call) -> Vec<Part<'_>> {
    let roles = match &call.callee {
        Callee::Name(name) => roles(&name.key),
        Callee::Late(_) => Vec::new(),
    };
    let mut position = 0;
    let mut found = Vec::with_capacity(call.args.len());
    for Arg { kind, .. } in &call.args {
        found.push(match kind {
            ArgKind::Positional(value) => {
                let known = roles.iter().find(|(index, _)| *index == position);
                let role = known.map_or(Role::Position(position), |(_, role)| *role);
                position += 1;
                Part { role, value: Some(value) }
            }
            ArgKind::Named(name, value) | ArgKind::Conditional(name, value) => {
                Part { role: Role::Name(&name.key), value: Some(value) }
            }
            ArgKind::Optional(name, value) => {
                Part { role: Role::Name(&name.key), value: value.as_ref() }
            }
        });
    }
    found
}

/// The positions of the arguments of a movement.
fn roles(instruction: &str) -> Vec<(usize, Role<'static>)> {
    let Some(signature) = builtins::movement(instruction) else { return Vec::new() };
    let mut roles = Vec::new();
    let mut at = signature.before;
    if signature.form == MoveForm::Circular {
        roles.push((at, Role::Via));
        at += 1;
    }
    roles.extend([(at, Role::Target), (at + 1, Role::Speed)]);
    at += 2 + signature.between;
    if signature.zone {
        roles.push((at, Role::Zone));
        at += 1;
    }
    if signature.form != MoveForm::ExternalJoint {
        roles.push((at, Role::Tool));
    }
    roles
}
