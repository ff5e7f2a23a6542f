//! RAPID's own instructions: waits, outputs, counters and motion settings.

use std::sync::Arc;

use super::super::convert;
use super::super::hir::{Arg, ArgKind, BinaryOp, Expr, ExprKind, Stmt};
use super::super::instructions::{self, MoveForm};
use super::super::movement::{Output, Settings, Wait};
use super::super::value::{Datum, Dependence, Value};
use super::flow::{Flow, Raised, number_text};
use super::{Cell, Executor, Waited};
use crate::rapid::text::Span;

/// The arguments of an instruction, by position and by name.
pub(super) struct Arguments<'e> {
    pub(super) positional: Vec<&'e Expr>,
    /// Lower-case name, as written, and value.
    pub(super) optional: Vec<(&'e str, &'e str, Option<&'e Expr>)>,
    /// Options that are there only if the routine was called with a parameter, as written: `Z?Zone`.
    pub(super) conditional: Vec<String>,
}

impl<'e> Arguments<'e> {
    /// Of a call in a routine that was given what `executor` says.
    pub(super) fn new(executor: &Executor<'_>, args: &'e [Arg]) -> Arguments<'e> {
        let mut positional = Vec::new();
        let mut optional = Vec::new();
        let mut conditional = Vec::new();
        for arg in args {
            match &arg.kind {
                ArgKind::Positional(expr) => positional.push(expr),
                ArgKind::Named(name, expr) => {
                    optional.push((name.key.as_str(), name.text.as_str(), Some(expr)));
                }
                ArgKind::Optional(name, expr) => {
                    optional.push((name.key.as_str(), name.text.as_str(), expr.as_ref()));
                }
                ArgKind::Conditional(name, outer) => {
                    if let ExprKind::Ref(outer) = &outer.kind {
                        conditional.push(format!("{}?{}", name.text, outer.text));
                    }
                    if executor.given(outer).is_some() {
                        optional.push((name.key.as_str(), name.text.as_str(), Some(outer)));
                    }
                }
            }
        }
        Arguments { positional, optional, conditional }
    }

    /// Whether an option is given, with or without a value.
    pub(super) fn has_option(&self, key: &str) -> bool {
        self.optional.iter().any(|(k, _, _)| *k == key)
    }

    /// The value of an option that is present and has one.
    pub(super) fn option_value(&self, key: &str) -> Option<&'e Expr> {
        self.optional.iter().find(|(k, _, _)| *k == key).and_then(|(_, _, expr)| *expr)
    }
}

/// Least limit of `PathAccLim` and `WorldAccLim`, m/s²: lower ones are raised.
const LEAST_ACCELERATION: f64 = 0.1;

/// Largest override of `VelSet`, %.
const MOST_OVERRIDE: f64 = 200.0;

/// How long a wait lasts.
pub(super) enum Length {
    /// s, by an argument of literals and constants: the same whenever it runs.
    Constant(f64, Span),
    /// s.
    Stated(f64),
    /// Until an input comes, or a condition holds that names none.
    Until(Option<Arc<str>>),
    /// For something else, in words.
    Unknown(String),
}

impl Executor<'_> {
    pub(super) fn instruction(&mut self, stmt: &Stmt, key: &str, text: &str, args: &[Arg]) -> Flow {
        let arguments = Arguments::new(self, args);
        if let Some(signature) = instructions::movement(key) {
            self.movement(stmt, text, signature, &arguments, args);
            return Flow::Next;
        }
        match key {
            "waittime" => self.wait_time(stmt, text, &arguments),
            "waitdi" | "waitdo" | "waitgi" | "waitgo" | "waitai" | "waitao" => {
                return self.wait_signal(stmt, text, &arguments);
            }
            "waituntil" => return self.wait_until(stmt, text, &arguments),
            "pdispon" if arguments.has_option("exep") => self.displace(stmt, text, &arguments),
            _ if instructions::is_waiting(key) => {
                if instructions::is_writing(key) {
                    self.forget(args, text);
                }
                // The program does not tell for how long.
                self.wait(stmt, text, Length::Until(None), None);
            }
            "setdo" | "setgo" | "setao" | "set" | "reset" | "pulsedo" | "invertdo" => {
                self.output(stmt, key, text, &arguments);
            }
            "incr" | "decr" | "add" | "clear" => self.count(key, &arguments),
            "wzdoset" => self.zone_output(args, &arguments),
            "stop" | "break" | "exitcycle" => {
                self.unresolved(stmt.span, format!("{text}: taken as passed"));
                if key == "exitcycle" {
                    return Flow::Exit;
                }
            }
            "velset" | "accset" | "confj" | "confl" | "gripload" | "pdispset" | "pdispoff"
            | "speedrefresh" => {
                self.setting(stmt, key, text, &arguments);
            }
            "pathacclim" => self.path_acceleration(stmt, text, &arguments),
            "worldacclim" => self.world_acceleration(stmt, text, &arguments),
            "singarea" => self.sing_area(text, &arguments),
            "waitrob" | "motionsup" => {}
            "pathresol" => self.path_resolution(stmt, text, &arguments),
            "eoffsset" | "eoffson" | "softact" | "pdispon" | "corrcon" | "speedlimaxis"
            | "tuneservo" | "pathrecstart" => self.unmodelled(stmt, text),
            "pathrecstop" => self.clear_unmodelled(&["pathrecstart"]),
            "motionprocessmodeset" => self.process_mode(stmt, text, &arguments),
            "eoffsoff" => self.clear_unmodelled(&["eoffsset", "eoffson"]),
            "softdeact" => self.clear_unmodelled(&["softact"]),
            "corrdiscon" | "corrclear" => self.clear_unmodelled(&["corrcon"]),
            "egmreset" => self.clear_unmodelled(&["egmreset"]),
            "tunereset" => self.clear_unmodelled(&["tuneservo"]),
            "cirpathmode" => self.circle_mode(stmt, text, &arguments),
            _ if instructions::is_harmless(key) => {}
            _ if instructions::written(key).is_some() => {
                self.forget_written(args, key, &format!("is written by {text}"));
            }
            _ if instructions::is_writing(key) => {
                self.forget(args, &format!("is written by {text}"));
            }
            _ => {
                let reads = |cell: &Cell| {
                    let mut origin = cell.reading.iter();
                    origin.any(|d| matches!(d, Dependence::TrustedPersistent(_)))
                };
                let how = format!("may be changed by {text}, which is in no file given");
                self.forget_if(args, &how, |cell| !reads(cell));
                self.opaque(
                    stmt.span,
                    &format!("'{text}' is neither in the program nor an instruction that is known"),
                );
            }
        }
        Flow::Next
    }

    /// Data that a call may have written are no longer known.
    pub(super) fn forget(&mut self, args: &[Arg], how: &str) {
        self.forget_if(args, how, |_| true);
    }

    /// The data that an instruction of RAPID's own writes to are no longer known.
    pub(super) fn forget_written(&mut self, args: &[Arg], key: &str, how: &str) {
        let Some(written) = instructions::written(key) else { return };
        let by_name =
            |arg: &&Arg| matches!(&arg.kind, ArgKind::Named(name, _) if name.key == written.name);
        let positional = |arg: &&Arg| matches!(arg.kind, ArgKind::Positional(_));
        let in_place = || args.iter().filter(positional).nth(written.position);
        if let Some(arg) = args.iter().find(by_name).or_else(in_place) {
            self.forget(std::slice::from_ref(arg), how);
        }
    }

    fn forget_if(&mut self, args: &[Arg], how: &str, may_change: impl Fn(&Cell) -> bool) {
        for arg in args {
            let (ArgKind::Positional(expr)
            | ArgKind::Named(_, expr)
            | ArgKind::Optional(_, Some(expr))) = &arg.kind
            else {
                continue;
            };
            if let ExprKind::Ref(name) = &expr.kind
                && let Some(cell) = self.cell_of(name)
                && !self.cells[cell].read_only
                && may_change(&self.cells[cell])
            {
                let reason = format!("'{}' {how}", name.text);
                self.cells[cell].value.datum = Datum::unknown(reason, arg.span);
                self.changes(Some(cell));
            }
        }
    }

    fn wait_time(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let value = arguments.positional.first().map(|expr| self.eval(expr));
        let constant = value.as_ref().is_some_and(|value| value.origin.iter().next().is_none());
        let datum = value.map(|value| value.datum);
        // `WaitTime 0` and `WaitTime \InPos, 0` only wait for standstill.
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
        self.wait(stmt, text, length, None);
    }

    fn wait_signal(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) -> Flow {
        let signal = arguments.positional.first().and_then(|expr| self.first_signal(expr));
        let flow = self.wait_at_most(stmt, text, Length::Until(signal.clone()), arguments);
        if let (Ok(()), Some(signal), Some(value)) = (&flow, signal, arguments.positional.get(1)) {
            let value = self.eval(value);
            let level = self.level(value);
            if let Some(level) = level.datum.num() {
                self.set_level(&signal, level);
            }
        }
        flow.err().unwrap_or(Flow::Next)
    }

    /// A wait with `\MaxTime` and `\TimeFlag`, if they are given. `Err` holds what follows where
    /// it did not end with what it waited for.
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
        let waited = self.wait(stmt, text, length, max_time);
        let timed_out = waited == Waited::TimedOut;
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

    fn wait_until(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) -> Flow {
        let condition = arguments.positional.first().copied();
        let signal = condition.and_then(|expr| self.deciding_signal(expr, true));
        if let Some(condition) = condition {
            let value = self.eval(condition);
            let value = self.level(value);
            let input =
                value.origin.iter().any(|d| matches!(d, super::super::value::Dependence::Input(_)));
            if value.datum == Datum::Bool(true) && !input {
                let flow = self.wait_at_most(stmt, text, Length::Stated(0.0), arguments);
                return flow.err().unwrap_or(Flow::Next);
            }
        }
        if let Err(flow) = self.wait_at_most(stmt, text, Length::Until(signal), arguments) {
            return flow;
        }
        if let Some(condition) = condition {
            self.learn(condition);
        }
        Flow::Next
    }

    /// After the wait the equalities of its condition hold.
    fn learn(&mut self, condition: &Expr) {
        match &condition.kind {
            ExprKind::Binary(BinaryOp::And, left, right) => {
                self.learn(left);
                self.learn(right);
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

    pub(super) fn wait(
        &mut self,
        stmt: &Stmt,
        text: &str,
        length: Length,
        max_time: Option<f64>,
    ) -> Waited {
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
        let moves = instructions::movement(&text.to_lowercase())
            .is_some_and(|signature| signature.form == MoveForm::ExternalJoint);
        let external = self.external_axes.as_deref().filter(|_| moves);
        let external = external.and_then(|axes| axes.try_into().ok());
        self.machine.waits(Wait {
            instruction: text.into(),
            span: stmt.span,
            routine,
            duration,
            constant,
            max_time,
            signal,
            other,
            grip_load: self.settings.grip_load,
            external,
        })
    }

    fn output(&mut self, stmt: &Stmt, key: &str, text: &str, arguments: &Arguments<'_>) {
        let Some(signal) = arguments.positional.first().and_then(|expr| self.first_signal(expr))
        else {
            return;
        };
        let level = match key {
            "set" | "pulsedo" => Some(1.0),
            "reset" => Some(0.0),
            "invertdo" => self.signals.get(&signal.to_lowercase()).map(|x| 1.0 - x),
            _ => arguments.positional.get(1).and_then(|expr| {
                let value = self.eval(expr);
                self.level(value).datum.num()
            }),
        };
        let after = if key == "pulsedo" { Some(0.0) } else { level };
        if let Some(level) = after {
            self.set_level(&signal, level);
        } else {
            self.signals.remove(&signal.to_lowercase());
            self.changes(None);
        }
        self.machine.sets(Output {
            instruction: text.into(),
            span: stmt.span,
            signal,
            value: level.map_or_else(|| "unknown".to_owned(), number_text),
        });
    }

    fn count(&mut self, key: &str, arguments: &Arguments<'_>) {
        let Some(target) = arguments.positional.first() else { return };
        let old = self.eval(target);
        let step = match arguments.positional.get(1) {
            Some(expr) => self.eval(expr).datum.num(),
            None => Some(1.0),
        };
        let datum = match (key, old.datum.num(), step) {
            ("clear", _, _) => Datum::Num(0.0),
            ("incr" | "add", Some(x), Some(d)) => Datum::Num(x + d),
            ("decr", Some(x), _) => Datum::Num(x - 1.0),
            _ => Datum::unknown("it was counted from a value that is not known", target.span),
        };
        self.assign(target, Value::constant(datum, "num"));
    }

    fn setting(&mut self, stmt: &Stmt, key: &str, text: &str, arguments: &Arguments<'_>) {
        let mut values = Vec::new();
        for expr in &arguments.positional {
            let value = self.eval(expr);
            values.push(self.level(value));
        }
        let num = |i: usize| values.get(i).and_then(|v| v.datum.num());
        let on = arguments.has_option("on");
        let mut settings = Settings::clone(&self.settings);
        settings.other.retain(|name| !name.eq_ignore_ascii_case(text));
        let unknown = match key {
            "velset" => match (num(0), num(1)) {
                (Some(percent), Some(_)) if !(percent > 0.0 && percent <= MOST_OVERRIDE) => {
                    self.refused(stmt, text, &format!("{percent} % of the programmed speed"));
                    return;
                }
                (Some(_), Some(max)) if max <= 0.0 => {
                    self.refused(stmt, text, &format!("a largest speed of {max} mm/s"));
                    return;
                }
                (Some(percent), Some(max)) => {
                    settings.speed_override = percent / 100.0;
                    settings.speed_max = max * 1e-3;
                    false
                }
                _ => true,
            },
            "accset" => match (num(0), num(1)) {
                // The controller raises lower values to 20 % and 10 %.
                (Some(acc), Some(ramp)) => {
                    let fine = arguments.option_value("finepointramp");
                    let fine = fine.and_then(|expr| self.eval(expr).datum.num());
                    settings.fine_point_ramp = fine.unwrap_or(100.0).clamp(10.0, 100.0) / 100.0;
                    settings.acceleration = acc.clamp(20.0, 100.0) / 100.0;
                    settings.ramp = ramp.clamp(10.0, 100.0) / 100.0;
                    false
                }
                _ => true,
            },
            "speedrefresh" => match num(0) {
                Some(percent) if percent > 0.0 && percent <= 100.0 => {
                    settings.refresh = percent / 100.0;
                    false
                }
                Some(0.0) => {
                    self.unresolved(
                        stmt.span,
                        format!("{text} 0 stops all movements: taken as if it were not there"),
                    );
                    return;
                }
                Some(percent) => {
                    self.refused(stmt, text, &format!("{percent} % of the speed"));
                    return;
                }
                _ => true,
            },
            "confj" => {
                settings.conf_joint = on;
                false
            }
            "confl" => {
                settings.conf_linear = on;
                false
            }
            "gripload" => match values.first().map(|v| convert::load(&v.datum)) {
                Some(Ok(load)) => {
                    settings.grip_load = Some(load);
                    settings.grip_load_data = values.first().map(|value| value.datum.clone());
                    false
                }
                Some(Err(why)) => {
                    self.blame(arguments.positional[0], &values[0].datum, &why);
                    true
                }
                None => true,
            },
            "pdispset" => match values.first().map(|v| convert::pose(&v.datum, "the displacement"))
            {
                Some(Ok(pose)) => {
                    settings.displacement = Some(pose);
                    false
                }
                _ => true,
            },
            _ => {
                settings.displacement = None;
                settings.other.retain(|name| !name.eq_ignore_ascii_case("PDispOn"));
                false
            }
        };
        if unknown {
            settings.other.push(text.into());
            self.not_known(stmt, text);
        }
        self.settings = Arc::new(settings);
    }

    /// A value at which the controller stops with an error.
    fn refused(&mut self, stmt: &Stmt, text: &str, what: &str) {
        self.unresolved(
            stmt.span,
            format!(
                "the controller stops with an error here: {text} with {what}; taken as if it were \
                 not there"
            ),
        );
        let mut settings = Settings::clone(&self.settings);
        settings.other.retain(|name| !name.eq_ignore_ascii_case(text));
        settings.other.push(text.into());
        self.settings = Arc::new(settings);
    }

    fn not_known(&mut self, stmt: &Stmt, text: &str) {
        let reason = format!("{text} with a value that is not known: simulated as before it");
        self.unresolved(stmt.span, reason);
    }

    fn sing_area(&mut self, text: &str, arguments: &Arguments<'_>) {
        let mut settings = Settings::clone(&self.settings);
        settings.sing_area = arguments
            .optional
            .iter()
            .find(|(key, _, _)| *key != "off")
            .map(|(_, option, _)| format!("{text}\\{option}").into());
        self.settings = Arc::new(settings);
    }

    /// `PathAccLim AccLim [\AccMax], DecelLim [\DecelMax]`.
    fn path_acceleration(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let mut limits = [f64::INFINITY; 2];
        let mut known = arguments.positional.len() == 2;
        let options = ["accmax", "decelmax"];
        for (i, (expr, option)) in arguments.positional.iter().zip(options).enumerate() {
            match self.eval(expr).datum {
                Datum::Bool(false) => {}
                Datum::Bool(true) => {
                    let value = arguments.option_value(option);
                    match value.and_then(|expr| self.eval(expr).datum.num()) {
                        Some(limit) => limits[i] = self.least(stmt, text, limit),
                        None => known = false,
                    }
                }
                _ => known = false,
            }
        }
        let mut settings = Settings::clone(&self.settings);
        settings.other.retain(|name| !name.eq_ignore_ascii_case(text));
        if known {
            settings.path_acceleration = limits;
        } else {
            settings.other.push(text.into());
            self.not_known(stmt, text);
        }
        self.settings = Arc::new(settings);
    }

    /// A limit of the acceleration, raised to the least that there is.
    fn least(&mut self, stmt: &Stmt, text: &str, limit: f64) -> f64 {
        if limit < LEAST_ACCELERATION {
            let reason = format!(
                "{text} with {limit} m/s², less than the controller takes: simulated with \
                 {LEAST_ACCELERATION} m/s²"
            );
            self.unresolved(stmt.span, reason);
        }
        limit.max(LEAST_ACCELERATION)
    }

    /// `WorldAccLim \On := m/s²` or `\Off`.
    fn world_acceleration(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let on = arguments.option_value("on").map(|expr| self.eval(expr).datum.num());
        let mut settings = Settings::clone(&self.settings);
        settings.other.retain(|name| !name.eq_ignore_ascii_case(text));
        match on {
            None if arguments.has_option("off") => settings.world_acceleration = f64::INFINITY,
            Some(Some(limit)) => {
                settings.world_acceleration = self.least(stmt, text, limit);
            }
            _ => {
                settings.other.push(text.into());
                self.not_known(stmt, text);
            }
        }
        self.settings = Arc::new(settings);
    }

    /// A setting that changes movements in a way that is not modelled.
    pub(super) fn unmodelled(&mut self, stmt: &Stmt, text: &str) {
        self.unresolved(
            stmt.span,
            format!("{text} is not simulated: what follows runs as if it were not there"),
        );
        let mut settings = Settings::clone(&self.settings);
        settings.other.retain(|name| !name.eq_ignore_ascii_case(text));
        settings.other.push(text.into());
        self.settings = Arc::new(settings);
    }

    pub(super) fn clear_unmodelled(&mut self, keys: &[&str]) {
        let mut settings = Settings::clone(&self.settings);
        settings.other.retain(|name| !keys.contains(&name.to_lowercase().as_str()));
        self.settings = Arc::new(settings);
    }
}
