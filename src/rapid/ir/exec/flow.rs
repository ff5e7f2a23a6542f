//! Statements and control flow.

use std::sync::Arc;

use super::super::hir::{Block, Data, Expr, ExprKind, Ident, Stmt, StmtKind};
use super::super::value::{Datum, Dependence, Origin, Value};
use super::eval::equal;
use super::polling::{Mark, Pass, Poll};
use super::{Cell, Executor, MAX_STATEMENTS};
use crate::rapid::text::Span;

/// The note on a loop without an end.
const ENDLESS: &str = "an endless loop: simulated for one pass";

/// How a statement list ended.
pub(super) enum Flow {
    /// At its end.
    Next,
    /// `RETURN`, with the value of a function.
    Return(Option<Value>),
    /// `EXIT`, or the machine is full.
    Exit,
    /// An error that no handler has taken yet.
    Raised(Raised),
    /// `GOTO` a label that is not in the list itself, and the condition on inputs that decided.
    Jump(Ident, Option<Box<Poll>>),
    /// The end of a handler: the statement with the error once more.
    Retry,
    /// The end of a handler: the statement after the one with the error.
    TryNext,
}

/// An error.
pub(super) struct Raised {
    pub(super) at: Span,
    /// Its number by name, in upper case, where it is known.
    pub(super) error: Option<Arc<str>>,
    /// True if a handler of the routine has passed it on.
    pub(super) leaves: bool,
}

/// Times that a statement is tried again: the controller's default.
const RETRIES: u32 = 4;
/// The error number with which a handler takes what any routine below raises.
const ANY_ERROR: &str = "long_jmp_all_err";

/// A condition, as far as it is known.
pub(super) enum Condition {
    Known(bool),
    /// It depends on inputs at assumed levels.
    Assumed(bool),
    /// And why, in brackets.
    Unknown(String),
}

impl Executor<'_> {
    pub(super) fn block(&mut self, block: &Block) -> Flow {
        let mut marks = Vec::new();
        let flow = self.statements_of(block, &mut marks);
        if !marks.is_empty() {
            self.unwatch();
        }
        flow
    }

    /// Runs the statements; `marks` get the labels that were passed.
    fn statements_of(&mut self, block: &Block, marks: &mut Vec<(usize, Mark)>) -> Flow {
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
                    if is_endless(stmt, &block[at..index - 1]) {
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
                    // The IF that led back goes the other way now; else the mark is set already.
                    let goes_on = branches && matches!(pass, Pass::Came);
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

    /// Runs the error handler of the routine, if it has one that takes the error.
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
            // A handler that ends leaves the routine.
            Flow::Next => Flow::Return(None),
            Flow::Raised(inner) => Flow::Raised(Raised { leaves: true, ..inner }),
            other => other,
        }
    }

    /// Counts a statement or a pass; true if no more may run.
    pub(super) fn is_over(&mut self, at: Span) -> bool {
        self.statements += 1;
        if self.statements > MAX_STATEMENTS {
            self.unresolved(at, "the program does not end: the cycle is shown up to here");
            return true;
        }
        self.machine.is_full()
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
            StmtKind::Return(value) => {
                let value = value.as_ref().map(|expr| self.eval(expr));
                Flow::Return(value)
            }
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
                self.opaque(stmt.span, "the statement has a syntax error");
                Flow::Next
            }
        }
    }

    /// Routine data get a new value at each call.
    pub(super) fn declare_local(&mut self, data: &Data) {
        let value = self.initial_value(data);
        let history = self.history(&value.origin);
        let name = data.name.text.as_str().into();
        let reading = match data.kind {
            super::super::hir::DataKind::Const => Origin::default(),
            _ if self.is_in_function() => Origin::of(Dependence::Inner(name)),
            _ => Origin::of(Dependence::Local(name)),
        };
        let read_only = data.kind == super::super::hir::DataKind::Const;
        self.cells.push(Cell { value, reading, history, read_only, input: None });
        let cell = self.cells.len() - 1;
        self.frame_mut().names.push((data.name.key.clone(), cell));
    }

    fn if_statement(&mut self, branches: &[(Expr, Block)], otherwise: Option<&Block>) -> Flow {
        // The last condition on inputs: it decides whether a GOTO is reached.
        let mut decided = None;
        let mut input = None;
        for (condition, block) in branches {
            let is = self.condition(condition);
            input = self.seen_input.clone().or(input);
            match is {
                Condition::Known(false) if self.seen_input.is_some() => {
                    self.note_branch(condition, "FALSE", Some(block));
                }
                Condition::Known(false) => {}
                Condition::Assumed(false) => {
                    self.note_branch(condition, "FALSE", Some(block));
                    decided = Some(Poll { condition: condition.clone(), value: false });
                }
                Condition::Known(true) => {
                    if self.seen_input.is_some() {
                        self.note_branch(condition, "TRUE", otherwise);
                    }
                    return decided_by(decided, self.block_by(input, block));
                }
                Condition::Assumed(true) => {
                    self.note_branch(condition, "TRUE", otherwise);
                    decided = Some(Poll { condition: condition.clone(), value: true });
                    return decided_by(decided, self.block_by(input, block));
                }
                Condition::Unknown(why) => {
                    self.unresolved(
                        condition.span,
                        format!("the condition is not known{why}: taken as FALSE"),
                    );
                }
            }
        }
        match otherwise {
            Some(block) => decided_by(decided, self.block_by(input, block)),
            None => Flow::Next,
        }
    }

    /// A block that runs because of an input, if there is one: what it assigns depends on that.
    fn block_by(&mut self, input: Option<Arc<str>>, block: &Block) -> Flow {
        let depth = self.deciding.len();
        self.deciding.extend(input);
        let flow = self.block(block);
        self.deciding.truncate(depth);
        flow
    }

    /// Data that a block would have assigned depend on the input because of which it did not run.
    fn left_out(&mut self, block: &Block) {
        for stmt in block {
            if let StmtKind::Assign { target, .. } = &stmt.kind
                && let Some(cell) = target.base().and_then(|name| self.cell_of(name))
            {
                self.cells[cell].input.clone_from(&self.seen_input);
            }
            for inner in stmt.kind.blocks() {
                self.left_out(inner);
            }
        }
    }

    /// Tells which way an `IF` on inputs went and what the other way holds, if anything moves or
    /// waits there.
    fn note_branch(&mut self, condition: &Expr, taken: &str, left_out: Option<&Block>) {
        if let Some(block) = left_out {
            self.left_out(block);
        }
        let calls = left_out.map_or(0, |block| calls(block));
        if calls == 0 {
            return;
        }
        let what = if calls == 1 { "instruction" } else { "instructions" };
        let state = self.how_to_state(condition);
        self.unresolved(
            condition.span,
            format!(
                "depends on inputs, taken as {taken}: the other branch ({calls} {what}) was not \
                 run; {state}"
            ),
        );
    }

    fn how_to_state(&mut self, expr: &Expr) -> String {
        let seen = self.seen_input.clone();
        let signal = self.first_signal(expr).or(seen);
        format!("--assume {}=LEVEL states another", signal.as_deref().unwrap_or("SIGNAL"))
    }

    pub(super) fn condition(&mut self, expr: &Expr) -> Condition {
        let condition = self.read_condition(expr);
        let Condition::Assumed(value) = condition else { return condition };
        if self.forced == Some(expr.span) {
            self.forced = None;
            return Condition::Assumed(!value);
        }
        if self.watchers > 0 {
            self.polls.push(Poll { condition: expr.clone(), value });
        }
        condition
    }

    fn read_condition(&mut self, expr: &Expr) -> Condition {
        self.seen_input = None;
        let value = self.eval(expr);
        let value = self.level(value);
        let input = value.origin.iter().any(|d| matches!(d, Dependence::Input(_)));
        match value.datum {
            Datum::Bool(b) if input => Condition::Assumed(b),
            Datum::Bool(b) => Condition::Known(b),
            Datum::Num(x) if input => Condition::Assumed(x != 0.0),
            Datum::Num(x) => Condition::Known(x != 0.0),
            datum => Condition::Unknown(match datum.first_unknown() {
                Some(unknown) => format!(" ({})", unknown.reason),
                None => String::new(),
            }),
        }
    }

    fn test_statement(
        &mut self,
        value: &Expr,
        cases: &[(Vec<Expr>, Block)],
        default: Option<&Block>,
    ) -> Flow {
        self.seen_input = None;
        let tested = self.eval(value);
        let tested = self.level(tested);
        let input = self.seen_input.clone();
        if let Some(unknown) = tested.datum.first_unknown() {
            let reason = unknown.reason.clone();
            let taken = if default.is_some() { "DEFAULT is taken" } else { "no CASE is taken" };
            let reason = format!("the TEST value is not known ({reason}): {taken}");
            self.unresolved(value.span, reason);
        } else {
            let mut taken = None;
            'cases: for (i, (values, _)) in cases.iter().enumerate() {
                for expr in values {
                    let candidate = self.eval(expr);
                    let candidate = self.level(candidate);
                    if equal(&candidate.datum, &tested.datum) {
                        taken = Some(i);
                        break 'cases;
                    }
                }
            }
            if input.is_some() {
                self.seen_input.clone_from(&input);
                self.note_case(value, &tested.datum, taken, cases, default);
            }
            if let Some((_, block)) = taken.and_then(|i| cases.get(i)) {
                return self.block_by(input, block);
            }
        }
        match default {
            Some(block) => self.block_by(input, block),
            None => Flow::Next,
        }
    }
}

impl Executor<'_> {
    /// Tells which way a `TEST` on inputs went and what the others hold.
    fn note_case(
        &mut self,
        value: &Expr,
        tested: &Datum,
        taken: Option<usize>,
        cases: &[(Vec<Expr>, Block)],
        default: Option<&Block>,
    ) {
        let others = cases.iter().enumerate().filter(|(i, _)| taken != Some(*i));
        let mut blocks: Vec<&Block> = others.map(|(_, (_, block))| block).collect();
        blocks.extend(default.filter(|_| taken.is_some()));
        for block in &blocks {
            self.left_out(block);
        }
        let mut left_out: Vec<usize> = blocks.into_iter().map(|block| calls(block)).collect();
        left_out.retain(|calls| *calls > 0);
        let count: usize = left_out.iter().sum();
        if count == 0 {
            return;
        }
        let branches = if left_out.len() == 1 { "branch" } else { "branches" };
        let what = if count == 1 { "instruction" } else { "instructions" };
        let level = match tested {
            Datum::Num(x) => number_text(*x),
            Datum::Bool(b) => b.to_string().to_uppercase(),
            _ => "it is".to_owned(),
        };
        let state = self.how_to_state(value);
        self.unresolved(
            value.span,
            format!(
                "depends on inputs, taken as {level}: {} other {branches} ({count} {what}) not \
                 run; {state}",
                left_out.len()
            ),
        );
    }
}

/// The flow out of a branch; a `GOTO` in it was decided by the condition.
fn decided_by(decided: Option<Poll>, flow: Flow) -> Flow {
    match flow {
        Flow::Jump(label, None) => Flow::Jump(label, decided.map(Box::new)),
        other => other,
    }
}

fn find_label(block: &Block, label: &Ident) -> Option<usize> {
    block.iter().position(|stmt| matches!(&stmt.kind, StmtKind::Label(l) if l.key == label.key))
}

/// Whether a `GOTO` leads back to these statements each time.
fn is_endless(stmt: &Stmt, body: &[Stmt]) -> bool {
    matches!(stmt.kind, StmtKind::Goto(_)) && never_leaves(body)
}

/// Whether nothing in these statements can jump out of them.
pub(super) fn never_leaves(block: &[Stmt]) -> bool {
    block.iter().all(|stmt| match &stmt.kind {
        StmtKind::Goto(_)
        | StmtKind::Return(_)
        | StmtKind::Raise(_)
        | StmtKind::Exit
        | StmtKind::Broken => false,
        kind => kind.blocks().into_iter().all(|inner| never_leaves(inner)),
    })
}

/// Number of instructions and calls in a block, inner blocks included.
fn calls(block: &[Stmt]) -> usize {
    let of = |stmt: &Stmt| match &stmt.kind {
        StmtKind::Call(_) => 1,
        kind => kind.blocks().into_iter().map(|inner| calls(inner)).sum(),
    };
    block.iter().map(of).sum()
}

/// A number as RAPID text that reads back as the same number.
pub(super) fn number_text(x: f64) -> String {
    format!("{x}")
}
