//! What is known of a function.

use super::parameter::positional;
use super::types::SignalKind;

/// Where the value of a function comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// From its arguments alone; `ir/functions` calculates it.
    Arguments,
    /// From its arguments alone, but nothing here calculates it.
    NotCalculated,
    /// From the call of the routine: `Present`.
    Call,
    /// From the signal that is its argument.
    Signal,
    /// From where the robot stands.
    Position,
    /// From the arm's kinematics.
    Kinematics,
    /// From where mechanical units are mounted.
    Mounting,
    /// From files, clock and mode of the controller.
    Controller,
    /// From what the program or the operator did before.
    State,
}

/// One of RAPID's functions.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// As RAPID writes it.
    pub name: &'static str,
    arguments: &'static str,
    /// Where its value comes from.
    pub source: Source,
    /// Whether it is of no concern to its value whether the robot has arrived.
    pub on_the_fly: bool,
}

/// A function that [`Source::Arguments`] gives.
pub(super) const fn calculated(name: &'static str, arguments: &'static str) -> Function {
    Function { name, arguments, source: Source::Arguments, on_the_fly: true }
}

/// The same for a function of `dnum`. That it needs no robot that has arrived is not made use of.
pub(super) const fn calculated_dnum(name: &'static str, arguments: &'static str) -> Function {
    Function { on_the_fly: false, ..calculated(name, arguments) }
}

/// A function whose value comes from elsewhere.
pub(super) const fn from(source: Source, name: &'static str, arguments: &'static str) -> Function {
    let on_the_fly = matches!(source, Source::NotCalculated | Source::Call);
    Function { name, arguments, source, on_the_fly }
}

impl Function {
    pub(super) const fn on_the_fly(self) -> Function {
        Function { on_the_fly: true, ..self }
    }

    /// The kind of the signal that is its first positional argument.
    pub fn signal(&self) -> Option<SignalKind> {
        positional(self.arguments).next()?.signal()
    }

    /// Whether it is known to leave its arguments as they are.
    pub fn only_reads(&self) -> bool {
        matches!(
            self.source,
            Source::Arguments
                | Source::Signal
                | Source::Position
                | Source::Kinematics
                | Source::Mounting
        )
    }
}
