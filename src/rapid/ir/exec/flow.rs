//! Statements and control flow.

use std::sync::Arc;

use super::executor::{Cell, Executor, MAX_STATEMENTS, Poll};
use super::polling::{Mark, Pass};
use crate::rapid::ir::hir::{Block, Data, DataKind, Expr, ExprKind, Ident, Stmt, StmtKind};
use crate::rapid::ir::value::{Dependence, Origin, Value};
use crate::rapid::ir::walk::statements;
use crate::rapid::text::Span;

/// The note on a program that runs longer than is simulated.
pub const NO_END: &str = "the program does not end: the cycle is shown up to here";
/// The note on an endless loop.
const ENDLESS: &str = "an endless loop: simulated for one pass";

/// How a statement list ended.
pub(super) enum Flow {
    /// At its end.
    Next,
    /// `RETURN`, with the value of a function.
    Return(Option<Value>),
    /// `EXIT`, or a limit of the execution is reached.
    Exit,
    /// An error that no handler has accepted yet.
    Raised(Raised),
    /// `GOTO` a label outside the list, and the condition on inputs that led to it.
    Jump(Ident, Option<Box<Poll>>),
    /// The end of a handler: repeat the statement with the error.
    Retry,
    /// The end of a handler: continue after the statement with the error.
    TryNext,
}

/// An error.
pub(super) struct Raised {
    pub(super) at: Span,
    /// Name of its error number in upper case, if known.
    pub(super) error: Option<Arc<str>>,
    /// True if a handler of the routine has passed it on.
    pub(super) leaves: bool,
}

/// Number of retries of a statement: the controller's default.
const RETRIES: u32 = 4;
/// The error number of a handler that accepts every error raised in called routines.
const ANY_ERROR: &str = "long_jmp_all_err";

impl Executor<'_> {
    pub(super) fn block(&mut self, block: &Block) -> Flow {
        let mut marks = Vec::new();
        let flow = self.run_statements(block, &mut marks);
        if !marks.is_empty() {
            self.unwatch();
        }
        flow
    }

    /// Runs the statements; `marks` collects the labels that were passed.
    fn run_statements(&mut self, block: &Block, marks: &mut Vec<(usize, Mark)>) -> Flow {
        let mut index = 0;
        while let Some(stmt) = block.get(index) {
            if matches!(stmt.kind, StmtKind::Label(_)) {
                self.pass_label(index, marks);
            }
            index += 1;
            let (label, decided) = match self.statement(stmt) {
                Flow::Next => continue,
                Flow::Jump(label, decided) => (label, decided),
                other => return other,
            };
            match find_label(block, &label) {
                Some(at) if at < index => {
                    let body = &block[at..index - 1];
                    if matches!(stmt.kind, StmtKind::Goto(_)) && never_leaves(body) {
                        self.unresolved(stmt.span, ENDLESS);
                        continue;
                    }
                    let branches = decided.is_some() && matches!(stmt.kind, StmtKind::If { .. });
                    let known = marks.iter_mut().find(|(label, _)| *label == at);
                    let pass = match known {
                        Some((_, mark)) => self.pass(mark, "GOTO", decided.map(|p| *p), None),
                        None => Pass::Ordinary,
                    };
                    if matches!(pass, Pass::Endless) {
                        self.unresolved(stmt.span, ENDLESS);
                        continue;
                    }
                    // The IF that led back takes its other branch; else repeat after the label.
                    let goes_on = branches && matches!(pass, Pass::InputChanged);
                    index = if goes_on { index - 1 } else { at + 1 };
                }
                Some(at) => index = at,
                None => return Flow::Jump(label, decided),
            }
        }
        Flow::Next
    }

    fn pass_label(&mut self, label: usize, marks: &mut Vec<(usize, Mark)>) {
        if marks.is_empty() {
            self.watchers += 1;
        }
        marks.retain(|(known, _)| *known != label);
        marks.push((label, self.mark()));
    }

    pub(super) fn unwatch(&mut self) {
        self.watchers -= 1;
        if self.watchers == 0 {
            self.polls.clear();
        }
    }

    fn statement(&mut self, stmt: &Stmt) -> Flow {
        let mut flow = self.attempt(stmt);
        let mut tries = 0;
        while let Flow::Raised(raised) = flow {
            flow = match self.handle(raised) {
                Flow::Retry if tries < RETRIES => {
                    tries += 1;
                    self.attempt(stmt)
                }
                Flow::Retry => {
                    let reason = format!("tried {RETRIES} times again, with the same error");
                    self.unresolved(stmt.span, reason);
                    return Flow::Raised(Raised {
                        at: stmt.span,
                        error: Some("ERR_EXCRTYMAX".into()),
                        leaves: true,
                    });
                }
                Flow::TryNext => Flow::Next,
                other => return other,
            };
        }
        flow
    }

    /// Runs the error handler of the routine, if it has one that accepts the error.
    fn handle(&mut self, raised: Raised) -> Flow {
        let program = self.program;
        let frame = self.frame();
        let Some(id) = frame.id.filter(|_| !frame.handling && !raised.leaves) else {
            return Flow::Raised(Raised { leaves: true, ..raised });
        };
        let takes = |numbers: &[Expr]| {
            numbers.is_empty()
                || raised.error.is_none()
                || numbers.iter().any(|number| match &number.kind {
                    ExprKind::Ref(name) => {
                        name.key == ANY_ERROR
                            || raised.error.as_deref() == Some(&name.text.to_uppercase())
                    }
                    _ => false,
                })
        };
        let handlers = &program.routine(id).error;
        let Some((_, handler)) = handlers.iter().find(|(numbers, _)| takes(numbers)) else {
            return Flow::Raised(raised);
        };
        self.unresolved(raised.at, "the error is taken by the handler of the routine");
        let before = std::mem::replace(&mut self.errno, raised.error.clone());
        self.frame_mut().handling = true;
        let flow = self.block(handler);
        self.frame_mut().handling = false;
        self.errno = before;
        match flow {
            // The end of the handler ends the routine.
            Flow::Next => Flow::Return(None),
            Flow::Raised(inner) => Flow::Raised(Raised { leaves: true, ..inner }),
            other => other,
        }
    }

    /// Counts a statement or a pass; true once a limit is reached.
    pub(super) fn is_over(&mut self, at: Span) -> bool {
        self.statements += 1;
        if self.statements > MAX_STATEMENTS {
            self.unresolved(at, NO_END);
            return true;
        }
        self.machine.is_at_limit()
    }

    fn attempt(&mut self, stmt: &Stmt) -> Flow {
        if self.is_over(stmt.span) {
            return Flow::Exit;
        }
        match &stmt.kind {
            StmtKind::Assign { target, value } => {
                self.seen_input = None;
                let value = self.eval(value);
                self.assign(target, value);
                Flow::Next
            }
            StmtKind::Call(call) => self.call_statement(stmt, call),
            StmtKind::If { branches, otherwise } => self.if_statement(branches, otherwise.as_ref()),
            StmtKind::For { var, from, to, step, body } => {
                self.for_statement(stmt, var, (from, to, step.as_ref()), body)
            }
            StmtKind::While { condition, body } => self.while_statement(stmt, condition, body),
            StmtKind::Test { value, cases, default } => {
                self.test_statement(value, cases, default.as_ref())
            }
            StmtKind::Goto(label) => Flow::Jump(label.clone(), None),
            StmtKind::Return(value) => Flow::Return(value.as_ref().map(|expr| self.eval(expr))),
            StmtKind::Raise(number) => {
                let error = match number.as_ref().map(|number| &number.kind) {
                    Some(ExprKind::Ref(name)) => Some(name.text.to_uppercase().into()),
                    Some(_) => None,
                    None => self.errno.clone(),
                };
                Flow::Raised(Raised { at: stmt.span, error, leaves: false })
            }
            StmtKind::Exit => Flow::Exit,
            StmtKind::Retry => Flow::Retry,
            StmtKind::TryNext => Flow::TryNext,
            StmtKind::Data(data) => {
                self.declare_local(data);
                Flow::Next
            }
            StmtKind::Label(_) | StmtKind::Connect { .. } | StmtKind::Placeholder => Flow::Next,
            StmtKind::Broken => {
                self.unknown_effect(stmt.span, "the statement has a syntax error");
                Flow::Next
            }
        }
    }

    /// Declares data of the routine with their initial value, at each call.
    pub(super) fn declare_local(&mut self, data: &Data) {
        let value = self.initial_value(data);
        let history = self.history(&value.origin);
        let name = data.name.text.as_str().into();
        let reading = match data.kind {
            DataKind::Const => Origin::default(),
            _ if self.is_in_function() => Origin::of(Dependence::Inner(name)),
            _ => Origin::of(Dependence::Local(name)),
        };
        let read_only = data.kind == DataKind::Const;
        let cell = self.new_cell(Cell { history, read_only, ..Cell::new(value, reading) });
        self.frame_mut().names.push((data.name.key.clone(), cell));
    }
}

fn find_label(block: &Block, label: &Ident) -> Option<usize> {
    block.iter().position(|stmt| matches!(&stmt.kind, StmtKind::Label(l) if l.key == label.key))
}

/// Whether nothing in these statements can jump out of them.
pub(super) fn never_leaves(block: &[Stmt]) -> bool {
    let leaves = |stmt: &Stmt| {
        matches!(
            stmt.kind,
            StmtKind::Goto(_)
                | StmtKind::Return(_)
                | StmtKind::Raise(_)
                | StmtKind::Exit
                | StmtKind::Broken
        )
    };
    !statements(block).any(leaves)
}

/// A number as RAPID text that parses to the same number.
pub(super) fn number_text(x: f64) -> String {
    format!("{x}")
}
