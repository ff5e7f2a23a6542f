//! What is known of an instruction.

use super::parameter::positional;
#[cfg(test)]
use super::parameter::{Parameter, parameters};
use super::types::SignalKind;

/// The form of a movement instruction: which positional arguments it takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MoveForm {
    /// `ToJointPos, Speed, Zone, Tool`
    AbsJ,
    /// `ToPoint, Speed, Zone, Tool`
    Joint,
    /// `ToPoint, Speed, Zone, Tool`
    Linear,
    /// `CirPoint, ToPoint, Speed, Zone, Tool`
    Circular,
    /// `ToJointPos, Speed, Zone` of external axes
    ExternalJoint,
}

/// What a movement instruction does besides moving.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MoveKind {
    /// Nothing.
    Plain,
    /// It sets outputs, calls procedures, or moves external axes.
    Event,
    /// It stops or stores its position when a signal changes.
    Search,
    /// It belongs to a process that is off: a movement between welds.
    Transfer,
    /// It welds with an arc.
    ArcWeld,
    /// It welds a spot at its end.
    SpotWeld,
    /// It dispenses.
    Dispense,
    /// It runs a process of the Continuous Application Platform.
    Application,
}

/// How the positional arguments of a movement instruction are arranged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MoveSignature {
    /// Interpolation.
    pub form: MoveForm,
    /// What it does besides moving.
    pub kind: MoveKind,
    /// Positional arguments before the target or circle point.
    pub before: usize,
    /// Positional arguments between the speed and the zone or tool.
    pub between: usize,
    /// True if it has a zone argument; without one it ends as a stop point.
    pub zone: bool,
    /// True for Move… with nothing but movement in it; Trigg…, Search…, Move…DO and
    /// the like do more than move.
    pub plain: bool,
}

/// The one argument that an instruction writes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Written {
    /// Its place among the positional arguments.
    pub position: usize,
    /// Its name, as RAPID writes it.
    pub name: &'static str,
}

/// Which of its arguments an instruction may write to, where no parameter is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Writes {
    Nothing,
    /// Each argument that stands for data.
    Any,
    /// Nothing is known: it may move the robot and write to each argument, as a call of a routine
    /// that is in no file.
    Unknown,
}

/// For what an instruction waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wait {
    /// For a time.
    Time,
    /// For an input.
    Input,
    /// For an output.
    Output,
    /// For a condition.
    Condition,
    /// For somebody at the teach pendant.
    Operator,
    /// For something else outside the program.
    Outside,
}

/// The level that an instruction gives to an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Its second argument.
    Given,
    /// 1.
    High,
    /// 0.
    Low,
    /// 1, and 0 soon after.
    Pulse,
    /// The other one.
    Inverse,
}

/// How an instruction counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// It adds its second argument, 1 without one.
    Up,
    /// It subtracts 1.
    Down,
    /// It sets 0.
    Clear,
}

/// A setting of motion that is simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// `AccSet`
    AccSet,
    /// `CirPathMode`
    CirPathMode,
    /// `ConfJ`
    ConfJ,
    /// `ConfL`
    ConfL,
    /// `GripLoad`
    GripLoad,
    /// `MotionProcessModeSet`
    MotionProcessMode,
    /// `PathAccLim`
    PathAccLim,
    /// `PathResol`
    PathResol,
    /// `PDispOff`
    PDispOff,
    /// `PDispOn`
    PDispOn,
    /// `PDispSet`
    PDispSet,
    /// `SingArea`
    SingArea,
    /// `SpeedRefresh`
    SpeedRefresh,
    /// `VelSet`
    VelSet,
    /// `WorldAccLim`
    WorldAccLim,
}

/// What an instruction does to what is simulated, besides moving and writing to its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Nothing.
    Nothing,
    /// It waits.
    Wait(Wait),
    /// It sets an output, its first argument.
    Output(Level),
    /// From here on the position of the robot sets an output.
    ZoneOutput,
    /// It counts in its first argument.
    Count(Count),
    /// It stops the program until somebody starts it again.
    Stop,
    /// It ends the cycle.
    ExitCycle,
    /// It changes how movements run.
    Setting(Setting),
    /// It changes how movements run, in a way that is not simulated.
    Unmodelled,
    /// It ends what these instructions (lower case), which are not simulated, have set.
    Ends(&'static [&'static str]),
    /// It writes to data, or calls a procedure, which it finds by a name that is a value.
    FindsByName,
}

/// One of RAPID's instructions.
#[derive(Clone, Copy, Debug)]
pub struct Instruction {
    /// As RAPID writes it.
    pub name: &'static str,
    arguments: &'static str,
    motion: Option<(MoveForm, MoveKind)>,
    writes: Writes,
    /// What it does to what is simulated.
    pub effect: Effect,
    /// Whether it is of no concern to anybody whether the robot has arrived when it runs: settings
    /// that take effect with the next movement, counters, messages.
    pub on_the_fly: bool,
    /// Whether it changes how movements run, or what is left of them.
    pub changes_motion: bool,
}

/// An instruction that writes to no argument that is not marked.
pub(super) const fn plain(name: &'static str, arguments: &'static str) -> Instruction {
    Instruction {
        name,
        arguments,
        motion: None,
        writes: Writes::Nothing,
        effect: Effect::Nothing,
        on_the_fly: false,
        changes_motion: false,
    }
}

/// An instruction that may write to each of its arguments.
pub(super) const fn writing(name: &'static str, arguments: &'static str) -> Instruction {
    Instruction { writes: Writes::Any, ..plain(name, arguments) }
}

/// An instruction that counts as one of which nothing is known.
pub(super) const fn unknown(name: &'static str, arguments: &'static str) -> Instruction {
    Instruction { writes: Writes::Unknown, ..plain(name, arguments) }
}

/// A setting of motion that is simulated.
pub(super) const fn setting(
    name: &'static str,
    arguments: &'static str,
    setting: Setting,
) -> Instruction {
    plain(name, arguments).effect(Effect::Setting(setting)).changing_motion()
}

impl Instruction {
    pub(super) const fn effect(self, effect: Effect) -> Instruction {
        Instruction { effect, ..self }
    }

    pub(super) const fn moving(self, form: MoveForm, kind: MoveKind) -> Instruction {
        Instruction { motion: Some((form, kind)), ..self }
    }

    pub(super) const fn on_the_fly(self) -> Instruction {
        Instruction { on_the_fly: true, ..self }
    }

    pub(super) const fn changing_motion(self) -> Instruction {
        Instruction { changes_motion: true, ..self }
    }

    /// The parameters in order.
    #[cfg(test)]
    pub(super) fn parameters(&self) -> impl Iterator<Item = Parameter> {
        parameters(self.arguments)
    }

    /// The kind of the signal that is its first positional argument.
    pub fn signal(&self) -> Option<SignalKind> {
        positional(self.arguments).next()?.signal()
    }

    /// Whether it moves.
    pub fn is_movement(&self) -> bool {
        self.motion.is_some()
    }

    /// Whether it is one of the Move, Trigg or Search family, which do nothing for a process.
    pub fn is_of_move_family(&self) -> bool {
        matches!(self.motion, Some((_, MoveKind::Plain | MoveKind::Event | MoveKind::Search)))
    }

    /// How its arguments are arranged, if it moves.
    pub fn movement(&self) -> Option<MoveSignature> {
        let (form, kind) = self.motion?;
        let place = |names: &[&str]| {
            positional(self.arguments).position(|parameter| names.contains(&parameter.name))
        };
        let speed = place(&["Speed"])?;
        let end = place(&["Zone", "Tool"]).unwrap_or_else(|| positional(self.arguments).count());
        Some(MoveSignature {
            form,
            kind,
            before: place(&["CirPoint", "ToPoint", "ToJointPos"])?,
            between: end - speed - 1,
            zone: place(&["Zone"]).is_some(),
            plain: kind == MoveKind::Plain,
        })
    }

    /// The argument to which it writes, if that is one of several.
    pub fn written(&self) -> Option<Written> {
        let mut places = positional(self.arguments).enumerate();
        let (position, parameter) = places.find(|(_, parameter)| parameter.written)?;
        Some(Written { position, name: parameter.name })
    }

    /// Whether it is known what it does.
    pub fn is_known(&self) -> bool {
        self.writes != Writes::Unknown
    }

    /// Whether it moves or may do so.
    pub fn may_move(&self) -> bool {
        self.is_movement() || !self.is_known()
    }

    /// Whether it writes to arguments, as far as is known.
    pub fn is_writing(&self) -> bool {
        self.writes == Writes::Any || self.written().is_some()
    }

    /// Whether it may write to arguments.
    pub fn may_write(&self) -> bool {
        self.writes != Writes::Nothing || self.written().is_some()
    }

    /// Whether it counts in its first argument.
    pub fn counts(&self) -> bool {
        matches!(self.effect, Effect::Count(_))
    }

    /// Whether it sets an output at once.
    pub fn sets_output(&self) -> bool {
        matches!(self.effect, Effect::Output(_))
    }

    /// Whether it writes to data, or calls a procedure, which it finds by a name that is a value.
    pub fn finds_by_name(&self) -> bool {
        self.effect == Effect::FindsByName
    }

    /// Whether it waits for an input.
    pub fn waits_for_input(&self) -> bool {
        self.effect == Effect::Wait(Wait::Input)
    }

    /// Whether it waits for somebody at the robot.
    pub fn asks_operator(&self) -> bool {
        matches!(self.effect, Effect::Stop | Effect::Wait(Wait::Operator))
    }

    /// Whether it waits for somebody or something outside, for how long is not in the program.
    pub fn waits_outside(&self) -> bool {
        matches!(self.effect, Effect::Wait(Wait::Operator | Wait::Outside))
    }
}
