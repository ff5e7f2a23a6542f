//! Logs from which no waits can be told.

/// Why logs cannot be used together.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WaitsError {
    /// Two logs are of different programs.
    #[error(
        "{log} is of the program {hash}, {first} of the program {first_hash}: both must be the same \
         version; give the logs of one version, and start again when the program has changed"
    )]
    TwoPrograms {
        /// The first log.
        first: String,
        /// Its program.
        first_hash: String,
        /// The other log.
        log: String,
        /// Its program.
        hash: String,
    },
    /// A log is of another program than the one that is given.
    #[error(
        "{log} is of the program {hash}, --program is {given}: it has changed since the recording; give \
         the version that ran, or record again"
    )]
    OtherProgram {
        /// The log.
        log: String,
        /// Its program.
        hash: String,
        /// The program that is given.
        given: String,
    },
    /// One session is in two logs.
    #[error("{log} has the same session as {first}{started}: give each recording once")]
    SameSession {
        /// The first log.
        first: String,
        /// The other log.
        log: String,
        /// When it started, if the log says so.
        started: String,
    },
    /// No complete cycle.
    #[error(
        "no complete cycle in {logs}: a cycle counts when the next one has started and no event was lost; \
         record at least twenty"
    )]
    NoCycles {
        /// The logs.
        logs: String,
    },
}
