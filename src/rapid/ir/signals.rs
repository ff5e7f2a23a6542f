//! The I/O signals that a program names.
//!
//! Signals are declared in the system configuration, not in RAPID: an undeclared name counts as
//! a signal. Its kind follows from the instructions that use it, else from the usual prefix.

use std::collections::BTreeMap;

use super::hir::{Arg, ArgKind, Callee, Expr, ExprKind, Ident, Stmt, StmtKind};
use super::program::Program;
use crate::rapid::builtins::{self, Function, Instruction, SignalKind};

/// A signal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signal {
    /// As first written.
    pub name: String,
    /// Its kind, if its use or its name determines it.
    pub kind: Option<SignalKind>,
}

/// The signals of a program by lower-case name.
pub fn signals(program: &Program) -> BTreeMap<String, Signal> {
    let mut collector =
        SignalCollector { program, module: 0, own: Vec::new(), signals: BTreeMap::new() };
    for (id, routine) in program.routines() {
        collector.module = id.module;
        collector.own = routine.params.iter().map(|param| param.name.key.clone()).collect();
        collector.own.extend(routine.data.iter().map(|data| data.name.key.clone()));
        for stmt in routine.statements() {
            collector.statement(stmt);
        }
    }
    for signal in collector.signals.values_mut() {
        signal.kind = signal.kind.or_else(|| by_name(&signal.name));
    }
    collector.signals
}

/// The kind by the usual prefix: `diPart`, `do_1`, but not a word such as `distance`.
fn by_name(name: &str) -> Option<SignalKind> {
    let (prefix, rest) = name.split_at_checked(2)?;
    if rest.starts_with(|c: char| c.is_lowercase()) {
        return None;
    }
    match prefix.to_lowercase().as_str() {
        "di" | "do" => Some(SignalKind::Digital),
        "gi" | "go" => Some(SignalKind::Group),
        "ai" | "ao" => Some(SignalKind::Analog),
        _ => None,
    }
}

/// The kind of the signal that an instruction or function takes first.
fn by_use(key: &str) -> Option<SignalKind> {
    let instruction = builtins::instruction(key).and_then(Instruction::signal);
    instruction.or_else(|| builtins::function(key).and_then(Function::signal))
}

struct SignalCollector<'a> {
    program: &'a Program,
    module: usize,
    /// Names that the routine declares.
    own: Vec<String>,
    signals: BTreeMap<String, Signal>,
}

impl SignalCollector<'_> {
    fn statement(&mut self, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Call(call) => {
                let Callee::Name(name) = &call.callee else { return self.args("", &call.args) };
                return self.args(&name.key, &call.args);
            }
            StmtKind::For { var, .. } => self.own.push(var.key.clone()),
            StmtKind::Data(data) => self.own.push(data.name.key.clone()),
            // These name no signal.
            StmtKind::Raise(_) | StmtKind::Connect { .. } => return,
            _ => {}
        }
        for expr in stmt.kind.exprs() {
            self.expr(expr);
        }
    }

    fn args(&mut self, key: &str, args: &[Arg]) {
        let mut kind = by_use(key);
        for arg in args {
            match &arg.kind {
                ArgKind::Positional(expr) => match (&expr.kind, kind.take()) {
                    (ExprKind::Ref(name), Some(kind)) => self.name(name, Some(kind)),
                    _ => self.expr(expr),
                },
                ArgKind::Named(_, expr) | ArgKind::Optional(_, Some(expr)) => self.expr(expr),
                ArgKind::Optional(_, None) | ArgKind::Conditional(..) => {}
            }
        }
    }

    /// The depth of the recursion is limited by the parser.
    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Ref(name) => self.name(name, None),
            ExprKind::Call(name, args) => self.args(&name.key, args),
            _ => {
                for part in expr.parts() {
                    self.expr(part);
                }
            }
        }
    }

    fn name(&mut self, name: &Ident, kind: Option<SignalKind>) {
        if self.own.contains(&name.key)
            || self.program.resolve(self.module, &name.key).is_some()
            || builtins::predefined(&name.key).is_some()
            || name.key == "errno"
        {
            return;
        }
        let new = || Signal { name: name.text.clone(), kind: None };
        let signal = self.signals.entry(name.key.clone()).or_insert_with(new);
        signal.kind = signal.kind.or(kind);
    }
}
