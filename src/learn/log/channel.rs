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
    /// `part`, the kind of workpiece: a number, or one that stands for its name.
    Part,
    /// `payload` \[kg\].
    Payload,
}

/// A column's channel, and its factor to the SI unit.
pub(super) struct Named {
    pub(super) channel: Channel,
    pub(super) unit: f64,
}

impl Channel {
    /// Whether both are the same quantity, perhaps of different joints: a log has it for all joints
    /// or for none.
    pub(super) fn is_same_quantity(self, other: Channel) -> bool {
        match (self, other) {
            (Channel::PhaseCurrent(_, phase), Channel::PhaseCurrent(_, other)) => phase == other,
            _ => std::mem::discriminant(&self) == std::mem::discriminant(&other),
        }
    }

    /// Whether it is a position, a rate or an acceleration.
    pub(crate) fn is_motion(self) -> bool {
        matches!(self, Channel::Position(_) | Channel::Velocity(_) | Channel::Acceleration(_))
    }

    /// Whether it tells what is made: only commands that compare products read it.
    pub(super) fn is_product(self) -> bool {
        matches!(self, Channel::Part | Channel::Payload)
    }

    /// The channel of a column name, regardless of case; `None` for an unknown name.
    pub(super) fn named(name: &str) -> Option<Named> {
        let name = name.trim().to_ascii_lowercase();
        let single = match name.as_str() {
            "t" => Some(Channel::Time),
            "power" => Some(Channel::Power),
            "sync" => Some(Channel::Sync),
            "cycle" => Some(Channel::Cycle),
            "line" => Some(Channel::Line),
            "cmd" => Some(Channel::Command),
            "part" => Some(Channel::Part),
            "payload" => Some(Channel::Payload),
            _ => None,
        };
        if let Some(channel) = single {
            return Some(Named { channel, unit: 1.0 });
        }
        let degrees = name.strip_suffix("_deg");
        let name = degrees.unwrap_or(&name);
        let (quantity, number) = name.split_at(name.find(|c: char| c.is_ascii_digit())?);
        let joint = number.parse::<usize>().ok()?.checked_sub(1)?;
        let channel = match (quantity, degrees) {
            ("q", _) => Channel::Position(joint),
            ("qd", _) => Channel::Velocity(joint),
            ("qdd", _) => Channel::Acceleration(joint),
            ("tau", None) => Channel::Torque(joint),
            ("i", None) => Channel::Current(joint),
            ("ia", None) => Channel::PhaseCurrent(joint, 0),
            ("ib", None) => Channel::PhaseCurrent(joint, 1),
            ("ic", None) => Channel::PhaseCurrent(joint, 2),
            ("temp", None) => Channel::Temperature(joint),
            _ => return None,
        };
        Some(Named { channel, unit: degrees.map_or(1.0, |_| 1.0_f64.to_radians()) })
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
