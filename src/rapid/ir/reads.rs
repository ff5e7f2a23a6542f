//! Static analysis of an expression: what its evaluation reads and whether it has side effects,
//! over all paths through the functions that it calls.

use std::collections::BTreeSet;

use super::hir::{
    Arg, ArgKind, BinaryOp, Block, Call, Callee, Expr, ExprKind, ParamMode, Routine, StmtKind,
};
use super::program::{DataId, Program, RoutineId, Symbol};
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
    let mut walk = Walk { program, seen: BTreeSet::new(), found: Reads::default(), changes: false };
    walk.expr(routine, expr);
    Reads { fixed: !walk.changes, ..walk.found }
}

struct Walk<'p> {
    program: &'p Program,
    /// Functions that were already analysed.
    seen: BTreeSet<RoutineId>,
    found: Reads,
    /// Whether the expression contains something that may change.
    changes: bool,
}

impl Walk<'_> {
    fn expr(&mut self, at: RoutineId, expr: &Expr) {
        match &expr.kind {
            ExprKind::Ref(name) => self.name(at, &name.key, &name.text),
            ExprKind::Field(base, _) | ExprKind::Unary(_, base) => self.expr(at, base),
            ExprKind::Index(base, indices) => {
                let is_number = |index: &Expr| matches!(index.kind, ExprKind::Num(_));
                self.found.may_raise |= !indices.iter().all(is_number);
                self.expr(at, base);
                self.all(at, indices);
            }
            ExprKind::Aggregate(items) => self.all(at, items),
            ExprKind::Binary(operator, left, right) => {
                let divides = matches!(operator, BinaryOp::Div | BinaryOp::IntDiv | BinaryOp::Mod);
                self.found.may_raise |= divides && !matches!(right.kind, ExprKind::Num(_));
                self.expr(at, left);
                self.expr(at, right);
            }
            ExprKind::Call(name, args) => {
                self.arguments(at, args);
                self.function(at, &name.key, &name.text);
            }
            ExprKind::AnyPosition | ExprKind::Placeholder | ExprKind::Broken => {
                self.effect("holds something that only the controller knows");
            }
            ExprKind::Num(_) | ExprKind::Str(_) | ExprKind::Bool(_) => {}
        }
    }

    fn all<'e>(&mut self, at: RoutineId, exprs: impl IntoIterator<Item = &'e Expr>) {
        for expr in exprs {
            self.expr(at, expr);
        }
    }

    fn arguments(&mut self, at: RoutineId, args: &[Arg]) {
        for arg in args {
            match &arg.kind {
                ArgKind::Positional(expr)
                | ArgKind::Named(_, expr)
                | ArgKind::Optional(_, Some(expr))
                | ArgKind::Conditional(_, expr) => self.expr(at, expr),
                ArgKind::Optional(_, None) => {}
            }
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
                self.effect(&format!("names {text}, which is no data"));
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
            Some(_) => self.effect(&format!("calls {text}, which is no function")),
            None => match builtins::function(key).map(|function| function.source) {
                Some(Source::Arguments) => {}
                Some(Source::Signal | Source::Call) => self.changes = true,
                Some(Source::Position | Source::Kinematics | Source::Mounting) => {
                    self.effect("is computed from where the robot stands");
                }
                _ => self.effect(&format!("calls {text}, whose value no condition can tell")),
            },
        }
    }

    fn routine(&mut self, id: RoutineId) {
        let routine = self.program.routine(id);
        if !routine.error.is_empty() || routine.undo.is_some() {
            self.effect(&format!("calls {}, which has a handler", routine.name.text));
        }
        self.all(id, routine.data.iter().filter_map(|data| data.init.as_ref()));
        self.block(id, &routine.body);
    }

    fn block(&mut self, at: RoutineId, block: &Block) {
        for stmt in block {
            match &stmt.kind {
                StmtKind::Assign { target, value } => {
                    self.expr(at, value);
                    self.target(at, target);
                }
                StmtKind::If { branches, .. } => {
                    self.all(at, branches.iter().map(|(condition, _)| condition));
                }
                StmtKind::For { from, to, step, .. } => {
                    self.all(at, [from, to].into_iter().chain(step));
                }
                StmtKind::While { condition, .. } => self.expr(at, condition),
                StmtKind::Test { value, cases, .. } => {
                    self.expr(at, value);
                    self.all(at, cases.iter().flat_map(|(values, _)| values));
                }
                StmtKind::Return(Some(value)) => self.expr(at, value),
                StmtKind::Data(data) => {
                    self.all(at, &data.init);
                }
                StmtKind::Call(call) => self.call(at, call),
                StmtKind::Return(None) | StmtKind::Label(_) | StmtKind::Goto(_) => {}
                StmtKind::Raise(_)
                | StmtKind::Exit
                | StmtKind::Retry
                | StmtKind::TryNext
                | StmtKind::Connect { .. }
                | StmtKind::Placeholder
                | StmtKind::Broken => {
                    let name = &self.program.routine(at).name.text;
                    self.effect(&format!("calls {name}, which may not come back with a value"));
                }
            }
            for inner in stmt.kind.blocks() {
                self.block(at, inner);
            }
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
                self.arguments(at, &call.args);
                if let Some(Arg { kind: ArgKind::Positional(target), .. }) = call.args.first() {
                    self.target(at, target);
                }
            }
            Callee::Name(name) => {
                self.effect(&format!("calls {own}, which runs {}", name.text));
            }
            Callee::Late(_) => {
                self.effect(&format!("calls {own}, which runs a procedure with a computed name"));
            }
        }
    }

    /// A function that writes to data that are not its own has a side effect.
    fn target(&mut self, at: RoutineId, target: &Expr) {
        match &target.kind {
            ExprKind::Field(base, _) => self.target(at, base),
            ExprKind::Index(base, indices) => {
                self.all(at, indices);
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
                    self.effect(&format!("calls {function}, which writes to {}", name.text));
                }
            }
            _ => self.effect("writes to something that is no data"),
        }
    }

    fn effect(&mut self, what: &str) {
        self.changes = true;
        self.found.effect.get_or_insert_with(|| what.to_owned());
    }
}

/// Whether a name is data of the routine or the variable of one of its loops.
fn is_own(routine: &Routine, key: &str) -> bool {
    fn in_block(block: &Block, key: &str) -> bool {
        block.iter().any(|stmt| {
            let declares = match &stmt.kind {
                StmtKind::Data(data) => data.name.key == key,
                StmtKind::For { var, .. } => var.key == key,
                _ => false,
            };
            declares || stmt.kind.blocks().into_iter().any(|inner| in_block(inner, key))
        })
    }
    routine.data.iter().any(|data| data.name.key == key)
        || routine.blocks().any(|block| in_block(block, key))
}
