//! Expressions that read only data, so that they do not require the robot's arrival.

use std::collections::BTreeSet;

use crate::rapid::builtins;
use crate::rapid::ir::hir::{Arg, ArgKind, DataKind, Expr, ExprKind, StmtKind};
use crate::rapid::ir::program::{Program, RoutineId, Symbol};

/// The names of a program that denote data.
pub struct DataNames<'p> {
    program: &'p Program,
    /// Loop variables and data declared between statements.
    inner: BTreeSet<(RoutineId, &'p str)>,
}

impl<'p> DataNames<'p> {
    /// The data names of a program.
    pub fn new(program: &'p Program) -> DataNames<'p> {
        let inner = program.routines().flat_map(|(id, routine)| {
            routine.statements().filter_map(move |stmt| match &stmt.kind {
                StmtKind::For { var, .. } => Some((id, var.key.as_str())),
                StmtKind::Data(data) => Some((id, data.name.key.as_str())),
                _ => None,
            })
        });
        DataNames { program, inner: inner.collect() }
    }

    /// Whether an expression of a routine reads only data.
    pub fn has_only_data(&self, routine: RoutineId, expr: &Expr) -> bool {
        match &expr.kind {
            ExprKind::Ref(name) => self.is_data(routine, &name.key),
            ExprKind::Call(name, args) => {
                builtins::function(&name.key).is_some_and(|function| function.on_the_fly)
                    && self.have_only_data(routine, args)
            }
            ExprKind::Placeholder | ExprKind::Broken => false,
            _ => expr.parts().into_iter().all(|part| self.has_only_data(routine, part)),
        }
    }

    /// Whether all arguments read only data.
    pub fn have_only_data(&self, routine: RoutineId, args: &[Arg]) -> bool {
        args.iter().all(|arg| {
            !matches!(arg.kind, ArgKind::Conditional(..))
                && arg.value().is_none_or(|expr| self.has_only_data(routine, expr))
        })
    }

    /// Whether a name in a routine denotes data of the program or predefined data.
    fn is_data(&self, routine: RoutineId, key: &str) -> bool {
        self.is_local(routine, key)
            || self.program.resolve(routine.module, key).is_some()
            || builtins::predefined(key).is_some()
    }

    /// Whether a write to a target may signal another task: `PERS` data other than numbers, which
    /// are mostly counters.
    pub fn is_flag(&self, routine: RoutineId, target: &Expr) -> bool {
        let Some(name) = target.base() else { return false };
        let symbol = self.program.resolve(routine.module, &name.key);
        let Some(Symbol::Data(id)) = symbol else { return false };
        let data = self.program.data(id);
        !self.is_local(routine, &name.key)
            && data.kind == DataKind::Pers
            && data.type_name.key != "num"
    }

    /// Whether a routine itself declares a name.
    pub fn is_local(&self, routine: RoutineId, key: &str) -> bool {
        let declared = self.program.routine(routine);
        declared.params.iter().any(|param| param.name.key == key)
            || declared.data.iter().any(|data| data.name.key == key)
            || self.inner.contains(&(routine, key))
    }
}
