//! Modes of motion that are not modelled unless they are the usual ones.

use super::super::hir::{Expr, ExprKind, Stmt};
use super::Executor;
use super::instruction::Arguments;

impl Executor<'_> {
    /// `CirPathMode`: how the tool turns on arcs; about the path's frame where nothing is said.
    pub(super) fn circle_mode(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let plain = |key: &str| matches!(key, "pathframe" | "objectframe");
        if arguments.optional.iter().all(|(key, _, _)| plain(key)) {
            self.clear_unmodelled(&["cirpathmode"]);
        } else {
            self.unmodelled(stmt, text);
        }
    }

    /// `PathResol`: how densely a path is interpolated, 100 % where nothing is said.
    pub(super) fn path_resolution(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let percent = arguments.positional.first().and_then(|expr| self.eval(expr).datum.num());
        if percent == Some(100.0) {
            self.clear_unmodelled(&["pathresol"]);
        } else {
            self.unmodelled(stmt, text);
        }
    }

    /// `MotionProcessModeSet`: another tuning of the servo than the one that everything starts with.
    pub(super) fn process_mode(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let usual = |expr: &&Expr| match &expr.kind {
            ExprKind::Ref(name) => name.key == "optimal_cycle_time_mode",
            _ => false,
        };
        if arguments.positional.first().is_some_and(usual) {
            self.clear_unmodelled(&["motionprocessmodeset"]);
        } else {
            self.unmodelled(stmt, text);
        }
    }
}
