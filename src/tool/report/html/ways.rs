//! The variants in which a segment runs as a stream.

use crate::retime::motion::Simulation;
use crate::retime::motion::stream::Stream;
use crate::retime::motion::timed::TimedMotion;
use crate::retime::motion::timeline::{Run, What};
use crate::tool::retrofit::{Retrofit, Segment};

/// Executions of a segment with the same stream.
pub(super) struct Way<'a> {
    /// Their first run in the original program.
    pub(super) before: &'a Run,
    /// Their first run in the retrofit.
    pub(super) after: &'a Run,
    /// Event of the first run.
    pub(super) event: usize,
    /// Their number.
    pub(super) executions: usize,
    stream: &'a Stream,
}

/// The distinct streams of a segment, in order of their first execution.
pub(super) fn ways<'a>(retrofit: &'a Retrofit, segment: &Segment) -> Vec<Way<'a>> {
    let mut ways: Vec<Way<'a>> = Vec::new();
    for event in &segment.events {
        let (Some(before), Some(after)) =
            (run(&retrofit.before.0, *event), run(&retrofit.after.0, *event))
        else {
            continue;
        };
        let [(_, TimedMotion::Stream(stream))] = after.motions.as_slice() else { continue };
        if matches!(before.motions.as_slice(), [(_, TimedMotion::Stream(_))]) {
            continue;
        }
        let same = |way: &&mut Way<'_>| {
            way.stream == stream
                && way.after.load == after.load
                && way.before.duration() == before.duration()
        };
        match ways.iter_mut().find(same) {
            Some(way) => way.executions += 1,
            None => ways.push(Way { before, after, event: *event, executions: 1, stream }),
        }
    }
    ways
}

fn run(simulation: &Simulation, event: usize) -> Option<&Run> {
    match &simulation.events.get(event)?.what {
        What::Run(run) => Some(run),
        _ => None,
    }
}
