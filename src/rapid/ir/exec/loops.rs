//! `FOR` and `WHILE`.

use super::branches::Condition;
use super::executor::{Cell, Executor, MAX_PASSES, Poll};
use super::flow::{Flow, never_leaves};
use super::polling::{Mark, Pass};
use crate::rapid::ir::hir::{Block, Expr, ExprKind, Ident, Stmt};
use crate::rapid::ir::value::{Datum, Dependence, Origin, Value};

impl Executor<'_> {
    pub(super) fn for_statement(
        &mut self,
        stmt: &Stmt,
        var: &Ident,
        (from, to, step): (&Expr, &Expr, Option<&Expr>),
        body: &Block,
    ) -> Flow {
        let from = self.eval(from).datum.num();
        let to = self.eval(to).datum.num();
        let step = step.and_then(|expr| self.eval(expr).datum.num());
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
        let reading = Origin::of(Dependence::Local(var.text.as_str().into()));
        let value = Value::constant(Datum::Num(from), "num");
        let cell = self.new_cell(Cell { read_only: true, ..Cell::new(value, reading) });
        let depth = self.frame().names.len();
        self.frame_mut().names.push((var.key.clone(), cell));
        let mut watched = self.watch(body);
        let mut flow = Flow::Next;
        let mut pass = 0.0;
        loop {
            let x = from + pass * step;
            if (step > 0.0 && x > to) || (step < 0.0 && x < to) {
                break;
            }
            if pass >= f64::from(MAX_PASSES) || self.is_over(stmt.span) {
                if pass >= f64::from(MAX_PASSES) {
                    self.unresolved(stmt.span, "the loop has too many passes; it was left here");
                }
                flow = if self.machine.is_at_limit() { Flow::Exit } else { Flow::Next };
                break;
            }
            self.cells[cell].value = Value::constant(Datum::Num(x), "num");
            flow = self.loop_body(body);
            if !matches!(flow, Flow::Next) {
                break;
            }
            if let Some(mark) = &mut watched {
                let left = ((to - x) / step).floor().max(0.0);
                if matches!(self.pass(mark, "FOR", None, Some(left)), Pass::TimedOut) {
                    break;
                }
            }
            pass += 1.0;
        }
        if watched.is_some() {
            self.unwatch();
        }
        self.frame_mut().names.truncate(depth);
        flow
    }

    /// Runs one pass; the data that it declares end with it.
    fn loop_body(&mut self, body: &Block) -> Flow {
        let depth = self.frame().names.len();
        let flow = self.block(body);
        self.frame_mut().names.truncate(depth);
        flow
    }

    /// A mark for a loop that its body can leave: only such a loop can end because of an input.
    fn watch(&mut self, body: &Block) -> Option<Mark> {
        if never_leaves(body) {
            return None;
        }
        self.watchers += 1;
        Some(self.mark())
    }

    /// Runs the body of `WHILE TRUE`, which only a statement of the body can leave.
    fn endless(&mut self, stmt: &Stmt, body: &Block) -> Flow {
        let passes = self.machine.endless_loop_passes().max(1);
        self.machine.on_endless_loop();
        let mut watched = self.watch(body);
        let mut flow = Flow::Next;
        let mut pass = 0;
        while pass < passes {
            if self.is_over(stmt.span) {
                flow = Flow::Exit;
                break;
            }
            flow = self.loop_body(body);
            if !matches!(flow, Flow::Next) {
                break;
            }
            // A pass that waited for an input and its repetition count as one.
            let again = watched
                .as_mut()
                .is_some_and(|mark| matches!(self.pass_at_rest(mark), Pass::InputChanged));
            pass += u32::from(!again);
        }
        if watched.is_some() {
            self.unwatch();
        }
        match flow {
            Flow::Next => {
                let plural = if passes == 1 { "pass" } else { "passes" };
                let passes = if passes == 1 { "one".to_owned() } else { passes.to_string() };
                let text = format!("an endless loop: simulated for {passes} {plural}");
                self.unresolved(stmt.span, text);
                // The statements after the loop never run.
                Flow::Exit
            }
            Flow::Exit => Flow::Exit,
            other => {
                self.machine.on_loop_left();
                other
            }
        }
    }

    /// [`Executor::pass`] for a loop that counts as a wait only while the robot stands still.
    fn pass_at_rest(&mut self, mark: &mut Mark) -> Pass {
        if mark.has_moved(self) {
            *mark = self.mark();
            return Pass::Ordinary;
        }
        self.pass(mark, "WHILE", None, None)
    }

    pub(super) fn while_statement(&mut self, stmt: &Stmt, condition: &Expr, body: &Block) -> Flow {
        self.watchers += 1;
        let flow = self.while_passes(stmt, condition, body);
        self.unwatch();
        flow
    }

    fn while_passes(&mut self, stmt: &Stmt, condition: &Expr, body: &Block) -> Flow {
        let mut mark = self.mark();
        for pass in 0..MAX_PASSES {
            if self.is_over(stmt.span) {
                return Flow::Exit;
            }
            let mut decided = None;
            match self.condition(condition) {
                Condition::Known(false) | Condition::Assumed(false) => return Flow::Next,
                Condition::Known(true) if is_always_true(condition) => {
                    return self.endless(stmt, body);
                }
                Condition::Known(true) => {}
                Condition::Assumed(true) if self.may_move(body) => {
                    decided = Some(Poll { condition: condition.clone(), value: true });
                }
                Condition::Assumed(true) => {
                    // A loop that only polls an input is a wait for it.
                    self.wait_for("WHILE", (condition, false), None);
                    self.invert_condition(&Poll { condition: condition.clone(), value: true });
                    self.forced = None;
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
            let flow = self.loop_body(body);
            if !matches!(flow, Flow::Next) {
                return flow;
            }
            // The body may poll an input and set the data of the condition from it.
            let at_rest = decided.is_none().then(|| self.pass_at_rest(&mut mark));
            if decided.is_some()
                && !matches!(self.pass(&mut mark, "WHILE", decided, None), Pass::Waiting)
            {
                self.forced = None;
                return Flow::Next;
            }
            if matches!(at_rest, Some(Pass::Endless)) || pass + 1 == MAX_PASSES {
                self.unresolved(stmt.span, "the loop does not end; it was left here");
                return Flow::Next;
            }
        }
        Flow::Next
    }
}

fn is_always_true(condition: &Expr) -> bool {
    matches!(condition.kind, ExprKind::Bool(true) | ExprKind::Num(_))
}
