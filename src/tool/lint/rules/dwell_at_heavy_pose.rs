//! The robot waits long in a pose that is costly to hold.
//!
//! ## What it does
//! Finds waits of stated length, 3 s and more, at poses whose holding power is at least a fifth
//! above that of a pose nearby (axes 2, 3 and 5 turned by at most 20°).
//!
//! ## Why it wastes energy
//! Motors hold the arm against gravity with open brakes; the copper loss grows with the square
//! of the torque, for the whole wait.
//!
//! ## How the saving is computed
//! The wait is laid on a time line with a joint movement to the better pose and back; the wait
//! between is shorter by the time of both, so that the robot is ready when it was before.
//!
//! ## Example
//! ```text
//! MoveAbsJ jStretched, v1000, fine, tGrip;
//! WaitTime 20;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveAbsJ jStretched, v1000, fine, tGrip;
//! MoveAbsJ jUpright, v1000, fine, tGrip;
//! WaitTime 19.2;
//! MoveAbsJ jStretched, v1000, fine, tGrip;
//! ```
//!
//! ## Safety
//! Without a fix: the cell has to have room. `optimize --dwell-pose` does it behind a guard.
//!
//! ## Assumptions
//! There is room for the way to the other pose.

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::trace::{Action, executions};
use crate::arm::dynamics::Load;
use crate::arm::kinematics::limits_ok;
use crate::arm::robot::Model;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::{Movement, Speed, Stop, Target, Wait, Zone};
use crate::retime::energy::power::holding_w;
use crate::retime::motion::Step;
use crate::retime::motion::timeline::{WaitBasis, What};
use crate::retime::path::joint_path::Joints;

rule!("EW301", "dwell-at-heavy-pose", Dwell, Robot, Info, "dwell_at_heavy_pose.rs");

/// Shortest wait, s.
const MIN_WAIT: f64 = 3.0;
/// Least share of the holding power that another pose spares.
const MIN_SHARE: f64 = 0.2;
/// Axes that are turned (2, 3, 5), and how far, rad.
const AXES: [usize; 3] = [1, 2, 4];
const TURNS: [f64; 5] = [-0.35, -0.175, 0.0, 0.175, 0.35];
/// Speed of the way there and back, m/s.
const SPEED: Speed = Speed { tcp: 1.0, orientation: 8.727 };

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let (Some(model), Some(cycle)) = (context.model, context.cycle) else { return };
    if !model.has_dynamics() {
        return;
    }
    let executions = executions(&context.trace);
    for (step, done) in context.trace.iter().enumerate() {
        let (Action::Wait(wait, WaitBasis::Stated), Some((event, _))) = (&done.what, done.event)
        else {
            continue;
        };
        let times = executions[&wait.span].len();
        let What::Wait(record) = &cycle.simulation.events[event].what else { continue };
        if done.duration < MIN_WAIT || times != 1 || !record.position_known {
            continue;
        }
        let here: f64 = holding_w(model, &record.load, &record.q).iter().sum();
        let (pose, there) = lightest(model, &record.load, &record.q);
        let before = context.trace[..step].iter().rev().find_map(|done| done.what.movement());
        let Some(template) = before.filter(|_| there < (1.0 - MIN_SHARE) * here) else { continue };
        let way = |shorter: f64| {
            let q = record.q;
            move |step: &Step| match step {
                Step::Wait(wait) => {
                    let duration = wait.duration.map(|t| (t - shorter).max(0.0));
                    vec![
                        to(template, pose),
                        Step::Wait(Box::new(Wait { duration, ..(**wait).clone() })),
                        to(template, q),
                    ]
                }
                other => vec![other.clone()],
            }
        };
        let Some(way_s) = context.difference(&[wait.span], &way(0.0)).map(|it| -it.time_s) else {
            continue;
        };
        if way_s >= done.duration {
            continue;
        }
        let Ok(Some(saving)) = context.evaluate(&[wait.span], &way(way_s)) else { continue };
        let message = format!(
            "the robot waits {:.1} s in a pose that takes {here:.0} W to hold; one nearby takes \
             {there:.0} W",
            done.duration
        );
        let change = format!(
            "MoveAbsJ {},v1000,fine before the wait, {:.3} s less of it, and MoveAbsJ {},v1000,fine \
             behind it",
            jointtarget(&pose),
            way_s,
            jointtarget(&record.q)
        );
        let finding = Finding::new(&RULE, wait.span, message)
            .with_saving(change, saving)
            .with_assumption("there is room for the way to the other pose");
        findings.push(finding);
    }
}

/// The pose nearby that takes least to hold, and its power, W.
fn lightest(model: &Model, load: &Load, q: &Joints) -> (Joints, f64) {
    let mut best = (*q, f64::INFINITY);
    for a in TURNS {
        for b in TURNS {
            for c in TURNS {
                let mut pose = *q;
                for (axis, turn) in AXES.into_iter().zip([a, b, c]) {
                    pose[axis] += turn;
                }
                let power: f64 = holding_w(model, load, &pose).iter().sum();
                if power < best.1 - 1e-9 && limits_ok(model, &pose).is_ok() {
                    best = (pose, power);
                }
            }
        }
    }
    best
}

/// A joint movement like another movement, to a stop.
fn to(template: &Movement, q: Joints) -> Step {
    Step::Move(Box::new(Movement {
        instruction: "MoveAbsJ".into(),
        form: MoveForm::AbsJ,
        via: None,
        target: Target::Joints(q),
        speed: SPEED,
        time: None,
        zone: Zone { fine: true, tcp: 0.0, orientation: 0.0, angle: 0.0 },
        stop: Stop::Fine,
        ..template.clone()
    }))
}

/// Joints as they are written in a program.
fn jointtarget(q: &Joints) -> String {
    let degrees = q.map(|q| format!("{:.3}", q.to_degrees()));
    format!("[[{}],[9E9,9E9,9E9,9E9,9E9,9E9]]", degrees.join(","))
}
