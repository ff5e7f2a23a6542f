//! Variables of a routine that are read before anything has given them a value.
//!
//! A read is reported only if on every path to it nothing can have written the variable. Statements
//! are followed in their order; what a loop writes counts as written before it, and a call that may
//! write to an argument counts as a write. Routines with GOTO or syntax errors are left out.

use std::collections::BTreeSet;

use super::context::{Context, Place};
use super::fault::{warning, with_place};
use super::parameters::{Parameter, call, parameters};
use super::types::{Type, stated};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{Access, Basic, DeclarationId, Kind, Storage};
use crate::rapid::syntax::NodeKind;

/// Most variables without a value of a routine that is followed; no person writes more.
const MOST_VARIABLES: usize = 1_000;

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    for routine in context.routines() {
        let skipped = |kind| {
            matches!(kind, NodeKind::Error | NodeKind::LabelStatement | NodeKind::Placeholder)
        };
        if routine.node.subtree().any(|node| skipped(node.kind())) {
            continue;
        }
        let unset = unset(context, routine);
        if unset.is_empty() || unset.len() > MOST_VARIABLES {
            continue;
        }
        let mut follow = Follow { context, unset, out };
        let mut after = BTreeSet::new();
        for part in routine.children().filter(|part| part.kind() == NodeKind::Block) {
            follow.statements(part, &mut after);
            written(context, part, &mut after);
        }
        // A handler runs after any part of the body.
        for part in routine.children() {
            if matches!(
                part.kind(),
                NodeKind::ErrorHandler | NodeKind::BackwardHandler | NodeKind::UndoHandler
            ) {
                follow.statements(part, &mut after);
            }
        }
    }
}

/// The variables of a routine without a first value.
fn unset(context: &Context<'_>, routine: Place<'_>) -> BTreeSet<DeclarationId> {
    let declarations = routine.children().filter(|part| part.kind() == NodeKind::DataDeclaration);
    let without = declarations.filter(|part| !part.children().any(|c| c.kind().is_value()));
    let names = without.filter_map(|part| context.declared(part.child(NodeKind::Name)?));
    let is_plain = |id: &DeclarationId| {
        let declaration = context.names.declaration(*id);
        let value = matches!(
            stated(&context.names, declaration.value),
            Type::Of(base, 0) if matches!(
                context.names.declaration(base).kind,
                Kind::Record | Kind::Basic(Basic::Atomic)
            )
        );
        value && declaration.kind == Kind::Data(Storage::Var)
    };
    names.filter(is_plain).collect()
}

struct Follow<'c, 'a> {
    context: &'c Context<'a>,
    unset: BTreeSet<DeclarationId>,
    out: &'c mut Vec<Diagnostic>,
}

type Written = BTreeSet<DeclarationId>;

impl<'a> Follow<'_, 'a> {
    fn statements(&mut self, block: Place<'a>, set: &mut Written) {
        for statement in block.children() {
            self.statement(statement, set);
        }
    }

    fn statement(&mut self, place: Place<'a>, set: &mut Written) {
        match place.kind() {
            NodeKind::IfStatement | NodeKind::TestStatement | NodeKind::CompactIf => {
                let mut after = set.clone();
                for part in place.children() {
                    match part.kind() {
                        NodeKind::ElseIfBranch
                        | NodeKind::ElseBranch
                        | NodeKind::CaseBranch
                        | NodeKind::DefaultBranch => {
                            let mut branch = set.clone();
                            self.statements(part, &mut branch);
                            after.append(&mut branch);
                        }
                        kind if kind.is_value() => self.condition(part, set),
                        _ => {
                            let mut branch = set.clone();
                            self.statement(part, &mut branch);
                            after.append(&mut branch);
                        }
                    }
                }
                set.append(&mut after);
            }
            NodeKind::WhileStatement | NodeKind::ForStatement => {
                written(self.context, place, set);
                self.statements(place, set);
            }
            NodeKind::Block | NodeKind::ForStep => self.statements(place, set),
            NodeKind::Assignment => {
                let mut sides = place.children();
                let variable = sides.next();
                sides.for_each(|value| self.read(value, set));
                if let Some(variable) = variable {
                    self.indices(variable, set);
                }
                written(self.context, place, set);
            }
            kind if kind.is_value() => self.condition(place, set),
            NodeKind::CallStatement => {
                self.arguments(place, set);
                written(self.context, place, set);
            }
            _ => {
                place.children().for_each(|part| self.statement(part, set));
                written(self.context, place, set);
            }
        }
    }

    /// An expression that is evaluated before other statements; a function in it may write.
    fn condition(&mut self, place: Place<'a>, set: &mut Written) {
        self.read(place, set);
        written(self.context, place, set);
    }

    /// The indices of an assigned variable.
    fn indices(&mut self, place: Place<'a>, set: &Written) {
        let mut children = place.children();
        match place.kind() {
            NodeKind::IndexAccess => {
                if let Some(array) = children.next() {
                    self.indices(array, set);
                }
                children.for_each(|index| self.read(index, set));
            }
            NodeKind::FieldAccess => {
                if let Some(record) = children.next() {
                    self.indices(record, set);
                }
            }
            _ => {}
        }
    }

    /// An expression whose value is needed.
    fn read(&mut self, place: Place<'a>, set: &Written) {
        match place.kind() {
            NodeKind::Reference => {
                if let Some(id) = self.context.declared(place)
                    && !set.contains(&id)
                    && self.unset.remove(&id)
                {
                    self.report(place, id);
                }
            }
            NodeKind::FunctionCall => self.arguments(place, set),
            _ => place.children().for_each(|part| self.read(part, set)),
        }
    }

    /// The arguments of a call that are passed by value.
    fn arguments(&mut self, place: Place<'a>, set: &Written) {
        for (value, passed) in passed(self.context, place) {
            match passed {
                Passed::Value => self.read(value, set),
                Passed::Reference | Passed::Unknown => self.indices(value, set),
            }
        }
    }

    fn report(&mut self, place: Place<'a>, id: DeclarationId) {
        let declaration = self.context.names.declaration(id);
        let name = place.text();
        let message = format!("{name} is read before it is given a value");
        let help = format!(
            "give it a value first: without one it has 0, FALSE or \"\" here ({name} := …)"
        );
        let finding = warning("no-value", place.span(), message, help);
        self.out.push(with_place(finding, declaration.name, "declared without a value"));
    }
}

/// How an argument is passed.
enum Passed {
    Value,
    Reference,
    Unknown,
}

/// The values of the arguments of a call.
fn passed<'a>(context: &Context<'a>, place: Place<'a>) -> Vec<(Place<'a>, Passed)> {
    let Some((callee, arguments)) = call(place) else {
        let values = place.children();
        return values.map(|value| (value, Passed::Unknown)).collect();
    };
    let routine = context
        .declared(callee)
        .filter(|id| matches!(context.names.declaration(*id).kind, Kind::Routine(_)));
    let known = routine.map(|id| parameters(context, id));
    let mut required = 0;
    let mut all = Vec::new();
    for argument in arguments {
        let parameter = known.as_ref().and_then(|known| match argument.name {
            Some(name) => {
                let id = context.declared(name)?;
                known.iter().find(|one| one.id == id).copied()
            }
            None => known.iter().filter(|one| one.group.is_none()).nth(required).copied(),
        });
        required += usize::from(!argument.is_optional());
        if let Some(value) = argument.value {
            let passed = parameter.map_or(Passed::Unknown, |one| how(context, one));
            all.push((value, passed));
        }
    }
    all
}

fn how(context: &Context<'_>, parameter: Parameter) -> Passed {
    // Any type: such a routine may ask for the data itself, as `Present` and `Dim` do.
    let known = stated(&context.names, context.names.declaration(parameter.id).value);
    match (parameter.access, known) {
        (Access::In, Type::Of(..)) => Passed::Value,
        (Access::In, _) => Passed::Unknown,
        _ => Passed::Reference,
    }
}

/// Adds what a node may write.
fn written(context: &Context<'_>, place: Place<'_>, set: &mut Written) {
    for node in place.node.subtree() {
        let part = place.at(node);
        match part.kind() {
            NodeKind::Assignment | NodeKind::ConnectStatement => {
                set.extend(part.children().next().and_then(|variable| data(context, variable)));
            }
            NodeKind::CallStatement | NodeKind::FunctionCall => {
                for (value, passed) in passed(context, part) {
                    if !matches!(passed, Passed::Value) {
                        set.extend(data(context, value));
                    }
                }
            }
            _ => {}
        }
    }
}

/// The data whose part a variable is.
fn data(context: &Context<'_>, place: Place<'_>) -> Option<DeclarationId> {
    let mut at = place;
    while matches!(at.kind(), NodeKind::FieldAccess | NodeKind::IndexAccess) {
        at = at.children().next()?;
    }
    context.declared(at)
}
