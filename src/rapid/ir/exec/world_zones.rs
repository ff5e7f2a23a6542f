//! World zones: their effects on data and signals. They cause no movement.

use super::arguments::Arguments;
use super::executor::Executor;
use crate::rapid::builtins::{self, Instruction};

impl Executor<'_> {
    /// `WZDOSet zone, shape, signal, value`: from here on the robot's position sets the signal, so
    /// its level is unknown.
    pub(super) fn zone_output(&mut self, arguments: &Arguments<'_>) {
        const SIGNAL: usize = 2;
        if let Some(written) = builtins::instruction("wzdoset").and_then(Instruction::written) {
            self.forget_written(arguments.all, written, "is written by WZDOSet");
        }
        let signal = arguments.positional.get(SIGNAL).and_then(|expr| self.first_signal(expr));
        if let Some(signal) = signal
            && self.signals.remove(&signal.to_lowercase()).is_some()
        {
            self.changes(None);
        }
    }
}
