//! Whether two cycles do the same work: the same waits and outputs in the same order.

use super::evaluate::POSITION_TOLERANCE;
use super::trace::{self, Action};
use crate::arm::kinematics::fk;
use crate::arm::robot::Model;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Event, What};
use crate::retime::path::joint_path::{Joints, are_close};

/// Largest difference of two equal tool positions, m, and directions, rad.
const TOOL_TOLERANCE: f64 = 1e-5;

/// What two cycles of the same work have in common: each level has all that those above have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kept {
    /// The waits and outputs, in any order.
    Work,
    /// Their order.
    Order,
    /// The flange's place at waits, at the end, and at outputs for which the robot stands still.
    Flange,
    /// The joints at waits and at the end.
    Waits,
    /// Also at outputs for which the robot stands still.
    Outputs,
}

/// Whether a cycle does the work of another one without an additional problem.
pub fn same_process(model: &Model, before: &Simulation, after: &Simulation, kept: Kept) -> bool {
    let (a, b) = (places(&before.events, kept), places(&after.events, kept));
    let near = |(a, b): (&Joints, &Joints)| match kept {
        Kept::Flange => is_same_place(model, a, b),
        _ => are_close(a, b, POSITION_TOLERANCE),
    };
    let mut done = [before, after].map(|of| actions(&of.events));
    if kept == Kept::Work {
        for actions in &mut done {
            actions.sort_unstable();
        }
    }
    done[0] == done[1]
        && a.len() == b.len()
        && a.iter().zip(&b).all(near)
        && problems(&after.events) <= problems(&before.events)
}

fn is_same_place(model: &Model, a: &Joints, b: &Joints) -> bool {
    let [a, b] = [a, b].map(|q| fk(model, q));
    (a.translation.vector - b.translation.vector).norm() < TOOL_TOLERANCE
        && a.rotation.angle_to(&b.rotation) < TOOL_TOLERANCE
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
            What::Wait(wait) if kept >= Kept::Flange => all.push(wait.q),
            What::Output(_, 0) if matches!(kept, Kept::Flange | Kept::Outputs) => {
                all.extend(stands);
            }
            What::Wait(_) | What::Output(..) | What::Left(_) => {}
        }
    }
    if kept >= Kept::Flange {
        all.extend(stands);
    }
    all
}

fn problems(events: &[Event]) -> usize {
    events.iter().filter_map(trace::run).filter(|run| run.problem.is_some()).count()
}
