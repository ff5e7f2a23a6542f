//! Instructions that wait.

use std::sync::Arc;

use super::arguments::Arguments;
use super::executor::Executor;
use super::flow::{Flow, Raised, number_text};
use super::machine::WaitResult;
use crate::rapid::builtins::{self, MoveForm};
use crate::rapid::ir::hir::{BinaryOp, Expr, ExprKind, Stmt};
use crate::rapid::ir::movement::Wait;
use crate::rapid::ir::value::{Datum, Value};
use crate::rapid::text::Span;

/// How long a wait lasts.
pub(super) enum Length {
    /// s, from literals and constants only, with the argument: the same at every execution.
    Constant(f64, Span),
    /// s.
    Stated(f64),
    /// Until an input changes; none if the condition names no input.
    Until(Option<Arc<str>>),
    /// Of unknown length, with the cause in words.
    Unknown(String),
}

impl Executor<'_> {
    pub(super) fn wait_time(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let value = arguments.positional.first().map(|expr| self.eval(expr));
        let constant = value.as_ref().is_some_and(|value| value.origin.iter().next().is_none());
        let datum = value.map(|value| value.datum);
        // `WaitTime 0` and `WaitTime \InPos, 0` wait only for standstill.
        let length = match datum {
            Some(Datum::Num(time)) if time < 0.0 => {
                self.unresolved(
                    stmt.span,
                    "waits for a negative time, which is an error on the controller: taken as 0 s",
                );
                Length::Stated(0.0)
            }
            Some(Datum::Num(time)) if time.is_finite() && constant => {
                let argument = arguments.positional.first().map_or(stmt.span, |expr| expr.span);
                Length::Constant(time, argument)
            }
            Some(Datum::Num(time)) if time.is_finite() => Length::Stated(time),
            Some(Datum::Num(_)) => Length::Unknown("a time that is out of range".into()),
            Some(Datum::Unknown(why)) => {
                Length::Unknown(format!("a time that is not known ({})", why.reason))
            }
            _ => Length::Unknown("a time that is not known".into()),
        };
        self.wait(stmt.span, text, length, None);
    }

    pub(super) fn wait_signal(
        &mut self,
        stmt: &Stmt,
        text: &str,
        arguments: &Arguments<'_>,
    ) -> Flow {
        let signal = arguments.positional.first().and_then(|expr| self.first_signal(expr));
        let flow = self.wait_at_most(stmt, text, Length::Until(signal.clone()), arguments);
        if let (Ok(()), Some(signal), Some(value)) = (&flow, signal, arguments.positional.get(1))
            && let Some(level) = self.eval_level(value).datum.num()
        {
            self.set_level(&signal, level);
        }
        flow.err().unwrap_or(Flow::Next)
    }

    /// A wait with optional `\MaxTime` and `\TimeFlag`. `Err` holds the flow after a timeout.
    fn wait_at_most(
        &mut self,
        stmt: &Stmt,
        text: &str,
        length: Length,
        arguments: &Arguments<'_>,
    ) -> Result<(), Flow> {
        let max_time = arguments.option_value("maxtime").and_then(|expr| {
            let time = self.eval(expr).datum.num().filter(|time| time.is_finite());
            if time.is_none() {
                let reason = "\\MaxTime is not known: taken as long enough";
                self.unresolved(stmt.span, reason);
            }
            time.map(|time| time.max(0.0))
        });
        let waited = self.wait(stmt.span, text, length, max_time);
        let timed_out = waited == WaitResult::TimedOut;
        if let Some(flag) = arguments.option_value("timeflag") {
            self.seen_input = None;
            self.assign(flag, Value::constant(Datum::Bool(timed_out), "bool"));
            return if timed_out { Err(Flow::Next) } else { Ok(()) };
        }
        if !timed_out {
            return Ok(());
        }
        let reason = format!(
            "{text} times out after {} s, before what it waits for comes: ERR_WAIT_MAXTIME",
            number_text(max_time.unwrap_or_default())
        );
        self.unresolved(stmt.span, reason);
        let error = Some("ERR_WAIT_MAXTIME".into());
        Err(Flow::Raised(Raised { at: stmt.span, error, leaves: false }))
    }

    pub(super) fn wait_until(
        &mut self,
        stmt: &Stmt,
        text: &str,
        arguments: &Arguments<'_>,
    ) -> Flow {
        let condition = arguments.positional.first().copied();
        let signal = condition.and_then(|expr| self.deciding_signal(expr, true));
        if let Some(condition) = condition {
            let value = self.eval_level(condition);
            if value.datum == Datum::Bool(true) && !value.origin.has_input() {
                let flow = self.wait_at_most(stmt, text, Length::Stated(0.0), arguments);
                return flow.err().unwrap_or(Flow::Next);
            }
        }
        if let Err(flow) = self.wait_at_most(stmt, text, Length::Until(signal), arguments) {
            return flow;
        }
        if let Some(condition) = condition {
            self.set_awaited_levels(condition);
        }
        Flow::Next
    }

    /// Sets the signals to the levels that the condition of the finished wait requires.
    fn set_awaited_levels(&mut self, condition: &Expr) {
        match &condition.kind {
            ExprKind::Binary(BinaryOp::And, left, right) => {
                self.set_awaited_levels(left);
                self.set_awaited_levels(right);
            }
            ExprKind::Binary(BinaryOp::Eq, left, right) => {
                for (a, b) in [(left, right), (right, left)] {
                    if let Some(signal) = self.first_signal(a)
                        && let Some(level) = self.eval(b).datum.num()
                    {
                        self.set_level(&signal, level);
                        return;
                    }
                }
            }
            _ => {}
        }
    }

    /// A wait for the inputs of a condition.
    pub(super) fn wait_for(
        &mut self,
        instruction: &str,
        (condition, wanted): (&Expr, bool),
        max_time: Option<f64>,
    ) -> WaitResult {
        let signal = self.deciding_signal(condition, wanted);
        self.wait(condition.span, instruction, Length::Until(signal), max_time)
    }

    pub(super) fn wait(
        &mut self,
        span: Span,
        text: &str,
        length: Length,
        max_time: Option<f64>,
    ) -> WaitResult {
        let routine = self.frame().routine.clone();
        let constant = match length {
            Length::Constant(_, argument) => Some(argument),
            _ => None,
        };
        let (duration, signal, other) = match length {
            Length::Constant(duration, _) | Length::Stated(duration) => {
                self.waited_s += duration;
                (Some(duration), None, None)
            }
            Length::Until(signal) => (None, signal, None),
            Length::Unknown(what) => (None, None, Some(what)),
        };
        let moves = builtins::movement(&text.to_lowercase())
            .is_some_and(|signature| signature.form == MoveForm::ExternalJoint);
        let external = self.external_axes.as_deref().filter(|_| moves);
        let external = external.and_then(|axes| axes.try_into().ok());
        self.machine.on_wait(Wait {
            instruction: text.into(),
            span,
            routine,
            call: self.frame().call.clone(),
            duration,
            constant,
            max_time,
            signal,
            other,
            grip_load: self.settings.grip_load,
            external,
        })
    }
}
