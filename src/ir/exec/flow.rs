//! Statements and control flow.

use super::super::hir::{Block, Data, Expr, Ident, Stmt, StmtKind};
use super::super::movement::Wait;
use super::super::value::{Datum, Dependence, Origin, Value};
use super::{Cell, Executor, MAX_PASSES, MAX_STATEMENTS};
use crate::text::Span;

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
    /// `RAISE` at this place.
    Raised(Span),
    /// `GOTO` a label that is not in the list itself.
    Jump(Ident),
    /// `TRYNEXT` or `RETRY`: the end of a handler.
    Resume,
}

/// A condition, as far as it is known.
enum Condition {
    Known(bool),
    /// It depends on inputs at assumed levels.
    Assumed(bool),
    /// And why, in brackets.
    Unknown(String),
}

impl Executor<'_> {
    pub(super) fn block(&mut self, block: &Block) -> Flow {
        let mut index = 0;
        while let Some(stmt) = block.get(index) {
            index += 1;
            match self.statement(stmt) {
                Flow::Next => {}
                Flow::Jump(label) => match find_label(block, &label) {
                    Some(at) if at < index && is_endless(stmt, &block[at..index - 1]) => {
                        self.unresolved(stmt.span, ENDLESS);
                    }
                    Some(at) => index = at,
                    None => return Flow::Jump(label),
                },
                other => return other,
            }
        }
        Flow::Next
    }

    fn statement(&mut self, stmt: &Stmt) -> Flow {
        self.statements += 1;
        if self.machine.is_full() || self.statements > MAX_STATEMENTS {
            let why = self.machine.full_because();
            let why = why.unwrap_or_else(|| "the program does not end".into());
            self.unresolved(stmt.span, format!("{why}: the cycle is shown up to here"));
            return Flow::Exit;
        }
        match &stmt.kind {
            StmtKind::Assign { target, value } => {
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
            StmtKind::Goto(label) => Flow::Jump(label.clone()),
            StmtKind::Return(value) => {
                let value = value.as_ref().map(|expr| self.eval(expr));
                Flow::Return(value)
            }
            StmtKind::Raise(_) => Flow::Raised(stmt.span),
            StmtKind::Exit => Flow::Exit,
            StmtKind::Retry | StmtKind::TryNext => Flow::Resume,
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
        let reading = match data.kind {
            super::super::hir::DataKind::Const => Origin::default(),
            _ => Origin::of(Dependence::Variable(data.name.text.as_str().into())),
        };
        let read_only = data.kind == super::super::hir::DataKind::Const;
        self.cells.push(Cell { value, reading, read_only, alias: None });
        let cell = self.cells.len() - 1;
        self.frame_mut().names.push((data.name.key.clone(), cell));
    }

    fn if_statement(&mut self, branches: &[(Expr, Block)], otherwise: Option<&Block>) -> Flow {
        for (condition, block) in branches {
            match self.condition(condition) {
                Condition::Known(false) => {}
                Condition::Assumed(false) => self.note_branch(condition, "FALSE", Some(block)),
                Condition::Known(true) => return self.block(block),
                Condition::Assumed(true) => {
                    self.note_branch(condition, "TRUE", otherwise);
                    return self.block(block);
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
            Some(block) => self.block(block),
            None => Flow::Next,
        }
    }

    /// Tells which way an `IF` on inputs went and what the other way holds, if anything moves or
    /// waits there.
    fn note_branch(&mut self, condition: &Expr, taken: &str, left_out: Option<&Block>) {
        let calls = left_out.map_or(0, |block| calls(block));
        if calls == 0 {
            return;
        }
        let what = if calls == 1 { "instruction" } else { "instructions" };
        let state = match self.first_signal(condition) {
            Some(signal) => format!("--assume {signal}=LEVEL states another"),
            None => "--assume SIGNAL=LEVEL states another".to_owned(),
        };
        self.unresolved(
            condition.span,
            format!(
                "depends on inputs, taken as {taken}: the other branch ({calls} {what}) was not \
                 run; {state}"
            ),
        );
    }

    fn condition(&mut self, expr: &Expr) -> Condition {
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

    fn for_statement(
        &mut self,
        stmt: &Stmt,
        var: &Ident,
        (from, to, step): (&Expr, &Expr, Option<&Expr>),
        body: &Block,
    ) -> Flow {
        let from = self.eval(from).datum.num();
        let to = self.eval(to).datum.num();
        let step = match step {
            Some(expr) => self.eval(expr).datum.num(),
            None => None,
        };
        let (Some(from), Some(to)) = (from, to) else {
            self.unresolved(stmt.span, "the bounds of the loop are not known: it was passed over");
            return Flow::Next;
        };
        // Without STEP the loop counts towards its end.
        let step = step.unwrap_or(if to >= from { 1.0 } else { -1.0 });
        if step == 0.0 || !step.is_finite() {
            self.unresolved(stmt.span, "STEP 0: the loop was passed over");
            return Flow::Next;
        }
        self.cells.push(Cell {
            value: Value::constant(Datum::Num(from), "num"),
            reading: Origin::of(Dependence::Local(var.text.as_str().into())),
            read_only: true,
            alias: None,
        });
        let cell = self.cells.len() - 1;
        self.frame_mut().names.push((var.key.clone(), cell));
        let depth = self.frame().names.len();
        let mut flow = Flow::Next;
        for pass in 0..MAX_PASSES {
            let x = from + f64::from(pass) * step;
            if (step > 0.0 && x > to) || (step < 0.0 && x < to) {
                break;
            }
            self.cells[cell].value = Value::constant(Datum::Num(x), "num");
            flow = self.block(body);
            self.frame_mut().names.truncate(depth);
            if !matches!(flow, Flow::Next) {
                break;
            }
        }
        self.frame_mut().names.truncate(depth - 1);
        flow
    }

    fn while_statement(&mut self, stmt: &Stmt, condition: &Expr, body: &Block) -> Flow {
        for pass in 0..MAX_PASSES {
            match self.condition(condition) {
                Condition::Known(false) | Condition::Assumed(false) => return Flow::Next,
                Condition::Known(true) if is_always_true(condition) => {
                    let passes = self.machine.passes().max(1);
                    if passes == 1 {
                        self.unresolved(stmt.span, ENDLESS);
                    } else {
                        let text = format!("an endless loop: simulated for {passes} passes");
                        self.unresolved(stmt.span, text);
                    }
                    self.machine.repeats();
                    for _ in 0..passes {
                        let depth = self.frame().names.len();
                        let flow = self.block(body);
                        self.frame_mut().names.truncate(depth);
                        if !matches!(flow, Flow::Next) {
                            return flow;
                        }
                    }
                    // What stands behind the loop never runs.
                    return Flow::Exit;
                }
                Condition::Known(true) => {}
                Condition::Assumed(true) => {
                    // A loop that polls an input is a wait for it.
                    let signal = self.first_signal(condition);
                    self.machine.waits(Wait {
                        instruction: "WHILE".into(),
                        span: condition.span,
                        routine: self.frame().routine.clone(),
                        duration: None,
                        signal,
                        other: None,
                        grip_load: self.settings.grip_load,
                    });
                    return Flow::Next;
                }
                Condition::Unknown(why) => {
                    self.unresolved(
                        condition.span,
                        format!("the condition of the loop is not known{why}: passed over"),
                    );
                    return Flow::Next;
                }
            }
            let depth = self.frame().names.len();
            let flow = self.block(body);
            self.frame_mut().names.truncate(depth);
            if !matches!(flow, Flow::Next) {
                return flow;
            }
            if pass + 1 == MAX_PASSES {
                self.unresolved(stmt.span, "the loop does not end; it was left here");
            }
        }
        Flow::Next
    }

    fn test_statement(
        &mut self,
        value: &Expr,
        cases: &[(Vec<Expr>, Block)],
        default: Option<&Block>,
    ) -> Flow {
        let tested = self.eval(value);
        let tested = self.level(tested);
        if let Some(unknown) = tested.datum.first_unknown() {
            let reason = format!("the TEST value is not known ({})", unknown.reason);
            self.unresolved(value.span, reason);
        } else {
            for (values, block) in cases {
                for expr in values {
                    if self.eval(expr).datum == tested.datum {
                        return self.block(block);
                    }
                }
            }
        }
        match default {
            Some(block) => self.block(block),
            None => Flow::Next,
        }
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
fn never_leaves(block: &[Stmt]) -> bool {
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

fn is_always_true(condition: &Expr) -> bool {
    use super::super::hir::ExprKind;
    matches!(condition.kind, ExprKind::Bool(true) | ExprKind::Num(_))
}

/// A number as RAPID text that reads back as the same number.
pub(super) fn number_text(x: f64) -> String {
    format!("{x}")
}
