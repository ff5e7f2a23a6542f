//! Statements that only some places allow: RETURN, RETRY, TRYNEXT, RAISE, handlers, CONNECT.

use super::context::{Context, Place};
use super::describe::describe;
use super::expressions::type_of;
use super::fault::error;
use super::types::{Type, scalar, stated};
use super::values::{compare, fits};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{Kind, Storage};
use crate::rapid::syntax::{NodeKind, Token};
use crate::rapid::text::Span;

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    for routine in context.routines() {
        let mut walk = Walk { context, routine, out };
        walk.inside(routine, false);
        if routine.kind() == NodeKind::FuncDeclaration {
            without_return(routine, walk.out);
        }
    }
}

struct Walk<'c, 'a> {
    context: &'c Context<'a>,
    routine: Place<'a>,
    out: &'c mut Vec<Diagnostic>,
}

impl<'a> Walk<'_, 'a> {
    /// The statements below a node; `handling` inside an ERROR handler.
    fn inside(&mut self, place: Place<'a>, handling: bool) {
        for child in place.children() {
            match child.kind() {
                NodeKind::ErrorHandler => self.inside(child, true),
                NodeKind::BackwardHandler => {
                    if self.routine.kind() != NodeKind::ProcDeclaration {
                        let message = "only a PROC has a BACKWARD handler".to_owned();
                        let help = "move its statements into a PROC".to_owned();
                        self.out.push(error("handler", keyword(child), message, help));
                    }
                    self.inside(child, false);
                }
                NodeKind::RetryStatement | NodeKind::TryNextStatement if !handling => {
                    let word = child.text();
                    let word = word.trim_end_matches(';').trim().to_uppercase();
                    let message = format!("{word} outside an ERROR handler");
                    let help = "move it into the ERROR handler of the routine".to_owned();
                    self.out.push(error("handler", child.span(), message, help));
                }
                NodeKind::RaiseStatement => self.raise(child, handling),
                NodeKind::ReturnStatement => self.return_statement(child),
                NodeKind::ConnectStatement => self.connect(child),
                _ => self.inside(child, handling),
            }
        }
    }

    fn raise(&mut self, place: Place<'a>, handling: bool) {
        match place.children().next() {
            None if !handling => self.out.push(error(
                "handler",
                place.span(),
                "RAISE without an error number outside an ERROR handler".to_owned(),
                "give the number: RAISE ERR_…".to_owned(),
            )),
            Some(number) => {
                let num = scalar(self.context.basics.num);
                compare(self.context, "RAISE", num, number, self.out);
            }
            None => {}
        }
    }

    fn return_statement(&mut self, place: Place<'a>) {
        let value = place.children().next();
        if place.is_broken() {
            return;
        }
        match (self.routine.kind(), value) {
            (NodeKind::FuncDeclaration, None) => self.out.push(error(
                "return",
                place.span(),
                "a function returns a value".to_owned(),
                "write RETURN with a value of the function's type".to_owned(),
            )),
            (NodeKind::FuncDeclaration, Some(value)) => {
                let name = self.routine.child(NodeKind::Name);
                if let Some(id) = name.and_then(|name| self.context.declared(name)) {
                    let names = &self.context.names;
                    let wanted = stated(names, names.declaration(id).value);
                    compare(self.context, "this RETURN", wanted, value, self.out);
                }
            }
            (_, Some(value)) => self.out.push(error(
                "return",
                value.span(),
                "only a function returns a value".to_owned(),
                "remove the value, or make the routine a FUNC".to_owned(),
            )),
            (_, None) => {}
        }
    }

    fn connect(&mut self, place: Place<'a>) {
        let Some(variable) = place.children().next() else { return };
        if place.is_broken() {
            return;
        }
        let num = scalar(self.context.basics.num);
        let given = type_of(self.context, variable);
        if !fits(self.context, num, given) || given == Type::Number {
            let message = format!(
                "CONNECT needs a variable of type intnum, this is {}",
                describe(self.context, given)
            );
            let help = "declare it: VAR intnum …".to_owned();
            self.out.push(error("type", variable.span(), message, help));
        } else if let Some(id) = self.context.declared(variable)
            && self.context.names.declaration(id).kind == Kind::Data(Storage::Const)
        {
            let message = "CONNECT needs a variable, this is a constant".to_owned();
            let help = "declare it: VAR intnum …".to_owned();
            self.out.push(error("access", variable.span(), message, help));
        }
    }
}

/// The keyword that begins a handler.
fn keyword(place: Place<'_>) -> Span {
    let token = place.node.own_tokens().next();
    let range = token.map_or(place.node.range(), Token::range);
    Span { start: range.start, end: range.end, ..place.span() }
}

/// A function that can end without a value in every way.
fn without_return(routine: Place<'_>, out: &mut Vec<Diagnostic>) {
    let ends = |kind| {
        matches!(
            kind,
            NodeKind::ReturnStatement
                | NodeKind::RaiseStatement
                | NodeKind::ExitStatement
                | NodeKind::Placeholder
                | NodeKind::Error
        )
    };
    if let Some(name) = routine.child(NodeKind::Name)
        && !routine.node.subtree().any(|node| ends(node.kind()))
    {
        let message = format!("the function {} has no RETURN", name.text());
        let help = "end it with RETURN and a value".to_owned();
        out.push(error("return", name.span(), message, help));
    }
}
