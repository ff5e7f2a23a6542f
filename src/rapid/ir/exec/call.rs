//! Calls of the program's own routines.

use std::sync::Arc;

use super::eval::declared_twice;
use super::executor::{Cell, CellId, Executor, Frame, MAX_CALL_DEPTH};
use super::flow::{Flow, Raised};
use crate::rapid::ir::hir::{
    Arg, ArgKind, Call, Callee, Expr, ExprKind, Ident, Param, ParamMode, RoutineKind, Stmt,
};
use crate::rapid::ir::movement::{ActiveCall, Unresolved};
use crate::rapid::ir::program::{RoutineId, Symbol};
use crate::rapid::ir::value::{Datum, Dependence, Origin};
use crate::rapid::text::Span;

impl Executor<'_> {
    /// A call statement: a routine of the program or a RAPID instruction.
    pub(super) fn call_statement(&mut self, stmt: &Stmt, call: &Call) -> Flow {
        let (key, text, span) = match &call.callee {
            Callee::Name(name) => (name.key.clone(), name.text.clone(), name.span),
            Callee::Late(expr) => {
                let Datum::Text(name) = self.eval(expr).datum else {
                    self.unknown_effect(stmt.span, "the procedure called by %…% is not known");
                    return Flow::Next;
                };
                // "Module:Proc" names a local procedure of a module.
                let proc = name.rsplit(':').next().unwrap_or(&name);
                (proc.to_lowercase(), proc.to_owned(), expr.span)
            }
        };
        match self.program.resolve(self.frame().module, &key) {
            Some(Symbol::Routine(id)) => match self.call_routine(id, &call.args, span) {
                Flow::Return(_) => Flow::Next,
                other => other,
            },
            Some(Symbol::Ambiguous) => {
                self.mark_unknown(&call.args, &format!("may be changed by {text}"));
                self.unknown_effect(stmt.span, &declared_twice(&text));
                Flow::Next
            }
            _ => self.instruction(stmt, &key, &text, &call.args),
        }
    }

    /// Binds the arguments and runs the routine.
    pub(super) fn call_routine(&mut self, id: RoutineId, args: &[Arg], at: Span) -> Flow {
        if self.frames.len() >= MAX_CALL_DEPTH {
            self.unresolved(
                at,
                format!(
                    "calls are nested more than {MAX_CALL_DEPTH} deep, as if a routine called \
                     itself without an end: the cycle is shown up to here"
                ),
            );
            return Flow::Exit;
        }
        let program = self.program;
        let params = &program.routine(id).params;
        let named = |name: &Ident| params.iter().find(|param| param.name.key == name.key);
        let mut required = params.iter().filter(|param| !param.optional);
        let mut names = Vec::new();
        let mut present = Vec::new();
        let mut parts = Vec::new();
        for arg in args {
            let (param, expr) = match &arg.kind {
                ArgKind::Positional(expr) => (required.next(), Some(expr)),
                ArgKind::Named(name, expr) => (named(name), Some(expr)),
                ArgKind::Optional(name, expr) => (named(name), expr.as_ref()),
                ArgKind::Conditional(name, outer) => {
                    let Some(own) = self.given(outer) else { continue };
                    let has_value = self.cell_of(own).is_some();
                    (named(name), has_value.then_some(outer))
                }
            };
            let Some(param) = param else {
                self.unresolved(arg.span, "the argument has no parameter");
                continue;
            };
            present.push(param.name.key.clone());
            if let Some(expr) = expr {
                let part = self.part_by_reference(param, expr);
                let cell = part.as_ref().map(|part| part.parameter);
                let cell = cell.unwrap_or_else(|| self.bind(param, expr));
                names.push((param.name.key.clone(), cell));
                parts.extend(part);
            }
        }
        let lent = self.lent.len();
        let wholes = self.lend(parts);
        let flow = self.enter(id, names, present, Some(at));
        self.take_back(lent, wholes);
        flow
    }

    /// The cell of a parameter: that of the argument if passed by reference, else a new one.
    pub(super) fn bind(&mut self, param: &Param, expr: &Expr) -> CellId {
        if param.mode != ParamMode::In
            && let ExprKind::Ref(name) = &expr.kind
            && let Some(cell) = self.cell_of(name)
        {
            return cell;
        }
        self.seen_input = None;
        let mut value = self.eval(expr);
        // A signal keeps its own type.
        if matches!(value.datum, Datum::Signal(_)) {
            self.seen_input = None;
        } else {
            value.type_key = param.type_name.key.as_str().into();
        }
        let input = self.seen_input.clone();
        let reading = Origin::of(Dependence::Local(param.name.text.as_str().into()));
        self.new_cell(Cell { input, ..Cell::new(value, reading) })
    }

    /// Runs a routine whose parameters are bound.
    pub(super) fn enter(
        &mut self,
        id: RoutineId,
        names: Vec<(String, CellId)>,
        present: Vec<String>,
        at: Option<Span>,
    ) -> Flow {
        let program = self.program;
        let routine = program.routine(id);
        let cells = self.cells.len();
        let mut given = Origin::default();
        for (_, cell) in &names {
            given.join(&self.cells[*cell].value.origin);
        }
        let within = self.frames.last().and_then(|frame| frame.call.clone());
        let call = at.map(|name| Arc::new(ActiveCall { name, within }));
        self.frames.push(Frame {
            module: id.module,
            routine: routine.name.text.as_str().into(),
            id: Some(id),
            names,
            call,
            present,
            base: cells,
            ..Frame::default()
        });
        for data in &routine.data {
            self.declare_local(data);
        }
        let flow = self.block(&routine.body);
        self.frames.pop();
        // Cells of module data that the routine was the first to use stay.
        self.cells.truncate(cells.max(self.kept_cells));
        match flow {
            Flow::Next | Flow::Retry | Flow::TryNext => Flow::Return(None),
            // The error passes to the handler of the caller.
            Flow::Raised(raised) => Flow::Raised(Raised { leaves: false, ..raised }),
            // The caller does not know the parameters by name: the value takes over their origin.
            Flow::Return(Some(mut value)) => {
                value.origin.join(&given);
                Flow::Return(Some(value))
            }
            other => other,
        }
    }

    /// Whether the running routine is a function: its callers can't name its data.
    pub(super) fn is_in_function(&self) -> bool {
        let routine = self.frame().id.map(|id| self.program.routine(id));
        routine.is_some_and(|routine| matches!(routine.kind, RoutineKind::Func))
    }

    /// Reports a statement with an unknown effect on position and time.
    pub(super) fn unknown_effect(&mut self, span: Span, reason: &str) {
        self.unresolved(span, reason);
        self.machine.on_movement(Err(Unresolved { span, reason: reason.to_owned(), moves: true }));
    }
}
