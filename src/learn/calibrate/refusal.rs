//! Reasons to refuse a log for calibration.

use thiserror::Error;

/// Reason to refuse a log for calibration.
#[derive(Clone, Debug, Error)]
pub enum Refusal {
    /// All parameters of this robot are known.
    #[error(
        "nothing of {0} is estimated: there is nothing to calibrate; run the program with --robot as it is"
    )]
    Known(String),
    /// This robot is already calibrated.
    #[error(
        "{0} is calibrated already: give the robot that its file was made from, with a log over more cycles"
    )]
    Again(String),
    /// The simulated cycle has no duration or no end.
    #[error(
        "the simulated cycle takes no time or never ends: there is nothing to compare the log with; see joulepath simulate"
    )]
    Nothing,
    /// Too few rows in the log.
    #[error(
        "the log has rows in only {windows} of about 100 parts of the cycle, at least {least} are asked for: log the power more often"
    )]
    Sparse {
        /// Windows with rows.
        windows: usize,
        /// Required number.
        least: usize,
    },
    /// The log is shorter than a cycle.
    #[error(
        "the log holds {log_s:.1} s and no whole cycle of {cycle_s:.1} s: log the power over several cycles, or say when inputs come (--input)"
    )]
    Short {
        /// Duration of the log \[s\].
        log_s: f64,
        /// Duration of the cycle \[s\].
        cycle_s: f64,
    },
    /// The cycles have another duration.
    #[error(
        "the log is of another program: its cycles take {measured_s:.1} s, the simulated one {cycle_s:.1} s (5 % may differ); say when inputs come (--input) if waits are longer, and --speed-override if the cell ran with one"
    )]
    Length {
        /// Duration in the log \[s\].
        measured_s: f64,
        /// Simulated duration \[s\].
        cycle_s: f64,
    },
    /// The number of movements differs.
    #[error(
        "the log is of another program: the column `cmd` counts {measured} movements a cycle, the simulated cycle has {simulated}"
    )]
    Commands {
        /// Movements in the log.
        measured: usize,
        /// Movements of the program.
        simulated: usize,
    },
    /// The mean power \[W\] is not positive.
    #[error("the power is {0:.0} W in the mean: is its sign turned, or is it another column?")]
    Negative(f64),
    /// The power is constant \[W\].
    #[error("the power is {0:.0} W all the time: it has no cycle; log it while the program runs")]
    Constant(f64),
    /// The power differs between cycles.
    #[error(
        "the power of the cycle at {begin_s:.1} s is {factor:.0} times that of another one: does its unit change within the log?"
    )]
    Unlike {
        /// Start of the cycle in the log \[s\].
        begin_s: f64,
        /// Largest mean power over the smallest.
        factor: f64,
    },
    /// A torque has the opposite sign.
    #[error(
        "the torque of joint {joint} goes against what plausible robots need (correlation {correlation:.2}): is its sign turned, or are columns exchanged? Leave the torques out with --map, or turn it"
    )]
    Torque {
        /// Joint number, from 1.
        joint: usize,
        /// Correlation with the simulated torque.
        correlation: f64,
    },
    /// The power does not correlate with the simulated power.
    #[error(
        "the log does not fit this program: nowhere does its power go like the simulated cycle's (correlation {correlation:.2}, at least {least:.2}); check the program, the columns and the unit of `t` (s), say when inputs come (--input) if waits differ, or log `cmd`"
    )]
    Shape {
        /// Largest correlation found.
        correlation: f64,
        /// Required correlation.
        least: f64,
    },
    /// No plausible robot explains the change of the power over the cycle.
    #[error(
        "the log is of another program: the robot that fits it best explains {:.0} % of how the power changes over the cycle, at least {:.0} % are asked for",
        100.0 * explained.max(0.0), 100.0 * least
    )]
    Program {
        /// Explained share of the variance.
        explained: f64,
        /// Required share.
        least: f64,
    },
    /// The size of the power is implausible.
    #[error(
        "the log is of another robot, or its unit is not W or kW: the {what} is {measured:.0} W, plausible {name} robots have {low:.0} to {high:.0} W in this program"
    )]
    Robot {
        /// The robot.
        name: String,
        /// The quantity that differs.
        what: &'static str,
        /// Measured value \[W\].
        measured: f64,
        /// Lower plausible value \[W\].
        low: f64,
        /// Upper plausible value \[W\].
        high: f64,
    },
    /// Too few draws fit the log.
    #[error(
        "no plausible robot of this type draws this power in this program ({fitted} of {robots} can be moved to it): check program, robot, unit and waits (--input)"
    )]
    Fit {
        /// Number of draws that fit.
        fitted: usize,
        /// Number of all draws.
        robots: usize,
    },
    /// The calibrated model is invalid for this reason.
    #[error("the calibrated robot can't be used: {0}")]
    Model(String),
}
