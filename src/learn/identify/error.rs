//! Errors of an identification.

use thiserror::Error;

/// Error of an identification.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IdentifyError {
    /// The log is too short for the filter: required duration \[s\].
    #[error("the log has no piece of {0:.2} s without a gap: record longer")]
    Short(f64),
    /// No joint moves by this range \[rad\].
    #[error("no joint moves by {0} rad or more: record a motion, such as that of joulepath excite")]
    Still(f64),
    /// Fewer equations than unknowns.
    #[error(
        "{equations} usable equations for {unknowns} parameters: record longer, or free fewer with --free"
    )]
    TooFew {
        /// Number of equations.
        equations: usize,
        /// Number of unknowns.
        unknowns: usize,
    },
    /// Torques that do not fit the log.
    #[error("{joints} series of torques for {logged} joints: give one for each joint")]
    Torques {
        /// Number of series.
        joints: usize,
        /// Joints of the log.
        logged: usize,
    },
    /// A series of torques that does not fit the log.
    #[error("tau{joint} has {rows} values, the log {logged} rows: give one for each row")]
    TorqueRows {
        /// Joint number, from 1.
        joint: usize,
        /// Values of the series.
        rows: usize,
        /// Rows of the log.
        logged: usize,
    },
    /// A torque that is not finite.
    #[error("tau{joint} is not a finite number in row {row}: leave the row out")]
    NotFinite {
        /// Joint number, from 1.
        joint: usize,
        /// Row of the log, from 1.
        row: usize,
    },
    /// The log is of another robot.
    #[error(
        "the log has {logged} joints, the robot {dof}: give a position and a torque for each joint"
    )]
    OtherRobot {
        /// Joints of the log.
        logged: usize,
        /// Joints of the robot.
        dof: usize,
    },
    /// The fixed parameters of this robot are unknown.
    #[error(
        "{0} has no dynamics to start from: give its links, [[link]], in a robot file, or identify all with --free all"
    )]
    NoDynamics(String),
    /// No physically consistent model exists.
    #[error(
        "no physically consistent model was found: the links of the robot file are no bodies, leave them out"
    )]
    Inconsistent,
    /// Angles are in degrees instead of radians.
    #[error(
        "q{joint} reaches {reach:.1} and changes by {fast:.1} per s, which are no radians: it seems to be in degrees; name the column q{joint}_deg"
    )]
    Degrees {
        /// Joint number, from 1.
        joint: usize,
        /// Largest value.
        reach: f64,
        /// Large quantile of its rate.
        fast: f64,
    },
    /// Columns declared in degrees are in radians: largest travel, in the unit of its column.
    #[error(
        "the columns q1_deg… change by {0:.2} at most, which as degrees is hardly a motion: they seem to be in radians; name them q1…"
    )]
    Radians(f64),
    /// Rates that do not correlate with the positions.
    #[error(
        "qd{joint} has little to do with the motion of q{joint} ({:.0} % of it): is it another joint's? map the right column, or leave it out and it is differentiated",
        100.0 * share
    )]
    Unrelated {
        /// Joint number, from 1.
        joint: usize,
        /// Squared correlation.
        share: f64,
    },
    /// Rates that differ from those of the positions by a factor.
    #[error(
        "qd{joint} is {factor:.3} times the rate of q{joint}{}",
        rates_hint(*factor, *joint)
    )]
    Rates {
        /// Joint number, from 1.
        joint: usize,
        /// Logged over differentiated rate.
        factor: f64,
    },
    /// Accelerations that differ from those of the rates by a factor.
    #[error(
        "qdd{joint} is {factor:.3} times the change of qd{joint}{}",
        unit_hint("qdd", *factor, *joint)
    )]
    Accelerations {
        /// Joint number, from 1.
        joint: usize,
        /// Logged over differentiated acceleration.
        factor: f64,
    },
    /// Rows too far apart for differentiation: median interval \[s\].
    #[error(
        "rows are {0} s apart, too far to tell rates from positions: t has to be in seconds (is it in ms?), or log qd1… and qdd1…"
    )]
    Slow(f64),
    /// A constant torque of this joint, from 1.
    #[error(
        "tau{0} never changes while joint {0} moves: it was not recorded; record it, or map another column"
    )]
    Dead(usize),
    /// Torques far above the limits.
    #[error(
        "tau{joint} is mostly {reach:.0} Nm, the limit of the joint is {limit:.0} Nm: torques have to be in Nm at the joint (are they in mNm?)"
    )]
    Large {
        /// Joint number, from 1.
        joint: usize,
        /// Median size \[Nm\].
        reach: f64,
        /// Limit \[Nm\].
        limit: f64,
    },
    /// A motor torque among joint torques.
    #[error(
        "tau{joint} seems to be that of the motor, smaller by the gear ratio {ratio} than those of the other joints: multiply it by the ratio"
    )]
    OneMotorSide {
        /// Joint number, from 1.
        joint: usize,
        /// Its gear ratio.
        ratio: f64,
    },
    /// Motor torques instead of joint torques.
    #[error(
        "the torques seem to be those of the motors: joint {joint} holds its weight with a torque that is smaller by its gear ratio {ratio}; multiply each tau by its ratio, or give currents as i1…"
    )]
    MotorSide {
        /// Joint number, from 1.
        joint: usize,
        /// Its gear ratio.
        ratio: f64,
    },
    /// The number of joints differs.
    #[error("the log has a column {column}, the robot has {joints} joints: is it another robot's?")]
    Joints {
        /// A surplus column.
        column: String,
        /// Number of the robot's joints.
        joints: usize,
    },
    /// A column is missing.
    #[error("the log has no column {column}, which a robot of {joints} joints needs")]
    Column {
        /// Its name.
        column: String,
        /// Number of the robot's joints.
        joints: usize,
    },
    /// Neither torques nor currents for this number of joints.
    #[error(
        "the log has no torques: give tau1…tau{0} (Nm, at the joint), i1… (A rms, motor) or ia1,ib1,ic1… (A)"
    )]
    NoTorque(usize),
    /// Currents of a robot without torque constants.
    #[error(
        "{0} has no torque constants: give motors.torque_constant and motors.ratio in the robot file, or log torques"
    )]
    NoConstants(String),
    /// The sign of the current amplitude of this joint, from 1, is unknown.
    #[error(
        "nothing tells the sign of the current of joint {0}: its phases do not turn with the motor (gear ratio?) and the model has no dynamics to compare with"
    )]
    Sign(usize),
}

/// Degrees in a radian.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Whether a factor is near another one.
fn near(factor: f64, other: f64) -> bool {
    factor > 0.0 && (factor / other).ln().abs() < 0.2
}

/// Probable cause of a factor between logged and differentiated rates.
fn rates_hint(factor: f64, joint: usize) -> String {
    if near(factor, 1.0 / DEGREES) {
        format!(": the positions seem to be in degrees; name the column q{joint}_deg")
    } else if [1e3, 1e6, 1e9].iter().any(|other| near(factor, *other)) {
        format!(": the time seems to be in {}; give t in s", below_a_second(factor))
    } else {
        unit_hint("qd", factor, joint)
    }
}

/// Probable cause of a factor between logged values of a column and differentiated ones.
fn unit_hint(column: &str, factor: f64, joint: usize) -> String {
    if near(factor, DEGREES) {
        format!(": it seems to be in degrees; name the column {column}{joint}_deg")
    } else if factor < 0.0 {
        ": it has the opposite sign; multiply it by -1, or leave the column out".into()
    } else {
        ": its unit can't be right; leave the column out and it is differentiated".into()
    }
}

/// The unit of time of which a second has about `count`.
fn below_a_second(count: f64) -> &'static str {
    if count < 1e4 {
        "ms"
    } else if count < 1e7 {
        "µs"
    } else {
        "ns"
    }
}
