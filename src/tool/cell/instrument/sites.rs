//! The statements that a recorder records.

use std::collections::{BTreeMap, BTreeSet};

use crate::rapid::builtins::{self, Effect, Level, MoveForm, MoveKind, MoveSignature, Setting};
use crate::rapid::ir::exec::evaluate;
use crate::rapid::ir::hir::{
    ArgKind, Call, Callee, Expr, ExprKind, Routine, RoutineKind, Stmt, StmtKind,
};
use crate::rapid::ir::program::{Program, RoutineId, Symbol};
use crate::rapid::ir::signals::Signal;
use crate::rapid::ir::value::Datum;
use crate::rapid::ir::walk::statements;
use crate::rapid::text::{SourceFile, Span};
use crate::tool::retrofit::is_streams;

/// A statement that is recorded.
#[derive(Clone, Debug)]
pub(super) struct Site {
    /// The statement.
    pub(super) span: Span,
    /// What is recorded.
    pub(super) kind: SiteKind,
}

/// What is recorded of a statement.
#[derive(Clone, Debug)]
pub(super) enum SiteKind {
    /// A cycle starts before it.
    Cycle,
    /// A movement.
    Movement {
        /// Whether it ends at a stop point.
        stop: Stop,
        /// RAPID text of the tool's mass, if its tool is a datum.
        mass: Option<String>,
    },
    /// A wait.
    Wait {
        /// The signal, if it waits for one.
        signal: Option<String>,
        /// RAPID text of the flag that says that its time limit ended it.
        flag: Option<String>,
        /// RAPID text of its time limit: an error handler may go on behind the wait.
        most: Option<String>,
    },
    /// An output.
    Output {
        /// Its name.
        signal: String,
        /// RAPID text of its level.
        level: String,
    },
    /// Another load, with the RAPID text of its mass.
    Load(String),
}

/// Whether a movement ends at a stop point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Stop {
    /// It flies by.
    Never,
    /// It stops.
    Always,
    /// It stops if this RAPID text is true.
    If(String),
}

/// The recorded statements of a program, and the places that are not recorded, with reasons.
pub(super) struct Sites {
    /// In the order of the text of each file.
    pub(super) sites: Vec<Site>,
    /// Place and reason.
    pub(super) left_out: Vec<(Span, &'static str)>,
}

/// The recorded statements. `signals`: those of the program by lower-case name; `is_run`: whether a
/// lower-case name is a procedure that runs a stream.
pub(super) fn sites(
    program: &Program,
    entry: RoutineId,
    files: &[SourceFile],
    signals: &BTreeMap<String, Signal>,
    is_run: &dyn Fn(&str) -> bool,
) -> Sites {
    let compact = program.in_compact_ifs();
    let finder = Finder { program, files, signals, is_run, compact };
    let mut found = Sites { sites: Vec::new(), left_out: Vec::new() };
    let interrupting = called_by_traps(program);
    for (id, routine) in program.routines() {
        if finder.is_generated(routine.span) {
            continue;
        }
        for stmt in recorded_statements(routine) {
            if let Some(why) = finder.hides_outputs(id.module, stmt) {
                found.left_out.push((stmt.span, why));
            }
            let Some(kind) = finder.kind(id.module, stmt) else { continue };
            if interrupting.contains(&id) {
                found.left_out.push((stmt.span, IN_TRAP));
            } else if finder.compact.contains(&stmt.span) {
                found.left_out.push((stmt.span, IN_COMPACT_IF));
            } else {
                found.sites.push(Site { span: stmt.span, kind });
            }
        }
    }
    let starts = cycle_starts(program, entry);
    found.sites.extend(starts.into_iter().map(|span| Site { span, kind: SiteKind::Cycle }));
    // A cycle starts before its first movement.
    let is_later = |site: &Site| !matches!(site.kind, SiteKind::Cycle);
    found.sites.sort_by_key(|site| (site.span.file.0, site.span.start, is_later(site)));
    found
}

const IN_TRAP: &str =
    "it stands in a TRAP, or in a procedure that one calls, which may interrupt the recorder";
const ON_THE_PATH: &str =
    "its output is set on the path, where no call can stand: --signals records it by an interrupt";
const NO_NAME: &str =
    "its output is a parameter or an alias: --signals records it by the name of the signal";
const IN_COMPACT_IF: &str =
    "it is the statement of a compact IF, beside which nothing fits: write IF … THEN … ENDIF";

/// The TRAPs, and the routines that they call.
fn called_by_traps(program: &Program) -> BTreeSet<RoutineId> {
    let is_trap = |routine: &Routine| matches!(routine.kind, RoutineKind::Trap);
    let traps = program.routines().filter(|(_, routine)| is_trap(routine));
    let mut open: Vec<RoutineId> = traps.map(|(id, _)| id).collect();
    let mut found = BTreeSet::new();
    while let Some(id) = open.pop() {
        if found.insert(id) {
            open.extend(
                program.routine(id).statements().filter_map(|stmt| called(program, id, stmt)),
            );
        }
    }
    found
}

/// The routine of the program that a statement calls.
fn called(program: &Program, from: RoutineId, stmt: &Stmt) -> Option<RoutineId> {
    let StmtKind::Call(Call { callee: Callee::Name(name), .. }) = &stmt.kind else { return None };
    match program.resolve(from.module, &name.key)? {
        Symbol::Routine(id) => Some(id),
        _ => None,
    }
}

/// The statements of the body and of the error handlers.
fn recorded_statements(routine: &Routine) -> impl Iterator<Item = &Stmt> {
    let handlers = routine.error.iter().map(|(_, block)| block);
    std::iter::once(&routine.body).chain(handlers).flat_map(|block| statements(block))
}

/// The first statement of the entry, and that of the loop that never ends.
fn cycle_starts(program: &Program, entry: RoutineId) -> Vec<Span> {
    let first = program.routine(entry).body.first().map(|stmt| stmt.span);
    let mut seen = BTreeSet::new();
    let mut open = vec![entry];
    let mut endless = None;
    while let (None, Some(id)) = (endless, open.pop()) {
        if !seen.insert(id) {
            continue;
        }
        let mut next = Vec::new();
        for stmt in statements(&program.routine(id).body) {
            if let StmtKind::While { condition, body } = &stmt.kind
                && endless.is_none()
            {
                let value = evaluate(program, id.module, condition);
                if value.datum == Datum::Bool(true) && value.origin.iter().next().is_none() {
                    endless = body.first().map(|stmt| stmt.span);
                }
            }
            next.extend(called(program, id, stmt));
        }
        open.extend(next.into_iter().rev());
    }
    let mut starts: Vec<Span> = first.into_iter().chain(endless).collect();
    starts.dedup();
    starts
}

struct Finder<'a> {
    program: &'a Program,
    files: &'a [SourceFile],
    signals: &'a BTreeMap<String, Signal>,
    is_run: &'a dyn Fn(&str) -> bool,
    compact: BTreeSet<Span>,
}

impl Finder<'_> {
    /// Whether a routine stands in no file, or in a module of streams.
    fn is_generated(&self, routine: Span) -> bool {
        self.files.get(routine.file.0 as usize).is_none_or(|file| is_streams(&file.bytes))
    }

    /// What is recorded of a statement, if anything.
    fn kind(&self, module: usize, stmt: &Stmt) -> Option<SiteKind> {
        let StmtKind::Call(call) = &stmt.kind else { return None };
        let Callee::Name(name) = &call.callee else { return None };
        if (self.is_run)(&name.key) {
            return Some(SiteKind::Movement { stop: Stop::Always, mass: None });
        }
        if self.program.resolve(module, &name.key).is_some() {
            return None;
        }
        let instruction = builtins::instruction(&name.key)?;
        if let Some(signature) = instruction.movement() {
            let stop = self.stop(module, signature, call);
            let mass = (signature.form != MoveForm::ExternalJoint)
                .then(|| self.datum(tool(signature, call)?))
                .flatten()
                .map(|tool| format!("{tool}.tload.mass"));
            return Some(SiteKind::Movement { stop, mass });
        }
        if instruction.waits() || instruction.asks_operator() {
            return Some(self.wait(call));
        }
        let first = || call.args.iter().find_map(|arg| arg.positional());
        match instruction.effect {
            Effect::Output(level) => {
                let signal = self.signal(first()?)?;
                let level = match level {
                    Level::High | Level::Pulse => "1".to_owned(),
                    Level::Low => "0".to_owned(),
                    Level::Inverse => format!("DOutput({signal})"),
                    Level::Given => {
                        let second = call.args.iter().filter_map(|arg| arg.positional()).nth(1)?;
                        self.plain(second)?
                    }
                };
                Some(SiteKind::Output { signal, level })
            }
            Effect::Setting(Setting::GripLoad) => {
                Some(SiteKind::Load(format!("{}.mass", self.datum(first()?)?)))
            }
            _ => None,
        }
    }

    /// Why the output of a statement is not recorded, if it has one that is not.
    fn hides_outputs(&self, module: usize, stmt: &Stmt) -> Option<&'static str> {
        let StmtKind::Call(call) = &stmt.kind else { return None };
        let Callee::Name(name) = &call.callee else { return None };
        if self.program.resolve(module, &name.key).is_some() {
            return None;
        }
        let instruction = builtins::instruction(&name.key)?;
        if instruction.movement().is_some_and(|it| it.kind == MoveKind::Event) {
            return Some(ON_THE_PATH);
        }
        let first = call.args.iter().find_map(|arg| arg.positional());
        let has_no_name = matches!(instruction.effect, Effect::Output(_))
            && first.is_some_and(|signal| self.signal(signal).is_none());
        has_no_name.then_some(NO_NAME)
    }

    fn wait(&self, call: &Call) -> SiteKind {
        let signals: BTreeSet<String> = call
            .args
            .iter()
            .filter_map(|arg| arg.positional())
            .flat_map(|expr| self.signals_in(expr))
            .collect();
        let signal = signals.first().filter(|_| signals.len() == 1).cloned();
        let named = |key: &str| {
            call.args.iter().find_map(|arg| match &arg.kind {
                ArgKind::Optional(name, Some(expr)) if name.key == key => Some(expr),
                _ => None,
            })
        };
        let flag = named("timeflag").and_then(|expr| self.datum(expr));
        let most = named("maxtime").filter(|_| flag.is_none()).and_then(|expr| self.plain(expr));
        SiteKind::Wait { signal, flag, most }
    }

    /// The signals that an expression names.
    fn signals_in(&self, expr: &Expr) -> Vec<String> {
        let mut found: Vec<String> = self.signal(expr).into_iter().collect();
        found.extend(expr.parts().into_iter().flat_map(|part| self.signals_in(part)));
        found
    }

    fn signal(&self, expr: &Expr) -> Option<String> {
        let ExprKind::Ref(name) = &expr.kind else { return None };
        self.signals.get(&name.key).map(|signal| signal.name.clone())
    }

    /// The text of a datum: a name, a component or an element with constant indices.
    fn datum(&self, expr: &Expr) -> Option<String> {
        let is_plain = match &expr.kind {
            ExprKind::Ref(_) => true,
            ExprKind::Field(inner, _) => self.datum(inner).is_some(),
            ExprKind::Index(inner, indices) => {
                self.datum(inner).is_some() && indices.iter().all(|i| self.plain(i).is_some())
            }
            _ => false,
        };
        is_plain.then(|| self.text(expr.span)).filter(|text| !text.contains(['\n', '\r', '!']))
    }

    /// The text of a number or datum.
    fn plain(&self, expr: &Expr) -> Option<String> {
        match expr.literal_number() {
            Some(_) => Some(self.text(expr.span)),
            None => self.datum(expr),
        }
    }

    fn text(&self, span: Span) -> String {
        self.files[span.file.0 as usize].text(span).into_owned()
    }

    /// Whether a movement ends at a stop point.
    fn stop(&self, module: usize, signature: MoveSignature, call: &Call) -> Stop {
        let has = |key: &str| {
            call.args
                .iter()
                .any(|arg| matches!(&arg.kind, ArgKind::Optional(name, _) if name.key == key))
        };
        // The program goes on while the robot moves.
        if has("conc") {
            return Stop::Never;
        }
        if !signature.zone || has("inpos") {
            return Stop::Always;
        }
        let Some(zone) = zone(signature, call) else { return Stop::Never };
        let ExprKind::Ref(name) = &zone.kind else {
            return self.datum(zone).map_or(Stop::Never, |text| Stop::If(format!("{text}.finep")));
        };
        let is_own = self.program.resolve(module, &name.key).is_some();
        match (is_own, name.key.as_str()) {
            (false, "fine") => Stop::Always,
            (false, key) if builtins::predefined(key).is_some() => Stop::Never,
            _ => Stop::If(format!("{}.finep", name.text)),
        }
    }
}

/// Positional arguments, or those with this name.
fn argument<'a>(call: &'a Call, name: &str, index: usize) -> Option<&'a Expr> {
    let named = call.args.iter().find_map(|arg| match &arg.kind {
        ArgKind::Named(known, expr) if known.key == name => Some(expr),
        _ => None,
    });
    named.or_else(|| call.args.iter().filter_map(|arg| arg.positional()).nth(index))
}

/// The number of positional arguments before the zone.
fn before_zone(signature: MoveSignature) -> usize {
    let targets = if signature.form == MoveForm::Circular { 2 } else { 1 };
    signature.before + targets + 1 + signature.between
}

fn zone(signature: MoveSignature, call: &Call) -> Option<&Expr> {
    argument(call, "zone", before_zone(signature))
}

fn tool(signature: MoveSignature, call: &Call) -> Option<&Expr> {
    argument(call, "tool", before_zone(signature) + usize::from(signature.zone))
}
