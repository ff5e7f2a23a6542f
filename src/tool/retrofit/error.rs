//! Why a program can't be retrofitted at all.

use crate::arm::robot::NotReady;
use crate::tool::emit::EmitError;

/// Why a program can't be retrofitted at all.
#[derive(Debug, thiserror::Error)]
pub enum RetrofitError {
    /// No routine of that name.
    #[error(
        "no global procedure '{entry}' in the files given; name the routine that starts the \
         program with --entry"
    )]
    NoEntry {
        /// The name.
        entry: String,
    },
    /// More than one routine of that name.
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
    /// The program calls streams that are not there.
    #[error(
        "{path}:{line} calls {function} of a module of streams that was not given: the program is \
         optimised already; give '{module}' too (name the folder), or start from the original"
    )]
    NoStreams {
        /// File.
        path: String,
        /// From 1.
        line: u32,
        /// What is called.
        function: String,
        /// The file of the streams.
        module: String,
    },
    /// Nothing to read.
    #[error("'{path}' is empty: it has no procedure '{entry}' to start the program with")]
    Empty {
        /// The file.
        path: String,
        /// The name.
        entry: String,
    },
    /// The module with the entry has syntax errors.
    #[error(
        "{path}:{line}:{column}: {message}; the module holds the entry routine '{entry}', so it \
         has to be mended first (joulepath parse shows all errors)"
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
    /// The robot lacks something.
    #[error(transparent)]
    Robot(#[from] NotReady),
    /// A takt below the possible.
    #[error(
        "a takt of {takt:.3} s is below the possible: the cycle takes at least {least:.3} s with \
         this robot, of which {fixed:.3} s are waits and movements that stay; give --takt {least:.3} \
         or more"
    )]
    Takt {
        /// Asked for, s.
        takt: f64,
        /// Possible, s.
        least: f64,
        /// Not to be changed, s.
        fixed: f64,
    },
    /// A factor below the possible for every run.
    #[error(
        "a time factor of {factor} is below the possible: no run takes less than {least:.3} times \
         as long as before with this robot; give --time-factor {least:.3} or more"
    )]
    Factor {
        /// Asked for.
        factor: f64,
        /// Possible for some run.
        least: f64,
    },
    /// The emission failed.
    #[error("{0}")]
    Emit(#[from] EmitError),
}
