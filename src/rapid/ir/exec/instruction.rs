//! RAPID instructions: the dispatch by effect, outputs and counters.

use std::sync::Arc;

use super::arguments::Arguments;
use super::executor::{Cell, Executor};
use super::flow::{Flow, number_text};
use super::waits::Length;
use crate::rapid::builtins::{self, ArgumentPlace, Count, Effect, Instruction, Level, Wait};
use crate::rapid::ir::hir::{Arg, Expr, ExprKind, Stmt};
use crate::rapid::ir::movement::Output;
use crate::rapid::ir::value::{Datum, Dependence, Origin, Value};
use crate::rapid::ir::walk::arguments_with_places;

impl Executor<'_> {
    /// A call of a routine that the program does not declare.
    pub(super) fn instruction(&mut self, stmt: &Stmt, key: &str, text: &str, args: &[Arg]) -> Flow {
        let Some(instruction) = builtins::instruction(key) else {
            self.unknown(stmt, text, args);
            return Flow::Next;
        };
        let arguments = Arguments::new(self, args);
        if let Some(signature) = builtins::movement(key) {
            self.movement(stmt, text, signature, &arguments);
            return Flow::Next;
        }
        match instruction.effect {
            Effect::Wait(Wait::Time) => self.wait_time(stmt, text, &arguments),
            Effect::Wait(Wait::Input | Wait::Output) => {
                return self.wait_signal(stmt, text, &arguments);
            }
            Effect::Wait(Wait::Condition) => return self.wait_until(stmt, text, &arguments),
            Effect::Wait(Wait::Standstill) => {
                self.wait(stmt.span, text, Length::Stated(0.0), None);
            }
            Effect::Wait(wait @ (Wait::Operator | Wait::Outside)) => {
                self.written(text, instruction, args);
                if wait == Wait::Operator {
                    self.answered(args);
                }
                // The program does not state how long.
                self.wait(stmt.span, text, Length::Until(None), None);
            }
            Effect::Output(level) => self.output(stmt, text, level, &arguments),
            Effect::ZoneOutput => self.zone_output(instruction, &arguments),
            Effect::Count(count) => self.count(count, &arguments),
            Effect::Stop | Effect::ExitCycle => {
                self.unresolved(stmt.span, format!("{text}: taken as passed"));
                if instruction.effect == Effect::ExitCycle {
                    return Flow::Exit;
                }
            }
            Effect::Setting(setting) => self.setting(stmt, text, setting, &arguments),
            Effect::Unmodelled => self.unmodelled(stmt, text),
            Effect::Ends(names) => self.clear_unmodelled(names),
            Effect::Nothing | Effect::FindsByName if !instruction.is_known() => {
                self.unknown(stmt, text, args);
            }
            Effect::Nothing | Effect::FindsByName => self.written(text, instruction, args),
        }
        Flow::Next
    }

    /// A routine that is neither declared nor built in.
    fn unknown(&mut self, stmt: &Stmt, text: &str, args: &[Arg]) {
        self.mark_changed_outside(text, args);
        self.unknown_effect(
            stmt.span,
            &format!("'{text}' is neither in the program nor an instruction that is known"),
        );
    }

    /// Marks the data that an instruction writes as unknown.
    fn written(&mut self, text: &str, instruction: &Instruction, args: &[Arg]) {
        let way_out = "; --assume NAME=NUMBER states the answer";
        let way_out = if instruction.asks_operator() { way_out } else { "" };
        let how = format!("is written by {text}{way_out}");
        self.mark_unknown_if(args, &how, |place, _| instruction.may_write_to(place));
    }

    /// The answer of the operator, if the user states it.
    fn answered(&mut self, args: &[Arg]) {
        let Some(answer) = args.iter().find_map(Arg::positional) else { return };
        let ExprKind::Ref(name) = &answer.kind else { return };
        let Some(level) = self.machine.stated_level(&name.key) else { return };
        let Some(cell) = self.cell_of(name) else { return };
        self.write(cell, answer, Datum::Num(level));
        let input: Arc<str> = name.text.as_str().into();
        self.cells[cell].history = Origin::of(Dependence::Input(input.clone()));
        self.cells[cell].input = Some(input);
        self.assume(format!("{} is {level} (stated by --assume)", name.text));
    }

    /// Marks all data among the arguments as unknown.
    pub(super) fn mark_unknown(&mut self, args: &[Arg], how: &str) {
        self.mark_unknown_if(args, how, |_, _| true);
    }

    /// Marks the data among the arguments of a routine that is in no file as unknown.
    pub(super) fn mark_changed_outside(&mut self, text: &str, args: &[Arg]) {
        let only_read = |cell: &Cell| {
            let mut origin = cell.reading.iter();
            origin.any(|d| matches!(d, Dependence::TrustedPersistent(_)))
        };
        let how = format!("may be changed by {text}, which is in no file given");
        self.mark_unknown_if(args, &how, |_, cell| !only_read(cell));
    }

    pub(super) fn mark_unknown_if(
        &mut self,
        args: &[Arg],
        how: &str,
        may_change: impl Fn(ArgumentPlace<'_>, &Cell) -> bool,
    ) {
        for (place, expr) in arguments_with_places(args) {
            if let Some(name) = expr.base()
                && let Some(cell) = self.cell_of(name)
                && !self.cells[cell].read_only
                && may_change(place, &self.cells[cell])
            {
                let reason = format!("'{}' {how}", name.text);
                // Indices with calls have been evaluated: they do not run again.
                let whole = Expr { kind: ExprKind::Ref(name.clone()), span: expr.span };
                let target = if expr.calls().is_empty() { expr } else { &whole };
                self.write(cell, target, Datum::unknown(reason, expr.span));
                self.record_change(Some(cell));
            }
        }
    }

    fn output(&mut self, stmt: &Stmt, text: &str, level: Level, arguments: &Arguments<'_>) {
        let signal = arguments.positional.first().and_then(|expr| self.first_signal(expr));
        let Some(signal) = signal else { return };
        let after_pulse = (level == Level::Pulse).then_some(0.0);
        let level = match level {
            Level::High | Level::Pulse => Some(1.0),
            Level::Low => Some(0.0),
            Level::Inverse => self.signals.get(&signal.to_lowercase()).map(|x| 1.0 - x),
            Level::Given => {
                arguments.positional.get(1).and_then(|expr| self.eval_level(expr).datum.num())
            }
        };
        if let Some(level) = after_pulse.or(level) {
            self.set_level(&signal, level);
        } else {
            self.signals.remove(&signal.to_lowercase());
            self.record_change(None);
        }
        self.machine.on_output(Output {
            instruction: text.into(),
            span: stmt.span,
            signal,
            value: level.map_or_else(|| "unknown".to_owned(), number_text),
        });
    }

    /// `WZDOSet zone, shape, signal, value`: from here on the robot's position sets the signal, so
    /// its level is unknown.
    fn zone_output(&mut self, instruction: &Instruction, arguments: &Arguments<'_>) {
        const SIGNAL: usize = 2;
        self.written("WZDOSet", instruction, arguments.all);
        let signal = arguments.positional.get(SIGNAL).and_then(|expr| self.first_signal(expr));
        if let Some(signal) = signal
            && self.signals.remove(&signal.to_lowercase()).is_some()
        {
            self.record_change(None);
        }
    }

    fn count(&mut self, count: Count, arguments: &Arguments<'_>) {
        let Some(target) = arguments.positional.first() else { return };
        let old = self.eval(target);
        let step = arguments.positional.get(1);
        let step = step.map_or(Some(1.0), |expr| self.eval(expr).datum.num());
        let datum = match (count, old.datum.num(), step) {
            (Count::Clear, _, _) => Datum::Num(0.0),
            (Count::Up, Some(x), Some(d)) => Datum::Num(x + d),
            (Count::Down, Some(x), _) => Datum::Num(x - 1.0),
            _ => Datum::unknown("it was counted from a value that is not known", target.span),
        };
        self.assign(target, Value::constant(datum, "num"));
    }
}
