//! Properties of a built-in function.

use super::parameter::{ArgumentPlace, is_written, parameters, positional};
use super::types::SignalKind;

/// What the value of a function depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Only its arguments; `ir/functions` calculates it.
    Arguments,
    /// Only its arguments, but it is not implemented.
    NotCalculated,
    /// The call of the routine: `Present`.
    Call,
    /// The signal that is its argument.
    Signal,
    /// The position of the robot.
    Position,
    /// The kinematics of the robot.
    Kinematics,
    /// The mounting of mechanical units.
    Mounting,
    /// Files, clock or mode of the controller.
    Controller,
    /// Earlier actions of the program or the operator.
    State,
}

/// A built-in function.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// As RAPID writes it.
    pub name: &'static str,
    arguments: &'static str,
    /// What its value depends on.
    pub source: Source,
    /// True if its value is the same before and after the robot reaches its target.
    pub on_the_fly: bool,
}

/// A function with [`Source::Arguments`].
pub(super) const fn calculated(name: &'static str, arguments: &'static str) -> Function {
    Function { name, arguments, source: Source::Arguments, on_the_fly: true }
}

/// The same for a function of `dnum`, without `on_the_fly`.
pub(super) const fn calculated_dnum(name: &'static str, arguments: &'static str) -> Function {
    Function { on_the_fly: false, ..calculated(name, arguments) }
}

/// A function with another source.
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

    /// Whether it writes to the argument at this place.
    pub fn writes_to(&self, place: ArgumentPlace<'_>) -> bool {
        is_written(self.arguments, place)
    }

    /// Whether it is known not to write to its arguments.
    pub fn only_reads(&self) -> bool {
        let is_calculated = matches!(
            self.source,
            Source::Arguments
                | Source::Signal
                | Source::Position
                | Source::Kinematics
                | Source::Mounting
        );
        is_calculated && !parameters(self.arguments).any(|parameter| parameter.written)
    }
}
