//! Program displacement from two points.

use nalgebra::Isometry3;

use super::arguments::Arguments;
use super::executor::Executor;
use crate::rapid::ir::convert;
use crate::rapid::ir::hir::Stmt;

impl Executor<'_> {
    /// `PDispOn [\Rot] \ExeP:=there, programmed, tool`: shifts all targets by the displacement
    /// from `programmed` to `there`, in the frame of the work object.
    pub(super) fn displace(&mut self, stmt: &Stmt, text: &str, arguments: &Arguments<'_>) {
        let mut target = |expr| {
            let value = self.eval(expr);
            convert::robtarget(&value.datum).ok().map(|target| target.pose)
        };
        let there = arguments.option_value("exep").and_then(&mut target);
        let programmed = arguments.positional.first().copied().and_then(&mut target);
        let displacement = there.zip(programmed).map(|(there, programmed)| {
            if arguments.has_option("rot") {
                return there * programmed.inverse();
            }
            let shift = there.translation.vector - programmed.translation.vector;
            Isometry3::translation(shift.x, shift.y, shift.z)
        });
        if displacement.is_some() {
            self.clear_unmodelled(&[&text.to_lowercase()]);
            self.settings_mut().displacement = displacement;
        } else {
            self.mark_unmodelled(text);
            let reason = format!("{text} with points that are not known: simulated without it");
            self.unresolved(stmt.span, reason);
        }
    }
}
