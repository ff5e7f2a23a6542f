//! What changed in one statement.

use super::change::{Action, Subject};
use super::context::{Context, Reworded, source};
use super::exact::exprs;
use super::node::{Label, Node};
use super::parts::{Part, Role};
use super::values::Difference;
use crate::rapid::builtins::{self, Effect, Instruction, Setting, Wait};
use crate::rapid::ir::hir::{Callee, Expr, Stmt, StmtKind};
use crate::rapid::text::{SourceFile, Span};

/// A change of a statement.
pub(super) struct Found {
    pub(super) subject: Subject,
    pub(super) action: Action,
    /// Old and new.
    pub(super) spans: [Option<Span>; 2],
    pub(super) message: String,
    pub(super) differences: Vec<Difference>,
}

/// What a statement is about.
pub(super) fn subject(label: &Label<'_>) -> Subject {
    let Label::Statement(stmt) = label else { return Subject::ControlFlow };
    match &stmt.kind {
        StmtKind::Call(call) => match &call.callee {
            Callee::Name(name) => {
                builtins::instruction(&name.key).map_or(Subject::Call, of_instruction)
            }
            Callee::Late(_) => Subject::Call,
        },
        StmtKind::Assign { .. } => Subject::Data,
        StmtKind::Broken => Subject::Unreadable,
        _ => Subject::ControlFlow,
    }
}

fn of_instruction(instruction: &Instruction) -> Subject {
    if instruction.is_movement() {
        return Subject::Movement;
    }
    match instruction.effect {
        Effect::Wait(_) => Subject::Wait,
        Effect::Output(_) | Effect::ZoneOutput => Subject::Output,
        Effect::Setting(Setting::GripLoad) => Subject::Load,
        Effect::Setting(_) | Effect::Unmodelled | Effect::Ends(_) => Subject::Setting,
        Effect::Count(_) => Subject::Data,
        Effect::Stop | Effect::ExitCycle => Subject::ControlFlow,
        Effect::Nothing | Effect::FindsByName if instruction.changes_motion => Subject::Setting,
        Effect::Nothing | Effect::FindsByName => Subject::Call,
    }
}

/// What an argument is about, and the type that it has to have.
fn of_part(instruction: Option<&Instruction>, role: Role<'_>) -> (Subject, &'static str) {
    let Some(instruction) = instruction else { return (Subject::Call, "") };
    if !instruction.is_movement() {
        let of_all = of_instruction(instruction);
        let is_input = instruction.effect == Effect::Wait(Wait::Input);
        return match role {
            Role::Position(0 | 1) if is_input => (Subject::Input, ""),
            Role::Position(_) if of_all == Subject::Load => (of_all, "loaddata"),
            _ => (of_all, ""),
        };
    }
    match role {
        Role::Target | Role::Via => (Subject::Target, ""),
        Role::Speed => (Subject::Speed, "speeddata"),
        Role::Name("v" | "t") => (Subject::Speed, "num"),
        Role::Zone => (Subject::Zone, "zonedata"),
        Role::Name("z") => (Subject::Zone, "num"),
        Role::Name("inpos") => (Subject::Zone, "stoppointdata"),
        Role::Tool => (Subject::Tool, "tooldata"),
        Role::Name("wobj") => (Subject::WorkObject, "wobjdata"),
        Role::Name("tload") => (Subject::Load, "loaddata"),
        Role::Position(_) => (Subject::Output, ""),
        Role::Name(_) => (Subject::Movement, ""),
    }
}

/// The type of the target of a movement.
fn target_type(instruction: &Instruction) -> &'static str {
    use crate::rapid::builtins::MoveForm::{AbsJ, ExternalJoint};
    match instruction.movement().map(|signature| signature.form) {
        Some(AbsJ | ExternalJoint) => "jointtarget",
        _ => "robtarget",
    }
}

/// The changes of a statement or of the header of a block; empty if both mean the same.
pub(super) fn changed(context: &Context<'_>, old: &Node<'_>, new: &Node<'_>) -> Vec<Found> {
    let spans = [Some(old.span), Some(new.span)];
    let found = |subject, message, differences| Found {
        subject,
        action: Action::Changed,
        spans,
        message,
        differences,
    };
    if let (Label::Statement(before), Label::Statement(after)) = (old.label, new.label)
        && let (StmtKind::Call(a), StmtKind::Call(b)) = (&before.kind, &after.kind)
        && let (Callee::Name(a), Callee::Name(b)) = (&a.callee, &b.callee)
    {
        let instruction = builtins::instruction(&b.key);
        if context.names.of(&a.key) != b.key {
            if instruction.is_none() || builtins::instruction(&a.key).is_none() {
                return vec![found(
                    subject(&new.label),
                    both(context, old.span, new.span),
                    Vec::new(),
                )];
            }
            let mut changes = arguments(context, instruction, old, new);
            let message = format!("{}: {} → {}", head(context.new.files, after), a.text, b.text);
            changes.insert(0, found(subject(&new.label), message, Vec::new()));
            return changes;
        }
        return arguments(context, instruction, old, new);
    }
    if let (Label::Statement(before), Label::Statement(after)) = (old.label, new.label)
        && let (
            StmtKind::Assign { target: a, value: from },
            StmtKind::Assign { target: b, value: to },
        ) = (&before.kind, &after.kind)
        && context.reworded("", a, b).is_none()
    {
        let reworded = context.reworded("", from, to);
        return reworded.map_or_else(Vec::new, |Reworded { message, differences }| {
            let target = source(context.new.files, b.span);
            vec![found(Subject::Data, format!("{target} := {message}"), differences)]
        });
    }
    let message = if old.label.is_block() {
        let before = headline(context.old.files, &old.label);
        let after = headline(context.new.files, &new.label);
        format!("{before} → {after}")
    } else {
        both(context, old.span, new.span)
    };
    if is_same_value(context, &old.label, &new.label) {
        return Vec::new();
    }
    vec![found(subject(&new.label), message, Vec::new())]
}

/// Whether only the text of conditions or values differs, not what they mean.
fn is_same_value(context: &Context<'_>, old: &Label<'_>, new: &Label<'_>) -> bool {
    let (before, after) = (exprs(old), exprs(new));
    let is_same_loop = match (variable(old), variable(new)) {
        (Some(old), Some(new)) => old == new,
        (None, None) => true,
        _ => false,
    };
    !before.is_empty()
        && before.len() == after.len()
        && old.word() == new.word()
        && is_same_loop
        && before.iter().zip(&after).all(|(old, new)| context.reworded("", old, new).is_none())
}

/// The loop variable, or the trap that is connected.
fn variable<'a>(label: &Label<'a>) -> Option<&'a str> {
    match label {
        Label::Statement(Stmt { kind: StmtKind::For { var, .. }, .. }) => Some(&var.key),
        Label::Statement(Stmt { kind: StmtKind::Connect { trap, .. }, .. }) => Some(&trap.key),
        _ => None,
    }
}

fn arguments(
    context: &Context<'_>,
    instruction: Option<&Instruction>,
    old: &Node<'_>,
    new: &Node<'_>,
) -> Vec<Found> {
    let Label::Statement(stmt) = new.label else { return Vec::new() };
    let mut changes = Vec::new();
    let mut add = |role: Role<'_>, text: String, differences| {
        let (subject, _) = of_part(instruction, role);
        let name = role_name(instruction, role);
        let message = format!("{}: {name} {text}", head(context.new.files, stmt));
        changes.push(Found {
            subject,
            action: Action::Changed,
            spans: [Some(old.span), Some(new.span)],
            message,
            differences,
        });
    };
    let is_in =
        |parts: &[(Part<'_>, u32)], role: Role<'_>| parts.iter().any(|(p, _)| p.role == role);
    for (part, _) in &old.parts {
        let other = new.parts.iter().find(|(other, _)| other.role == part.role);
        match (part.value, other) {
            (_, None) => add(part.role, without(context.old.files, part), Vec::new()),
            (Some(before), Some((Part { value: Some(after), .. }, _))) => {
                let ty = match (part.role, instruction) {
                    (Role::Target | Role::Via, Some(instruction)) => target_type(instruction),
                    _ => of_part(instruction, part.role).1,
                };
                if let Some(Reworded { message, differences }) = context.reworded(ty, before, after)
                {
                    add(part.role, message, differences);
                }
            }
            (None, Some((Part { value: None, .. }, _))) => {}
            (before, Some((other, _))) => {
                let text = |files: &[SourceFile], value: Option<&Expr>| {
                    value.map_or_else(|| "no value".to_owned(), |value| source(files, value.span))
                };
                let (before, after) =
                    (text(context.old.files, before), text(context.new.files, other.value));
                add(part.role, format!("{before} → {after}"), Vec::new());
            }
        }
    }
    for (part, _) in new.parts.iter().filter(|(part, _)| !is_in(&old.parts, part.role)) {
        add(part.role, with(context.new.files, part), Vec::new());
    }
    changes
}

fn without(files: &[SourceFile], part: &Part<'_>) -> String {
    match part.value {
        Some(value) => format!("{} → none", source(files, value.span)),
        None => "is left out".to_owned(),
    }
}

fn with(files: &[SourceFile], part: &Part<'_>) -> String {
    match part.value {
        Some(value) => format!("none → {}", source(files, value.span)),
        None => "is added".to_owned(),
    }
}

fn role_name(instruction: Option<&Instruction>, role: Role<'_>) -> String {
    match role {
        Role::Target => "target".to_owned(),
        Role::Via => "circle point".to_owned(),
        Role::Speed => "speed".to_owned(),
        Role::Zone => "zone".to_owned(),
        Role::Tool => "tool".to_owned(),
        Role::Position(position) => {
            let name = instruction.and_then(|instruction| instruction.parameter(position));
            name.map_or_else(|| format!("argument {}", position + 1), str::to_owned)
        }
        Role::Name("wobj") => "work object".to_owned(),
        Role::Name("tload") => "total load".to_owned(),
        Role::Name(name) => format!("\\{name}"),
    }
}

/// The start of a message about a call: its name and its first argument or target.
fn head(files: &[SourceFile], stmt: &Stmt) -> String {
    let StmtKind::Call(call) = &stmt.kind else { return String::new() };
    let name = match &call.callee {
        Callee::Name(name) => name.text.clone(),
        Callee::Late(value) => format!("%{}%", source(files, value.span)),
    };
    let parts = super::parts::parts(stmt);
    let first = parts.iter().find(|part| part.role.is_identity()).and_then(|part| part.value);
    match first {
        // A position in the statement is no name for it.
        Some(value) if !matches!(value.kind, crate::rapid::ir::hir::ExprKind::Aggregate(_)) => {
            format!("{name} {}", source(files, value.span))
        }
        _ => name,
    }
}

/// The header of a block in one line.
pub(super) fn headline(files: &[SourceFile], label: &Label<'_>) -> String {
    let list = |values: &[Expr]| {
        values.iter().map(|value| source(files, value.span)).collect::<Vec<_>>().join(", ")
    };
    match label {
        Label::Statement(stmt) => match &stmt.kind {
            StmtKind::If { branches, .. } => {
                let condition =
                    branches.first().map(|(condition, _)| source(files, condition.span));
                format!("IF {}", condition.unwrap_or_default())
            }
            StmtKind::For { var, from, to, step, .. } => {
                let step = step.as_ref().map(|step| format!(" STEP {}", source(files, step.span)));
                let (from, to) = (source(files, from.span), source(files, to.span));
                format!("FOR {} FROM {from} TO {to}{}", var.text, step.unwrap_or_default())
            }
            StmtKind::While { condition, .. } => format!("WHILE {}", source(files, condition.span)),
            StmtKind::Test { value, .. } => format!("TEST {}", source(files, value.span)),
            _ => source(files, stmt.span),
        },
        Label::ElseIf(condition, _) => format!("ELSEIF {}", source(files, condition.span)),
        Label::Case(values) => format!("CASE {}", list(values)),
        Label::Error([]) => "ERROR".to_owned(),
        Label::Error(numbers) => format!("ERROR ({})", list(numbers)),
        Label::Else | Label::Default | Label::Backward | Label::Undo => label.word().to_owned(),
    }
}

/// Both texts. Where they are equal, a name in them was given to something else, or is left over from
/// what has another name now.
fn both(context: &Context<'_>, old: Span, new: Span) -> String {
    let (old, new) = (source(context.old.files, old), source(context.new.files, new));
    if old == new {
        return format!("{new}: a name in it means something else than before");
    }
    format!("{old} → {new}")
}
