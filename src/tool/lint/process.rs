//! Whether two cycles do the same work: the same waits and outputs in the same order.

use super::evaluate::POSITION_TOLERANCE;
use super::trace::{self, Action};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Event, What};
use crate::retime::path::joint_path::{Joints, are_close};

/// What has to be at its place in both cycles, besides the order of waits and outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kept {
    /// Nothing.
    Order,
    /// The robot at waits and at the end.
    Waits,
    /// Also at outputs for which it stands still.
    Outputs,
}

/// Whether a cycle does the work of another one without an additional problem.
pub fn same_process(before: &Simulation, after: &Simulation, kept: Kept) -> bool {
    let (a, b) = (places(&before.events, kept), places(&after.events, kept));
    let near = |(a, b): (&Joints, &Joints)| are_close(a, b, POSITION_TOLERANCE);
    actions(&before.events) == actions(&after.events)
        && a.len() == b.len()
        && a.iter().zip(&b).all(near)
        && problems(&after.events) <= problems(&before.events)
}

fn actions(events: &[Event]) -> Vec<String> {
    let trace = trace::of_events(events);
    let actions = trace.iter().filter_map(|done| match &done.what {
        Action::Output(output) => Some(format!("{} {}", output.signal, output.value)),
        Action::Wait(wait, basis) => {
            let length = wait.duration.unwrap_or_default();
            Some(format!("{} {:?} {basis:?} {length}", wait.instruction, wait.signal))
        }
        Action::Left(_) => Some("elsewhere".to_owned()),
        Action::Move(_) => None,
    });
    actions.collect()
}

fn places(events: &[Event], kept: Kept) -> Vec<Joints> {
    let mut stands = None;
    let mut all = Vec::new();
    for event in events {
        match &event.what {
            What::Run(run) => stands = Some(run.end),
            What::Wait(wait) if kept >= Kept::Waits => all.push(wait.q),
            What::Output(_, 0) if kept >= Kept::Outputs => all.extend(stands),
            What::Wait(_) | What::Output(..) | What::Left(_) => {}
        }
    }
    if kept >= Kept::Waits {
        all.extend(stands);
    }
    all
}

fn problems(events: &[Event]) -> usize {
    events.iter().filter_map(trace::run).filter(|run| run.problem.is_some()).count()
}
