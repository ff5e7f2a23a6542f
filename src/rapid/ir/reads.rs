//! Static analysis of an expression: what its evaluation reads and whether it has side effects,
//! over all paths through the functions that it calls.

use std::collections::BTreeSet;

use super::hir::{Arg, BinaryOp, Call, Callee, Expr, ExprKind, ParamMode, Routine, Stmt, StmtKind};
use super::program::{DataId, Program, RoutineId, Symbol};
use super::walk::statements;
use crate::rapid::builtins::{self, Instruction, Source};

/// What an expression depends on.
#[derive(Clone, Debug, Default)]
pub struct Reads {
    /// Data at module level.
    pub data: BTreeSet<DataId>,
    /// Whether it reads a parameter that is passed by reference.
    pub by_reference: bool,
    /// Names that no module declares, assumed to be signals.
    pub signals: BTreeSet<String>,
    /// Whether it consists only of literals and built-in names: its value never changes.
    pub fixed: bool,
    /// Whether its evaluation may raise an error: a division or an array index.
    pub may_raise: bool,
    /// The first side effect, or dependence on a state that no condition can test, in words.
    pub effect: Option<String>,
}

/// What the evaluation of `expr` in the scope of a routine reads.
pub fn reads(program: &Program, routine: RoutineId, expr: &Expr) -> Reads {
    let mut analysis =
        Analysis { program, seen: BTreeSet::new(), found: Reads::default(), changes: false };
    analysis.expr(routine, expr);
    Reads { fixed: !analysis.changes, ..analysis.found }
}

struct Analysis<'p> {
    program: &'p Program,
    /// Functions that were already analysed.
    seen: BTreeSet<RoutineId>,
    found: Reads,
    /// Whether the expression contains something that may change.
    changes: bool,
}

impl Analysis<'_> {
    fn expr(&mut self, at: RoutineId, expr: &Expr) {
        let is_number = |expr: &Expr| matches!(expr.kind, ExprKind::Num(_));
        match &expr.kind {
            ExprKind::Ref(name) => self.name(at, &name.key, &name.text),
            ExprKind::Index(_, indices) => {
                self.found.may_raise |= !indices.iter().all(is_number);
            }
            ExprKind::Binary(BinaryOp::Div | BinaryOp::IntDiv | BinaryOp::Mod, _, right) => {
                self.found.may_raise |= !is_number(right);
            }
            ExprKind::AnyPosition | ExprKind::Placeholder | ExprKind::Broken => {
                self.side_effect("holds something that only the controller knows");
            }
            _ => {}
        }
        self.exprs(at, expr.parts());
        if let ExprKind::Call(name, _) = &expr.kind {
            self.function(at, &name.key, &name.text);
        }
    }

    fn exprs<'e>(&mut self, at: RoutineId, exprs: impl IntoIterator<Item = &'e Expr>) {
        for expr in exprs {
            self.expr(at, expr);
        }
    }

    fn name(&mut self, at: RoutineId, key: &str, text: &str) {
        let routine = self.program.routine(at);
        if let Some(param) = routine.params.iter().find(|param| param.name.key == key) {
            self.changes = true;
            self.found.by_reference |= param.mode != ParamMode::In;
            return;
        }
        if is_own(routine, key) {
            self.changes = true;
            return;
        }
        match self.program.resolve(at.module, key) {
            Some(Symbol::Data(id)) => {
                self.changes = true;
                self.found.data.insert(id);
            }
            Some(Symbol::Routine(_) | Symbol::Ambiguous) => {
                self.side_effect(&format!("names {text}, which is no data"));
            }
            None if builtins::predefined(key).is_some() => {}
            None => {
                self.changes = true;
                self.found.signals.insert(text.to_owned());
            }
        }
    }

    fn function(&mut self, at: RoutineId, key: &str, text: &str) {
        match self.program.resolve(at.module, key) {
            Some(Symbol::Routine(id)) => {
                self.changes = true;
                if self.seen.insert(id) {
                    self.routine(id);
                }
            }
            Some(_) => self.side_effect(&format!("calls {text}, which is no function")),
            None => match builtins::function(key).map(|function| function.source) {
                Some(Source::Arguments) => {}
                Some(Source::Signal | Source::Call) => self.changes = true,
                Some(Source::Position | Source::Kinematics | Source::Mounting) => {
                    self.side_effect("is computed from where the robot stands");
                }
                _ => self.side_effect(&format!("calls {text}, whose value no condition can tell")),
            },
        }
    }

    fn routine(&mut self, id: RoutineId) {
        let routine = self.program.routine(id);
        if !routine.error.is_empty() || routine.undo.is_some() {
            self.side_effect(&format!("calls {}, which has a handler", routine.name.text));
        }
        self.exprs(id, routine.data.iter().filter_map(|data| data.init.as_ref()));
        for stmt in statements(&routine.body) {
            self.statement(id, stmt);
        }
    }

    fn statement(&mut self, at: RoutineId, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Assign { target, value } => {
                self.expr(at, value);
                self.target(at, target);
            }
            StmtKind::Call(call) => self.call(at, call),
            StmtKind::Raise(_)
            | StmtKind::Exit
            | StmtKind::Retry
            | StmtKind::TryNext
            | StmtKind::Connect { .. }
            | StmtKind::Placeholder
            | StmtKind::Broken => {
                let name = &self.program.routine(at).name.text;
                self.side_effect(&format!("calls {name}, which may not come back with a value"));
            }
            kind => self.exprs(at, kind.exprs()),
        }
    }

    /// A call in a function is a side effect, except an instruction that counts in its own data.
    fn call(&mut self, at: RoutineId, call: &Call) {
        let own = &self.program.routine(at).name.text;
        match &call.callee {
            Callee::Name(name)
                if builtins::instruction(&name.key).is_some_and(Instruction::counts)
                    && self.program.resolve(at.module, &name.key).is_none() =>
            {
                self.exprs(at, call.args.iter().filter_map(Arg::value));
                if let Some(target) = call.args.first().and_then(Arg::positional) {
                    self.target(at, target);
                }
            }
            Callee::Name(name) => {
                self.side_effect(&format!("calls {own}, which runs {}", name.text));
            }
            Callee::Late(_) => {
                self.side_effect(&format!(
                    "calls {own}, which runs a procedure with a computed name"
                ));
            }
        }
    }

    /// A function that writes to data that are not its own has a side effect.
    fn target(&mut self, at: RoutineId, target: &Expr) {
        match &target.kind {
            ExprKind::Field(base, _) => self.target(at, base),
            ExprKind::Index(base, indices) => {
                self.exprs(at, indices);
                self.target(at, base);
            }
            ExprKind::Ref(name) => {
                let routine = self.program.routine(at);
                let param = routine.params.iter().find(|param| param.name.key == name.key);
                let is_own = param.map_or_else(
                    || is_own(routine, &name.key),
                    |param| param.mode == ParamMode::In,
                );
                if !is_own {
                    let function = &routine.name.text;
                    self.side_effect(&format!("calls {function}, which writes to {}", name.text));
                }
            }
            _ => self.side_effect("writes to something that is no data"),
        }
    }

    fn side_effect(&mut self, what: &str) {
        self.changes = true;
        self.found.effect.get_or_insert_with(|| what.to_owned());
    }
}

/// Whether a name is data of the routine or the variable of one of its loops.
fn is_own(routine: &Routine, key: &str) -> bool {
    let declares = |stmt: &Stmt| match &stmt.kind {
        StmtKind::Data(data) => data.name.key == key,
        StmtKind::For { var, .. } => var.key == key,
        _ => false,
    };
    routine.data.iter().any(|data| data.name.key == key) || routine.statements().any(declares)
}
