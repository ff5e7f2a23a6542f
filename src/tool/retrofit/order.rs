//! Compares the order of events before and after.

use super::simulated::ENDPOINT_TOLERANCE;
use crate::retime::motion::Simulation;
use crate::retime::motion::timed::TimedMotion;
use crate::retime::motion::timeline::{Event, Run, What};
use crate::retime::path::joint_path::are_close;

/// Whether both have the same sequence of events.
pub(super) fn same_order(a: &Simulation, b: &Simulation) -> bool {
    a.events.len() == b.events.len()
        && a.events.iter().zip(&b.events).all(|(a, b)| same_event(a, b))
}

/// Whether the kind of event and its output, wait or ends are equal. A stream may replace any
/// movements; other movements keep their instructions.
pub(super) fn same_event(a: &Event, b: &Event) -> bool {
    match (&a.what, &b.what) {
        (What::Run(a), What::Run(b)) => same_ends(a, b) && (is_stream(b) || same_moves(a, b)),
        (What::Wait(a), What::Wait(b)) => {
            a.wait.instruction == b.wait.instruction && a.wait.signal == b.wait.signal
        }
        (What::Output(a, _), What::Output(b, _)) => a.signal == b.signal && a.value == b.value,
        (What::Left(a), What::Left(b)) => a.reason == b.reason,
        _ => false,
    }
}

fn same_ends(a: &Run, b: &Run) -> bool {
    are_close(&a.start, &b.start, ENDPOINT_TOLERANCE)
        && are_close(&a.end, &b.end, ENDPOINT_TOLERANCE)
}

fn is_stream(run: &Run) -> bool {
    matches!(run.motions.as_slice(), [(_, TimedMotion::Stream(_))])
}

fn same_moves(a: &Run, b: &Run) -> bool {
    a.moves.len() == b.moves.len()
        && (a.moves.iter().zip(&b.moves))
            .all(|(a, b)| a.movement.instruction == b.movement.instruction)
}
