//! Properties of a built-in instruction.

use super::parameter::{ArgumentPlace, is_written, parameters, positional};
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
    /// It belongs to a process package, with the process off: a movement between welds.
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

/// The order of the positional arguments of a movement instruction.
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
}

/// The arguments that an instruction may write to, if none is marked in its parameter list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Writes {
    Nothing,
    /// Every argument that is a data object.
    Any,
    /// It may move the robot and write to every argument, like an undeclared routine.
    Unknown,
}

/// What an instruction waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wait {
    /// A time.
    Time,
    /// An input.
    Input,
    /// An output.
    Output,
    /// A condition.
    Condition,
    /// The robot's standstill.
    Standstill,
    /// The operator.
    Operator,
    /// Another event outside the program.
    Outside,
}

/// The level to which an instruction sets an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Its second argument.
    Given,
    /// 1.
    High,
    /// 0.
    Low,
    /// 1, then 0 after the pulse.
    Pulse,
    /// The inverse of its level.
    Inverse,
}

/// How an instruction counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// It adds its second argument, or 1 without one.
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
    /// `SetSysData`
    SystemData,
    /// `SpeedRefresh`
    SpeedRefresh,
    /// `VelSet`
    VelSet,
    /// `WorldAccLim`
    WorldAccLim,
}

/// The effect of an instruction on the simulation, besides movement and written arguments.
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
    /// It stops the program until the operator restarts it.
    Stop,
    /// It ends the cycle.
    ExitCycle,
    /// It changes how movements run.
    Setting(Setting),
    /// It changes how movements run, in a way that is not simulated.
    Unmodelled,
    /// It ends the unmodelled settings of these instructions (lower case).
    Ends(&'static [&'static str]),
    /// It writes to data, or calls a procedure, whose name is computed at execution.
    FindsByName,
}

/// A built-in instruction.
#[derive(Clone, Copy, Debug)]
pub struct Instruction {
    /// As RAPID writes it.
    pub name: &'static str,
    pub(super) arguments: &'static str,
    motion: Option<(MoveForm, MoveKind)>,
    writes: Writes,
    /// Its effect on the simulation.
    pub effect: Effect,
    /// True if its effect is the same before and after the robot reaches its target: settings for
    /// the next movement, counters, messages.
    pub on_the_fly: bool,
    /// Whether it changes how movements run, or discards the rest of a path.
    pub changes_motion: bool,
}

/// An instruction that writes only to marked arguments.
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

/// An instruction that may write to every argument.
pub(super) const fn writing(name: &'static str, arguments: &'static str) -> Instruction {
    Instruction { writes: Writes::Any, ..plain(name, arguments) }
}

/// An instruction that is treated like an undeclared routine.
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

    /// The kind of the signal that is its first positional argument.
    pub fn signal(&self) -> Option<SignalKind> {
        positional(self.arguments).next()?.signal()
    }

    /// The name of the positional parameter at this place, from 0.
    pub fn parameter(&self, position: usize) -> Option<&'static str> {
        positional(self.arguments).nth(position).map(|parameter| parameter.name)
    }

    /// Whether it moves.
    pub fn is_movement(&self) -> bool {
        self.motion.is_some()
    }

    /// Whether it belongs to the Move, Trigg or Search family, which run no process.
    pub fn is_of_move_family(&self) -> bool {
        matches!(self.motion, Some((_, MoveKind::Plain | MoveKind::Event | MoveKind::Search)))
    }

    /// The order of its arguments, if it moves.
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
        })
    }

    fn marks_written(&self) -> bool {
        parameters(self.arguments).any(|parameter| parameter.written)
    }

    /// Whether it may write to the argument at this place.
    pub fn may_write_to(&self, place: ArgumentPlace<'_>) -> bool {
        if self.marks_written() {
            return is_written(self.arguments, place);
        }
        self.writes != Writes::Nothing
    }

    /// Whether its effect is known.
    pub fn is_known(&self) -> bool {
        self.writes != Writes::Unknown
    }

    /// Whether it moves or may do so.
    pub fn may_move(&self) -> bool {
        self.is_movement() || !self.is_known()
    }

    /// Whether it is known to write to arguments.
    pub fn is_writing(&self) -> bool {
        self.writes == Writes::Any || self.marks_written()
    }

    /// Whether it may write to arguments.
    pub fn may_write(&self) -> bool {
        self.writes != Writes::Nothing || self.marks_written()
    }

    /// Whether it counts in its first argument.
    pub fn counts(&self) -> bool {
        matches!(self.effect, Effect::Count(_))
    }

    /// Whether it sets an output at once.
    pub fn sets_output(&self) -> bool {
        matches!(self.effect, Effect::Output(_))
    }

    /// Whether it writes to data, or calls a procedure, whose name is computed at execution.
    pub fn finds_by_name(&self) -> bool {
        self.effect == Effect::FindsByName
    }

    /// Whether it waits.
    pub fn waits(&self) -> bool {
        matches!(self.effect, Effect::Wait(_))
    }

    /// Whether it waits for a time.
    pub fn waits_for_time(&self) -> bool {
        self.effect == Effect::Wait(Wait::Time)
    }

    /// Whether it waits for an input.
    pub fn waits_for_input(&self) -> bool {
        self.effect == Effect::Wait(Wait::Input)
    }

    /// Whether it waits for the operator.
    pub fn asks_operator(&self) -> bool {
        matches!(self.effect, Effect::Stop | Effect::Wait(Wait::Operator))
    }
}
