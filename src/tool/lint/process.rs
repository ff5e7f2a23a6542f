//! Whether two cycles do the same work: the same waits and outputs in the same order.

use super::evaluate::POSITION_TOLERANCE;
use super::trace::{self, Action};
use crate::arm::kinematics::fk;
use crate::arm::robot::Model;
use crate::rapid::ir::movement::Target;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Event, What};
use crate::retime::path::joint_path::{Joints, are_close};

/// Largest difference of two equal tool positions, m, and directions, rad.
const TOOL_TOLERANCE: f64 = 1e-5;

/// What two cycles of the same work have in common: each level has all that those above have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kept {
    /// The targets, and the waits and outputs at each of them, in any order.
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
    let is_same = match kept {
        Kept::Work => work(&before.events) == work(&after.events),
        _ => actions(&before.events) == actions(&after.events),
    };
    is_same
        && a.len() == b.len()
        && a.iter().zip(&b).all(near)
        && problems(&after.events) <= problems(&before.events)
}

/// Whether two simulations have the same targets, waits and outputs in the same order; a target that
/// follows itself counts once.
pub fn same_order(before: &Simulation, after: &Simulation) -> bool {
    ordered(&before.events) == ordered(&after.events)
}

/// What a simulation does, in order.
fn ordered(events: &[Event]) -> Vec<Done> {
    let done = trace::of_events(events);
    let mut all: Vec<Done> = done
        .iter()
        .filter_map(|it| {
            Some(match &it.what {
                // The configuration is the robot's way, not the place of the tool.
                Action::Move(movement) => Done::Moved(match &movement.target {
                    Target::Joints(joints) => format!("{joints:?}"),
                    Target::Pose(target) => format!("{:?} {:?}", target.pose, movement.wobj),
                }),
                what => Done::Acted(action(what)?),
            })
        })
        .collect();
    all.dedup_by(|a, b| a == b && matches!(a, Done::Moved(_)));
    all
}

#[derive(PartialEq)]
enum Done {
    /// It moved to a target.
    Moved(String),
    /// It waited or set an output.
    Acted(String),
}

fn is_same_place(model: &Model, a: &Joints, b: &Joints) -> bool {
    let [a, b] = [a, b].map(|q| fk(model, q));
    (a.translation.vector - b.translation.vector).norm() < TOOL_TOLERANCE
        && a.rotation.angle_to(&b.rotation) < TOOL_TOLERANCE
}

fn actions(events: &[Event]) -> Vec<String> {
    trace::of_events(events).iter().filter_map(|done| action(&done.what)).collect()
}

/// A wait or an output as text.
fn action(what: &Action<'_>) -> Option<String> {
    match what {
        Action::Output(output) => Some(format!("{} {}", output.signal, output.value)),
        Action::Wait(wait, basis) => {
            let length = wait.duration.unwrap_or_default();
            Some(format!("{} {:?} {basis:?} {length}", wait.instruction, wait.signal))
        }
        Action::Left(_) => Some("elsewhere".to_owned()),
        Action::Move(_) => None,
    }
}

/// The targets, and the waits and outputs with the target before them, sorted.
fn work(events: &[Event]) -> Vec<String> {
    let mut target = String::new();
    let mut all = Vec::new();
    for done in trace::of_events(events) {
        if let Action::Move(movement) = &done.what {
            target = format!("{:?}", movement.target);
            all.push(target.clone());
        }
        all.extend(action(&done.what).map(|action| format!("{action} at {target}")));
    }
    all.sort_unstable();
    all
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
