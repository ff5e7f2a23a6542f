//! Loops that poll an input.
//!
//! A pass that neither moves the robot nor changes data repeats unchanged until an input
//! changes: the loop is a wait for that input. A pass that moves runs until the input changes,
//! or once if the time of the change is unknown.

use std::sync::Arc;

use super::executor::{CellId, Executor, MAX_CALL_DEPTH, Poll};
use super::machine::WaitResult;
use crate::rapid::builtins::{self, Instruction};
use crate::rapid::ir::hir::{Block, Call, Callee, Expr, ExprKind, Stmt, StmtKind};
use crate::rapid::ir::program::Symbol;
use crate::rapid::ir::value::Datum;
use crate::rapid::ir::walk::statements;

/// Number of waits after which a loop counts as endless.
const MAX_WAITS: u32 = 20;
/// Number of passes after which a loop that polls an input and changes data counts as a wait.
const MAX_COUNTED: u32 = 1000;

/// Largest number of inputs of a condition for which their order in time is considered.
const MAX_TOGETHER: usize = 6;

/// The state at the start of a pass.
pub(super) struct Mark {
    polls: usize,
    stamp: u64,
    moves: u64,
    waited_s: f64,
    passes: u32,
    waits: u32,
}

impl Mark {
    /// Whether the program has moved the robot since.
    pub(super) fn has_moved(&self, executor: &Executor<'_>) -> bool {
        executor.moves != self.moves
    }
}

/// The kind of a pass.
pub(super) enum Pass {
    /// The loop continues for a reason other than an input.
    Ordinary,
    /// The input has not changed: another pass follows.
    Waiting,
    /// The last pass: the input has changed.
    InputChanged,
    /// The last pass: the loop ended before the input changed.
    TimedOut,
    /// The loop does not end.
    Endless,
}

impl Executor<'_> {
    /// The mark at the start of the first pass.
    pub(super) fn mark(&self) -> Mark {
        Mark {
            polls: self.polls.len(),
            stamp: self.stamp,
            moves: self.moves,
            waited_s: self.waited_s,
            passes: 0,
            waits: 0,
        }
    }

    /// Classifies the pass since the mark and sets the mark for the next. `decided`: the condition
    /// on inputs that led back, if any; after `passes_left` more passes the loop ends.
    pub(super) fn pass(
        &mut self,
        mark: &mut Mark,
        instruction: &str,
        decided: Option<Poll>,
        passes_left: Option<f64>,
    ) -> Pass {
        let polls = self.polls.split_off(mark.polls.min(self.polls.len()));
        let moved = self.moves != mark.moves;
        let changed = self.changed_outside.max(self.frame().changed) > mark.stamp;
        let took = self.waited_s - mark.waited_s;
        *mark = Mark { passes: mark.passes + 1, waits: mark.waits, ..self.mark() };
        let counts = changed && mark.passes < MAX_COUNTED && decided.is_none();
        let mut asked: Vec<Poll> = decided.into_iter().collect();
        if asked.is_empty() {
            asked = polls;
        }
        if asked.is_empty() {
            let same = !changed && passes_left.is_none();
            return if same { Pass::Endless } else { Pass::Ordinary };
        }
        // Among several inputs, one with a known time decides.
        let mut coming: Option<(usize, bool)> = None;
        for (i, poll) in asked.iter().enumerate() {
            if let Some(signal) = self.deciding_signal(&poll.condition, !poll.value)
                && let Some(come) = self.machine.input_has_changed(&signal)
                && coming.is_none_or(|(_, before)| come && !before)
            {
                coming = Some((i, come));
            }
        }
        let poll = asked.swap_remove(coming.map_or(0, |(i, _)| i));
        match coming {
            Some((_, true)) => return self.input_changed(mark, &poll),
            Some((_, false)) if moved || counts => return Pass::Waiting,
            // A counted loop with movements is work, not a wait.
            None if counts || (moved && passes_left.is_some()) => return Pass::Ordinary,
            _ => {}
        }
        let signal = self.first_signal(&poll.condition);
        if moved {
            let name = signal.as_deref().unwrap_or("an input");
            let hint = signal.as_ref().map(|name| format!(" (--input {name}=SECONDS states it)"));
            let reason = format!(
                "moves until {name} changes, at a time that is not known: taken as during the \
                 first pass{}",
                hint.unwrap_or_default()
            );
            self.unresolved(poll.condition.span, reason);
            return self.input_changed(mark, &poll);
        }
        let max_time = passes_left.map(|passes| passes * took);
        match self.wait_for(instruction, (&poll.condition, !poll.value), max_time) {
            WaitResult::Ended => self.input_changed(mark, &poll),
            WaitResult::TimedOut => Pass::TimedOut,
        }
    }

    fn input_changed(&mut self, mark: &mut Mark, poll: &Poll) -> Pass {
        mark.waits += 1;
        if mark.waits > MAX_WAITS {
            return Pass::Endless;
        }
        self.invert_condition(poll);
        Pass::InputChanged
    }

    /// Sets an input of the condition to a level that inverts the condition.
    pub(super) fn invert_condition(&mut self, poll: &Poll) {
        let mut signals = Vec::new();
        let mut levels = vec![1.0, 0.0];
        self.collect_signals(&poll.condition, &mut signals, &mut levels);
        for signal in signals {
            let key = signal.to_lowercase();
            let before = self.signals.get(&key).copied();
            for level in &levels {
                self.signals.insert(key.clone(), *level);
                if self.condition_value(&poll.condition) == Some(!poll.value) {
                    return;
                }
            }
            match before {
                Some(level) => self.signals.insert(key, level),
                None => self.signals.remove(&key),
            };
        }
        self.forced = Some(poll.condition.span);
    }

    /// The input whose change brings the condition to `wanted`, if its inputs change once in the
    /// order of their times; else the first signal of the condition.
    pub(super) fn deciding_signal(&mut self, condition: &Expr, wanted: bool) -> Option<Arc<str>> {
        let first = self.first_signal(condition);
        let mut signals: Vec<Arc<str>> = Vec::new();
        self.collect_signals(condition, &mut signals, &mut Vec::new());
        signals.sort_by_key(|signal| signal.to_lowercase());
        signals.dedup_by_key(|signal| signal.to_lowercase());
        if signals.len() < 2 || signals.len() > MAX_TOGETHER {
            return first;
        }
        let mut coming: Vec<(f64, Arc<str>)> = Vec::new();
        for signal in signals {
            // An input without a stated time counts as changing at once.
            let at = self.machine.input_change_time(&signal).unwrap_or(f64::NEG_INFINITY);
            coming.push((at, signal));
        }
        coming.sort_by(|a, b| a.0.total_cmp(&b.0));
        let before = self.signals.clone();
        let decides = self.last_needed(condition, wanted, &coming);
        self.signals = before;
        decides.map(|i| coming[i].1.clone()).or(first)
    }

    /// Index of the input whose change brings the condition to `wanted`, if they change in order.
    fn last_needed(
        &mut self,
        condition: &Expr,
        wanted: bool,
        coming: &[(f64, Arc<str>)],
    ) -> Option<usize> {
        // The levels after the changes; all high first, the most common condition.
        for target in (0..1_u32 << coming.len()).rev() {
            let level = |i: usize, come: bool| f64::from(u8::from((target >> i & 1 == 1) == come));
            for (i, (_, signal)) in coming.iter().enumerate() {
                self.signals.insert(signal.to_lowercase(), level(i, false));
            }
            if self.condition_value(condition) != Some(!wanted) {
                continue;
            }
            for (i, (_, signal)) in coming.iter().enumerate() {
                self.signals.insert(signal.to_lowercase(), level(i, true));
                if self.condition_value(condition) == Some(wanted) {
                    return Some(i);
                }
            }
        }
        None
    }

    /// The value of a condition at the current signal levels.
    fn condition_value(&mut self, condition: &Expr) -> Option<bool> {
        match self.eval_level(condition).datum {
            Datum::Bool(b) => Some(b),
            Datum::Num(x) => Some(x != 0.0),
            _ => None,
        }
    }

    /// Collects the signals of an expression, and its numbers and their neighbours as trial levels.
    fn collect_signals(&mut self, expr: &Expr, signals: &mut Vec<Arc<str>>, levels: &mut Vec<f64>) {
        match &expr.kind {
            ExprKind::Num(x) => levels.extend([*x, x + 1.0, x - 1.0]),
            ExprKind::Ref(_) => match self.eval(expr).datum {
                Datum::Signal(signal) => signals.push(signal),
                Datum::Num(x) => levels.extend([x, x + 1.0, x - 1.0]),
                _ => {}
            },
            _ => {
                for operand in expr.operands() {
                    self.collect_signals(operand, signals, levels);
                }
            }
        }
    }

    /// Whether these statements may move the robot.
    pub(super) fn may_move(&self, block: &Block) -> bool {
        self.block_moves(self.frame().module, block, 0)
    }

    fn block_moves(&self, module: usize, block: &[Stmt], depth: usize) -> bool {
        statements(block).any(|stmt| match &stmt.kind {
            StmtKind::Call(call) => self.call_moves(module, call, depth),
            _ => false,
        })
    }

    fn call_moves(&self, module: usize, call: &Call, depth: usize) -> bool {
        let Callee::Name(name) = &call.callee else { return true };
        match self.program.resolve(module, &name.key) {
            Some(Symbol::Routine(id)) if depth < MAX_CALL_DEPTH => {
                self.block_moves(id.module, &self.program.routine(id).body, depth + 1)
            }
            Some(_) => true,
            None => builtins::instruction(&name.key).is_none_or(Instruction::may_move),
        }
    }

    /// Records a change of the data in a cell, or of a signal.
    pub(super) fn record_change(&mut self, cell: Option<CellId>) {
        self.stamp += 1;
        let stamp = self.stamp;
        let frame = self.frame_mut();
        let own = cell.is_some_and(|cell| {
            cell >= frame.base && frame.names.iter().any(|(_, known)| *known == cell)
        });
        if own {
            frame.changed = stamp;
        } else {
            self.changed_outside = stamp;
        }
    }

    /// Gives a signal a level.
    pub(super) fn set_level(&mut self, signal: &str, level: f64) {
        if self.signals.insert(signal.to_lowercase(), level) != Some(level) {
            self.record_change(None);
        }
    }
}
