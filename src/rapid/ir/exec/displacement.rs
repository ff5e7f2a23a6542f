//! Program displacement from two points.

use std::sync::Arc;

use nalgebra::Isometry3;

use super::arguments::Arguments;
use super::executor::Executor;
use crate::rapid::ir::convert;
use crate::rapid::ir::hir::Stmt;
use crate::rapid::ir::movement::Settings;

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
        let mut settings = Settings::clone(&self.settings);
        settings.other.retain(|name| !name.eq_ignore_ascii_case(text));
        match there.zip(programmed) {
            Some((there, programmed)) if arguments.has_option("rot") => {
                settings.displacement = Some(there * programmed.inverse());
            }
            Some((there, programmed)) => {
                let shift = there.translation.vector - programmed.translation.vector;
                settings.displacement = Some(Isometry3::translation(shift.x, shift.y, shift.z));
            }
            None => {
                settings.other.push(text.into());
                let reason = format!("{text} with points that are not known: simulated without it");
                self.unresolved(stmt.span, reason);
            }
        }
        self.settings = Arc::new(settings);
    }
}
