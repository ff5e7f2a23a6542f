//! `IF` and `TEST`: which branch is taken, and the notes on the branches that are not.

use std::sync::Arc;

use super::executor::{Executor, Poll};
use super::flow::{Flow, number_text};
use super::operators::equal;
use crate::rapid::ir::hir::{Block, Expr, Stmt, StmtKind};
use crate::rapid::ir::value::Datum;
use crate::rapid::ir::walk::statements;

/// The value of a condition.
pub(super) enum Condition {
    Known(bool),
    /// It depends on inputs at assumed levels.
    Assumed(bool),
    /// Unknown, with the reason in parentheses.
    Unknown(String),
}

impl Executor<'_> {
    pub(super) fn if_statement(
        &mut self,
        branches: &[(Expr, Block)],
        otherwise: Option<&Block>,
    ) -> Flow {
        // The last condition on inputs: its value decides whether a GOTO is reached.
        let mut decided = None;
        let mut input = None;
        for (condition, block) in branches {
            let is = self.condition(condition);
            input = self.seen_input.clone().or(input);
            let (value, is_assumed) = match is {
                Condition::Known(value) => (value, false),
                Condition::Assumed(value) => (value, true),
                Condition::Unknown(why) => {
                    let reason = format!("the condition is not known{why}: taken as FALSE");
                    self.unresolved(condition.span, reason);
                    continue;
                }
            };
            if is_assumed || self.seen_input.is_some() {
                let (taken, other) =
                    if value { ("TRUE", otherwise) } else { ("FALSE", Some(block)) };
                self.note_branch(condition, taken, other);
            }
            if is_assumed {
                decided = Some(Poll { condition: condition.clone(), value });
            }
            if value {
                return decided_by(decided, self.branch(input, block));
            }
        }
        match otherwise {
            Some(block) => decided_by(decided, self.branch(input, block)),
            None => Flow::Next,
        }
    }

    /// Runs a block; the data that it assigns depend on `input`, which decided that it runs.
    fn branch(&mut self, input: Option<Arc<str>>, block: &Block) -> Flow {
        let depth = self.deciding.len();
        self.deciding.extend(input);
        let flow = self.block(block);
        self.deciding.truncate(depth);
        flow
    }

    /// Marks the data that a skipped block would have assigned: they depend on the deciding input.
    fn mark_skipped(&mut self, block: &Block) {
        for stmt in statements(block) {
            if let StmtKind::Assign { target, .. } = &stmt.kind
                && let Some(cell) = target.base().and_then(|name| self.cell_of(name))
            {
                self.cells[cell].input.clone_from(&self.seen_input);
            }
        }
    }

    /// Notes the assumed value of an `IF` on inputs, if the other branch contains instructions.
    fn note_branch(&mut self, condition: &Expr, taken: &str, left_out: Option<&Block>) {
        let Some(block) = left_out else { return };
        self.mark_skipped(block);
        let calls = calls(block);
        if calls == 0 {
            return;
        }
        let what = if calls == 1 { "instruction" } else { "instructions" };
        let state = self.assume_hint(condition);
        let reason = format!(
            "depends on inputs, taken as {taken}: the other branch ({calls} {what}) was not run; \
             {state}"
        );
        self.unresolved(condition.span, reason);
    }

    fn assume_hint(&mut self, expr: &Expr) -> String {
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
        let value = self.eval_level(expr);
        let input = value.origin.has_input();
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

    pub(super) fn test_statement(
        &mut self,
        value: &Expr,
        cases: &[(Vec<Expr>, Block)],
        default: Option<&Block>,
    ) -> Flow {
        self.seen_input = None;
        let tested = self.eval_level(value);
        let input = self.seen_input.clone();
        let mut taken = None;
        if let Some(unknown) = tested.datum.first_unknown() {
            let reason = &unknown.reason;
            let what = if default.is_some() { "DEFAULT is taken" } else { "no CASE is taken" };
            let reason = format!("the TEST value is not known ({reason}): {what}");
            self.unresolved(value.span, reason);
        } else {
            let mut is_tested = |expr| equal(&self.eval_level(expr).datum, &tested.datum);
            taken = cases.iter().position(|(values, _)| values.iter().any(&mut is_tested));
            if input.is_some() {
                self.seen_input.clone_from(&input);
                self.note_case(value, &tested.datum, taken, cases, default);
            }
        }
        match taken.map(|case| &cases[case].1).or(default) {
            Some(block) => self.branch(input, block),
            None => Flow::Next,
        }
    }

    /// Notes the assumed value of a `TEST` on inputs, if the other branches contain instructions.
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
            self.mark_skipped(block);
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
        let state = self.assume_hint(value);
        let reason = format!(
            "depends on inputs, taken as {level}: {} other {branches} ({count} {what}) not run; \
             {state}",
            left_out.len()
        );
        self.unresolved(value.span, reason);
    }
}

/// Attaches the deciding condition to a `GOTO` that leaves a branch.
fn decided_by(decided: Option<Poll>, flow: Flow) -> Flow {
    match flow {
        Flow::Jump(label, None) => Flow::Jump(label, decided.map(Box::new)),
        other => other,
    }
}

/// Number of instructions and calls in a block, inner blocks included.
fn calls(block: &[Stmt]) -> usize {
    statements(block).filter(|stmt| matches!(stmt.kind, StmtKind::Call(_))).count()
}
