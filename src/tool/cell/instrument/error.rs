//! Why a program gets no recorder.

use crate::tool::retrofit::RetrofitError;

/// Signals whose changes are recorded at most: an interrupt each, of the 100 that a controller has.
pub(super) const MOST_SIGNALS: usize = 40;

/// Why a program gets no recorder.
#[derive(Debug, thiserror::Error)]
pub enum InstrumentError {
    /// The program cannot be read.
    #[error(transparent)]
    Read(#[from] RetrofitError),
    /// It has one.
    #[error(
        "'{0}' is a recorder already: take it out first, with joulepath instrument PROGRAM --remove --out DIR"
    )]
    Recorder(String),
    /// Nothing to record.
    #[error("the program has no movements and no waits that could be recorded")]
    Nothing,
    /// A signal that the program does not name.
    #[error("--signals {name}: the program names no signal '{name}'; {way_out}")]
    UnknownSignal {
        /// Its name.
        name: String,
        /// What to do.
        way_out: String,
    },
    /// A signal without two levels.
    #[error("--signals {0}: only digital signals are recorded; leave it out")]
    NotDigital(String),
    /// Too many signals.
    #[error("{0} signals are too many: name at most {MOST_SIGNALS} with --signals")]
    TooManySignals(usize),
    /// No wait there.
    #[error("--late {place}: {reason}")]
    Late {
        /// File and line.
        place: String,
        /// What is wrong, and the way out.
        reason: &'static str,
    },
    /// The program with the recorder does something else.
    #[error(
        "the program with the recorder would not do the same: {0}; nothing is written, please report this"
    )]
    Differs(String),
    /// A template failed.
    #[error("the template of the recorder failed: {0}")]
    Template(String),
}
