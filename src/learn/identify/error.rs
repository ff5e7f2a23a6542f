//! What makes an identification impossible.

use thiserror::Error;

/// Input that no model can be identified from.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IdentifyError {
    /// The log is too short for its filter.
    #[error("the log has no piece of {seconds:.2} s without a gap: record longer")]
    Short {
        /// What is needed \[s\].
        seconds: f64,
    },
    /// Nothing moves.
    #[error(
        "no joint moves by {range} rad or more: record a motion, such as that of joulepath excite"
    )]
    Still {
        /// Least range of a joint that moves \[rad\].
        range: f64,
    },
    /// Fewer equations than unknowns.
    #[error(
        "{equations} usable equations for {unknowns} parameters: record longer, or free fewer with --free"
    )]
    TooFew {
        /// Rows.
        equations: usize,
        /// Columns.
        unknowns: usize,
    },
    /// What is not free is not known.
    #[error(
        "{name} has no dynamics to start from: give its links, [[link]], in a robot file, or identify all with --free all"
    )]
    NoDynamics {
        /// The robot.
        name: String,
    },
    /// No body fits.
    #[error(
        "no physically consistent model was found: the links of the robot file are no bodies, leave them out"
    )]
    Inconsistent,
    /// Degrees where radians are meant.
    #[error(
        "q{joint} reaches {reach:.1} and changes by {fast:.1} per s, which are no radians: it seems to be in degrees; name the column q{joint}_deg"
    )]
    Degrees {
        /// From 1.
        joint: usize,
        /// Largest value.
        reach: f64,
        /// Nearly the largest rate.
        fast: f64,
    },
    /// Radians where degrees are said.
    #[error(
        "the columns q1_deg… change by {reach:.2} at most, which as degrees is hardly a motion: they seem to be in radians; name them q1…"
    )]
    Radians {
        /// What the joint that moves most turns, in the unit of its column.
        reach: f64,
    },
    /// Rates of something else.
    #[error(
        "qd{joint} has little to do with the motion of q{joint} ({:.0} % of it): is it another joint's? map the right column, or leave it out and it is differentiated",
        100.0 * share
    )]
    Unrelated {
        /// From 1.
        joint: usize,
        /// Squared correlation.
        share: f64,
    },
    /// Rates that are not those of the positions.
    #[error(
        "qd{joint} is {factor:.3} times the rate of q{joint}{}",
        rates_hint(*factor, *joint)
    )]
    Rates {
        /// From 1.
        joint: usize,
        /// Logged over differentiated.
        factor: f64,
    },
    /// Accelerations that are not those of the rates.
    #[error(
        "qdd{joint} is {factor:.3} times the change of qd{joint}{}",
        accelerations_hint(*factor, *joint)
    )]
    Accelerations {
        /// From 1.
        joint: usize,
        /// Logged over differentiated.
        factor: f64,
    },
    /// Rows too far apart to differentiate.
    #[error(
        "rows are {step} s apart, too far to tell rates from positions: t has to be in seconds (is it in ms?), or log qd1… and qdd1…"
    )]
    Slow {
        /// Median interval \[s\].
        step: f64,
    },
    /// A torque that never changes.
    #[error(
        "tau{joint} never changes while joint {joint} moves: it was not recorded; record it, or map another column"
    )]
    Dead {
        /// From 1.
        joint: usize,
    },
    /// Torques beyond all limits.
    #[error(
        "tau{joint} is mostly {reach:.0} Nm, the limit of the joint is {limit:.0} Nm: torques have to be in Nm at the joint (are they in mNm?)"
    )]
    Large {
        /// From 1.
        joint: usize,
        /// Median size \[Nm\].
        reach: f64,
        /// Limit \[Nm\].
        limit: f64,
    },
    /// A torque of one motor among torques of joints.
    #[error(
        "tau{joint} seems to be that of the motor, smaller by the gear ratio {ratio} than those of the other joints: multiply it by the ratio"
    )]
    OneMotorSide {
        /// From 1.
        joint: usize,
        /// Its gear ratio.
        ratio: f64,
    },
    /// Torques of the motors.
    #[error(
        "the torques seem to be those of the motors: joint {joint} holds its weight with a torque that is smaller by its gear ratio {ratio}; multiply each tau by its ratio, or give currents as i1…"
    )]
    MotorSide {
        /// A joint, from 1.
        joint: usize,
        /// Its gear ratio.
        ratio: f64,
    },
    /// Another number of joints.
    #[error("the log has a column {column}, the robot has {joints} joints: is it another robot's?")]
    Joints {
        /// A column too many.
        column: String,
        /// The robot's joints.
        joints: usize,
    },
    /// A column is missing among others.
    #[error("the log has no column {column}, which a robot of {joints} joints needs")]
    Column {
        /// Its name.
        column: String,
        /// The robot's joints.
        joints: usize,
    },
    /// Nothing to identify from.
    #[error(
        "the log has no torques: give tau1…tau{joints} (Nm, at the joint), i1… (A rms, motor) or ia1,ib1,ic1… (A)"
    )]
    NoTorque {
        /// The robot's joints.
        joints: usize,
    },
    /// Currents without torque constants.
    #[error(
        "{name} has no torque constants: give motors.torque_constant and motors.ratio in the robot file, or log torques"
    )]
    NoConstants {
        /// The robot.
        name: String,
    },
    /// Amplitudes of which nothing tells the sign.
    #[error(
        "nothing tells the sign of the current of joint {joint}: its phases do not turn with the motor (gear ratio?) and the model has no dynamics to compare with"
    )]
    Sign {
        /// From 1.
        joint: usize,
    },
}

/// Whether a factor is about another one.
fn near(factor: f64, other: f64) -> bool {
    factor > 0.0 && (factor / other).ln().abs() < 0.2
}

/// What a factor between rates seems to be.
fn rates_hint(factor: f64, joint: usize) -> String {
    let degrees = 180.0 / std::f64::consts::PI;
    if near(factor, degrees) {
        format!(": it seems to be in degrees; name the column qd{joint}_deg")
    } else if near(factor, 1.0 / degrees) {
        format!(": the positions seem to be in degrees; name the column q{joint}_deg")
    } else if near(factor, 1e3) || near(factor, 1e6) || near(factor, 1e9) {
        format!(": the time seems to be in {}; give t in s", below_a_second(factor))
    } else if factor < 0.0 {
        ": it has the other sense; turn it, or leave the column out".into()
    } else {
        ": its unit can't be right; leave the column out and it is differentiated".into()
    }
}

/// What a factor between accelerations seems to be.
fn accelerations_hint(factor: f64, joint: usize) -> String {
    let degrees = 180.0 / std::f64::consts::PI;
    if near(factor, degrees) {
        format!(": it seems to be in degrees; name the column qdd{joint}_deg")
    } else if factor < 0.0 {
        ": it has the other sense; turn it, or leave the column out".into()
    } else {
        ": its unit can't be right; leave the column out and it is differentiated".into()
    }
}

/// The unit of time of which a second has about so many.
fn below_a_second(count: f64) -> &'static str {
    if count < 1e4 {
        "ms"
    } else if count < 1e7 {
        "µs"
    } else {
        "ns"
    }
}
