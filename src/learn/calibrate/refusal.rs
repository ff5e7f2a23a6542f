//! Why a log does not calibrate a robot.

use thiserror::Error;

/// Why a log does not calibrate a robot.
#[derive(Clone, Debug, Error)]
pub enum Refusal {
    /// There is nothing to learn.
    #[error(
        "nothing of {name} is estimated: there is nothing to calibrate; run the program with --robot as it is"
    )]
    Known {
        /// The robot.
        name: String,
    },
    /// A calibrated robot.
    #[error(
        "{name} is calibrated already: give the robot that its file was made from, with a log over more cycles"
    )]
    Again {
        /// The robot.
        name: String,
    },
    /// No time passes, or it never ends.
    #[error(
        "the simulated cycle takes no time or never ends: there is nothing to compare the log with; see joulepath simulate"
    )]
    Nothing,
    /// Too few rows.
    #[error(
        "the log has rows in only {windows} of about 100 parts of the cycle, at least {least} are asked for: log the power more often"
    )]
    Sparse {
        /// Parts with rows.
        windows: usize,
        /// What is asked for.
        least: usize,
    },
    /// Too short.
    #[error(
        "the log holds {log_s:.1} s and no whole cycle of {cycle_s:.1} s: log the power over several cycles, or say when inputs come (--input)"
    )]
    Short {
        /// s.
        log_s: f64,
        /// s.
        cycle_s: f64,
    },
    /// Cycles of another length.
    #[error(
        "the log is of another program: its cycles take {measured_s:.1} s, the simulated one {cycle_s:.1} s (5 % may differ); say when inputs come (--input) if waits are longer, and --speed-override if the cell ran with one"
    )]
    Length {
        /// s.
        measured_s: f64,
        /// s.
        cycle_s: f64,
    },
    /// Commands that do not fit.
    #[error(
        "the log is of another program: the column `cmd` counts {measured} movements a cycle, the simulated cycle has {simulated}"
    )]
    Commands {
        /// Movements in the log.
        measured: usize,
        /// Movements of the program.
        simulated: usize,
    },
    /// Nothing is drawn.
    #[error("the power is {mean_w:.0} W in the mean: is its sign turned, or is it another column?")]
    Negative {
        /// W.
        mean_w: f64,
    },
    /// Nothing changes.
    #[error(
        "the power is {power_w:.0} W all the time: it has no cycle; log it while the program runs"
    )]
    Constant {
        /// W.
        power_w: f64,
    },
    /// Cycles that differ.
    #[error(
        "the power of the cycle at {begin_s:.1} s is {factor:.0} times that of another one: does its unit change within the log?"
    )]
    Unlike {
        /// s.
        begin_s: f64,
        /// Largest mean power over the smallest.
        factor: f64,
    },
    /// A torque goes another way.
    #[error(
        "the torque of joint {joint} goes against what plausible robots need (correlation {correlation:.2}): is its sign turned, or are columns exchanged? Leave the torques out with --map, or turn it"
    )]
    Torque {
        /// From 1.
        joint: usize,
        /// With that of the model.
        correlation: f64,
    },
    /// The power goes another way.
    #[error(
        "the log does not fit this program: nowhere does its power go like the simulated cycle's (correlation {correlation:.2}, at least {least:.2}); check the program, the columns and the unit of `t` (s), say when inputs come (--input) if waits differ, or log `cmd`"
    )]
    Shape {
        /// The best one.
        correlation: f64,
        /// What is asked for.
        least: f64,
    },
    /// No plausible robot has that power over the cycle.
    #[error(
        "the log is of another program: the robot that fits it best explains {:.0} % of how the power changes over the cycle, at least {:.0} % are asked for",
        100.0 * explained.max(0.0), 100.0 * least
    )]
    Program {
        /// Share of the variance.
        explained: f64,
        /// What is asked for.
        least: f64,
    },
    /// The power is of another size.
    #[error(
        "the log is of another robot, or its unit is not W or kW: the {what} is {measured:.0} W, plausible {name} robots have {low:.0} to {high:.0} W in this program"
    )]
    Robot {
        /// The robot.
        name: String,
        /// What differs.
        what: &'static str,
        /// W.
        measured: f64,
        /// W.
        low: f64,
        /// W.
        high: f64,
    },
    /// Too few draws fit.
    #[error(
        "no plausible robot of this type draws this power in this program ({fitted} of {robots} can be moved to it): check program, robot, unit and waits (--input)"
    )]
    Fit {
        /// Those that fit.
        fitted: usize,
        /// All.
        robots: usize,
    },
    /// The result is no robot.
    #[error("the calibrated robot can't be used: {reason}")]
    Model {
        /// Why.
        reason: String,
    },
}
