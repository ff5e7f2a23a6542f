//! Names of the columns of a log.

/// A measured quantity; joints count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// `t` \[s\].
    Time,
    /// `q1` \[rad\] or `q1_deg`.
    Position(usize),
    /// `qd1` \[rad/s\] or `qd1_deg`.
    Velocity(usize),
    /// `qdd1` \[rad/s²\] or `qdd1_deg`.
    Acceleration(usize),
    /// `tau1` \[Nm\], joint side.
    Torque(usize),
    /// `i1` \[A rms\], motor.
    Current(usize),
    /// `ia1`, `ib1`, `ic1` \[A\]; phases count from 0.
    PhaseCurrent(usize, usize),
    /// `temp1` \[°C\].
    Temperature(usize),
    /// `power` \[W\].
    Power,
    /// `sync` \[V or 0/1\].
    Sync,
    /// `cycle`, the number of the repetition.
    Cycle,
    /// `line`, the line of the program.
    Line,
    /// `cmd`, the number of the current movement; 0 = none.
    Command,
}

/// Channels that a log has for all joints or for none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Family {
    Position,
    Velocity,
    Acceleration,
    Torque,
    Current,
    PhaseCurrent(usize),
    Temperature,
    Single,
}

/// A column's channel, and its factor to the SI unit.
pub(super) struct Named {
    pub(super) channel: Channel,
    pub(super) unit: f64,
}

impl Channel {
    pub(super) fn family(self) -> Family {
        match self {
            Channel::Position(_) => Family::Position,
            Channel::Velocity(_) => Family::Velocity,
            Channel::Acceleration(_) => Family::Acceleration,
            Channel::Torque(_) => Family::Torque,
            Channel::Current(_) => Family::Current,
            Channel::PhaseCurrent(_, phase) => Family::PhaseCurrent(phase),
            Channel::Temperature(_) => Family::Temperature,
            _ => Family::Single,
        }
    }

    /// The channel of a column name, regardless of case; `None` for an unknown name.
    pub(super) fn named(name: &str) -> Option<Named> {
        let name = name.trim().to_ascii_lowercase();
        let plain = |channel| Some(Named { channel, unit: 1.0 });
        match name.as_str() {
            "t" => return plain(Channel::Time),
            "power" => return plain(Channel::Power),
            "sync" => return plain(Channel::Sync),
            "cycle" => return plain(Channel::Cycle),
            "line" => return plain(Channel::Line),
            "cmd" => return plain(Channel::Command),
            _ => {}
        }
        let (name, degrees) = match name.strip_suffix("_deg") {
            Some(name) => (name, true),
            None => (name.as_str(), false),
        };
        let digits = name.find(|c: char| c.is_ascii_digit())?;
        let (quantity, number) = name.split_at(digits);
        let joint = number.parse::<usize>().ok()?.checked_sub(1)?;
        let angle = match quantity {
            "q" => Some(Channel::Position(joint)),
            "qd" => Some(Channel::Velocity(joint)),
            "qdd" => Some(Channel::Acceleration(joint)),
            _ => None,
        };
        match (angle, degrees) {
            (Some(channel), true) => Some(Named { channel, unit: 1.0_f64.to_radians() }),
            (Some(channel), false) => plain(channel),
            (None, true) => None,
            (None, false) => match quantity {
                "tau" => plain(Channel::Torque(joint)),
                "i" => plain(Channel::Current(joint)),
                "ia" => plain(Channel::PhaseCurrent(joint, 0)),
                "ib" => plain(Channel::PhaseCurrent(joint, 1)),
                "ic" => plain(Channel::PhaseCurrent(joint, 2)),
                "temp" => plain(Channel::Temperature(joint)),
                _ => None,
            },
        }
    }

    /// The joint of the channel, if any.
    pub(super) fn joint(self) -> Option<usize> {
        match self {
            Channel::Position(joint)
            | Channel::Velocity(joint)
            | Channel::Acceleration(joint)
            | Channel::Torque(joint)
            | Channel::Current(joint)
            | Channel::PhaseCurrent(joint, _)
            | Channel::Temperature(joint) => Some(joint),
            _ => None,
        }
    }
}
