//! Expressions that read only data, so that they do not require the robot's arrival.

use std::collections::BTreeSet;

use crate::rapid::builtins;
use crate::rapid::ir::hir::{Arg, ArgKind, Block, DataKind, Expr, ExprKind, StmtKind};
use crate::rapid::ir::program::{Program, RoutineId, Symbol};

/// The names of a program that denote data.
pub struct Quiet<'p> {
    program: &'p Program,
    /// Loop variables, which have no declaration.
    counted: BTreeSet<(RoutineId, &'p str)>,
}

impl<'p> Quiet<'p> {
    /// The data names of a program.
    pub fn new(program: &'p Program) -> Quiet<'p> {
        let mut counted = BTreeSet::new();
        for (module, body) in program.modules.iter().enumerate() {
            for (index, routine) in body.routines.iter().enumerate() {
                for block in routine.blocks() {
                    count(RoutineId { module, index }, block, &mut counted);
                }
            }
        }
        Quiet { program, counted }
    }

    /// Whether an expression of a routine reads only data.
    pub fn expression(&self, routine: RoutineId, expr: &Expr) -> bool {
        match &expr.kind {
            ExprKind::Num(_) | ExprKind::Str(_) | ExprKind::Bool(_) | ExprKind::AnyPosition => true,
            ExprKind::Ref(name) => self.is_data(routine, &name.key),
            ExprKind::Field(base, _) => self.expression(routine, base),
            ExprKind::Index(base, indices) => {
                self.expression(routine, base)
                    && indices.iter().all(|index| self.expression(routine, index))
            }
            ExprKind::Call(name, args) => {
                builtins::function(&name.key).is_some_and(|function| function.on_the_fly)
                    && self.arguments(routine, args)
            }
            ExprKind::Aggregate(items) => items.iter().all(|item| self.expression(routine, item)),
            ExprKind::Unary(_, operand) => self.expression(routine, operand),
            ExprKind::Binary(_, left, right) => {
                self.expression(routine, left) && self.expression(routine, right)
            }
            ExprKind::Placeholder | ExprKind::Broken => false,
        }
    }

    /// Whether all arguments read only data.
    pub fn arguments(&self, routine: RoutineId, args: &[Arg]) -> bool {
        args.iter().all(|arg| match &arg.kind {
            ArgKind::Positional(expr)
            | ArgKind::Named(_, expr)
            | ArgKind::Optional(_, Some(expr)) => self.expression(routine, expr),
            ArgKind::Optional(_, None) => true,
            ArgKind::Conditional(..) => false,
        })
    }

    /// Whether a name in a routine denotes data of the program or predefined data.
    pub fn is_data(&self, routine: RoutineId, key: &str) -> bool {
        self.is_local(routine, key)
            || self.program.resolve(routine.module, key).is_some()
            || builtins::predefined(key).is_some()
    }

    /// Whether a write to a target may signal another task: `PERS` data other than numbers, which
    /// are mostly counters.
    pub fn is_flag(&self, routine: RoutineId, target: &Expr) -> bool {
        match &target.kind {
            ExprKind::Ref(name) => {
                let symbol = self.program.resolve(routine.module, &name.key);
                let Some(Symbol::Data(id)) = symbol else { return false };
                let data = self.program.data(id);
                !self.is_local(routine, &name.key)
                    && data.kind == DataKind::Pers
                    && data.type_name.key != "num"
            }
            ExprKind::Field(base, _) | ExprKind::Index(base, _) => self.is_flag(routine, base),
            _ => false,
        }
    }

    /// Whether a routine itself declares a name.
    pub fn is_local(&self, routine: RoutineId, key: &str) -> bool {
        let declared = self.program.routine(routine);
        declared.params.iter().any(|param| param.name.key == key)
            || declared.data.iter().any(|data| data.name.key == key)
            || self.counted.contains(&(routine, key))
    }
}

/// Collects loop variables and data declared between statements. The parser limits the depth.
fn count<'p>(id: RoutineId, block: &'p Block, counted: &mut BTreeSet<(RoutineId, &'p str)>) {
    for stmt in block {
        match &stmt.kind {
            StmtKind::For { var, .. } => {
                counted.insert((id, &var.key));
            }
            StmtKind::Data(data) => {
                counted.insert((id, &data.name.key));
            }
            _ => {}
        }
        for inner in stmt.kind.blocks() {
            count(id, inner, counted);
        }
    }
}
