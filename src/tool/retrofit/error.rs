//! Errors that prevent a retrofit.

use crate::arm::robot::NotReady;
use crate::tool::emit::EmitError;

/// Errors that prevent a retrofit.
#[derive(Debug, thiserror::Error)]
pub enum RetrofitError {
    /// No global procedure has this name.
    #[error(
        "no global procedure '{entry}' in the files given; name the routine that starts the \
         program with --entry"
    )]
    NoEntry {
        /// The name.
        entry: String,
    },
    /// Several global procedures have this name.
    #[error(
        "the entry routine '{entry}' is declared more than once, in {first} and in {second}: name \
         the files of one program only, or another routine with --entry"
    )]
    TwoEntries {
        /// The name.
        entry: String,
        /// File and line of the first.
        first: String,
        /// File and line of the second.
        second: String,
    },
    /// The program calls streams whose module is missing.
    #[error(
        "{path}:{line} calls {function} of a module of streams that was not given: the program is \
         optimised already; give '{module}' too (name the folder), or start from the original"
    )]
    NoStreams {
        /// File.
        path: String,
        /// From 1.
        line: u32,
        /// The called function.
        function: String,
        /// The file of the streams.
        module: String,
    },
    /// The file is empty.
    #[error("'{path}' is empty: it has no procedure '{entry}' to start the program with")]
    Empty {
        /// The file.
        path: String,
        /// The name.
        entry: String,
    },
    /// The module with the entry has syntax errors.
    #[error(
        "{path}:{line}:{column}: {message}; the entry routine '{entry}' cannot be read: correct the \
         syntax errors of its module first (joulepath parse shows all)"
    )]
    BrokenEntry {
        /// File.
        path: String,
        /// From 1.
        line: u32,
        /// From 1.
        column: u32,
        /// Of the first error.
        message: String,
        /// The entry routine.
        entry: String,
    },
    /// The robot model is incomplete.
    #[error(transparent)]
    Robot(#[from] NotReady),
    /// The takt is below the minimum cycle time.
    #[error(
        "a takt of {takt:.3} s is too short: the cycle takes at least {least:.3} s with \
         this robot, of which {fixed:.3} s are waits and movements that stay; give --takt {least:.3} \
         or more"
    )]
    Takt {
        /// Requested, s.
        takt: f64,
        /// Minimum, s.
        least: f64,
        /// Part that cannot change, s.
        fixed: f64,
    },
    /// The time factor is below the minimum of every run.
    #[error(
        "a time factor of {factor} is too small: no run takes less than {least:.3} times \
         as long as before with this robot; give --time-factor {least:.3} or more"
    )]
    Factor {
        /// Requested.
        factor: f64,
        /// Smallest feasible factor of any run.
        least: f64,
    },
    /// The emission failed.
    #[error("{0}")]
    Emit(#[from] EmitError),
}
