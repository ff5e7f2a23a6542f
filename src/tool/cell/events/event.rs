//! One row of a log of events.

use std::fmt;

/// A statement of the program without the recorder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place {
    /// Path of the file, as the recorder has it.
    pub file: String,
    /// Line, from 1.
    pub line: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.file, self.line)
    }
}

/// What an event tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum What {
    /// A cycle starts.
    Cycle,
    /// A movement starts from standstill.
    Start,
    /// A movement has ended at its stop point.
    Arrive,
    /// The program comes to a wait.
    Wait,
    /// The wait has ended.
    End {
        /// Whether its time limit ended it.
        by_limit: bool,
    },
    /// A signal has changed to this level.
    Signal(f64),
    /// The program has set an output to this level.
    Output(f64),
    /// The load has changed; its mass, kg.
    Load(f64),
    /// A movement with another tool starts; the tool's mass, kg.
    Tool(f64),
    /// The recorder has written to the disk; how long this took, s.
    Flush(f64),
    /// Events that were lost because the memory was full.
    Lost(f64),
}

/// An event.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Time since the start of the session, s.
    pub t: f64,
    /// Number of the cycle, from 1.
    pub cycle: u64,
    /// Number of movements that the cycle has executed so far.
    pub cmd: u64,
    /// The statement, if there is one.
    pub place: Option<Place>,
    /// What happened.
    pub what: What,
    /// The signal, if there is one.
    pub signal: Option<String>,
}

impl What {
    /// From the columns `event` and `value`; `Err` holds what is wrong.
    pub(super) fn parse(event: &str, value: Option<f64>) -> Result<What, String> {
        let with = |what: fn(f64) -> What| {
            value.map(what).ok_or_else(|| format!("the event '{event}' has no value"))
        };
        match event {
            "cycle" => Ok(What::Cycle),
            "start" => Ok(What::Start),
            "arrive" => Ok(What::Arrive),
            "wait" => Ok(What::Wait),
            "end" => Ok(What::End { by_limit: value.is_some_and(|value| value != 0.0) }),
            "signal" => with(What::Signal),
            "output" => with(What::Output),
            "load" => with(What::Load),
            "tool" => with(What::Tool),
            "flush" => with(What::Flush),
            "lost" => with(What::Lost),
            _ => Err(format!("the event '{event}' is not known")),
        }
    }

    /// Whether it belongs to a statement.
    pub(super) fn needs_place(self) -> bool {
        matches!(self, What::Start | What::Arrive | What::Wait | What::End { .. })
    }
}
