//! Motion modes of which only the default is modelled.

use super::arguments::Arguments;
use super::executor::Executor;
use crate::rapid::ir::hir::{Expr, ExprKind, Stmt};

/// Options of `CirPathMode` in the order of their numbers in `C_MOTSET.cirpathreori`.
/// Source: RAPID reference, `motsetdata`.
const CIRCLE_MODES: [&str; 6] =
    ["pathframe", "objectframe", "cirpointori", "wrist45", "wrist46", "wrist56"];
/// The last of the modes that the simulation models.
const OBJECT_FRAME: usize = 1;

impl Executor<'_> {
    /// `CirPathMode`: how the tool turns on arcs; default `\PathFrame`.
    pub(super) fn circle_mode(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let mode = CIRCLE_MODES.iter().position(|mode| arguments.has_option(mode)).unwrap_or(0);
        if mode <= OBJECT_FRAME {
            self.clear_unmodelled(&["cirpathmode"]);
        } else {
            self.unmodelled(stmt, text);
        }
        self.settings_mut().circle_mode = mode as u8;
    }

    /// `PathResol`: how densely a path is interpolated; default 100 %.
    pub(super) fn path_resolution(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let percent = arguments.positional.first().and_then(|expr| self.eval(expr).datum.num());
        if percent == Some(100.0) {
            self.clear_unmodelled(&["pathresol"]);
        } else {
            self.unmodelled(stmt, text);
        }
        self.settings_mut().path_resolution = percent.map(|percent| percent / 100.0);
    }

    /// `MotionProcessModeSet`: the tuning of the servo; default `OPTIMAL_CYCLE_TIME_MODE`.
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
