//! The robot waits long in a pose that is costly to hold.
//!
//! ## What it does
//! Finds waits of stated length, 3 s and more, at poses that take at least a fifth more to hold than the
//! pose that the robot came from, or than a pose nearby (axes 2, 3 and 5 turned by at most 20°). The pose
//! before counts where nothing is done there nor at the wait, and a joint movement of 500 mm/s or more
//! without a part leads from one to the other.
//!
//! ## Why it wastes energy
//! Motors hold the arm against gravity with open brakes; the copper loss grows with the square
//! of the torque, for the whole wait.
//!
//! ## How the saving is computed
//! The wait is laid on a time line before the movement; or with a joint movement to the better pose and
//! back, with a wait between that is shorter by the time of both, so that the robot is ready when it was
//! before.
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
//! There is room for the way to a pose nearby; nothing needs the robot where it waits.

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::trace::{Action, executions};
use crate::arm::dynamics::Load;
use crate::arm::kinematics::limits_ok;
use crate::arm::robot::Model;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::{Movement, Speed, Stop, Target, Wait, Zone};
use crate::rapid::text::Span;
use crate::retime::energy::power::holding_w;
use crate::retime::motion::Step;
use crate::retime::motion::timeline::{WaitBasis, WaitRecord, What};
use crate::retime::path::joint_path::Joints;

rule!("EW301", "dwell-at-heavy-pose", Dwell, Robot, Info, "dwell_at_heavy_pose.rs");

/// Shortest wait, s.
const MIN_WAIT: f64 = 3.0;
/// Least share of the holding power that another pose spares.
const MIN_SHARE: f64 = 0.2;
/// Slower movements are taken for work, m/s.
const MIN_SPEED: f64 = 0.5;
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
        let What::Wait(record) = &cycle.simulation.events[event].what else { continue };
        let is_once = |span: Span| executions[&span].len() == 1;
        if done.duration < MIN_WAIT || !is_once(wait.span) || !record.position_known {
            continue;
        }
        let power_w = holding_w(model, &record.load, &record.q).iter().sum();
        let dwell = Dwell { step, duration_s: done.duration, record, power_w };
        let found = where_it_was(context, &dwell, is_once);
        findings.extend(found.or_else(|| nearby(context, model, &dwell)));
    }
}

/// A wait at a known pose.
struct Dwell<'c> {
    step: usize,
    duration_s: f64,
    record: &'c WaitRecord,
    /// Holding power, W.
    power_w: f64,
}

/// A finding where the robot could wait before the movement that led here: a way through free air from a
/// point at which it did nothing either, and to one from which it moves on.
fn where_it_was(
    context: &Context<'_>,
    dwell: &Dwell<'_>,
    is_once: impl Fn(Span) -> bool,
) -> Option<Finding> {
    let moves = |step: usize| context.trace.get(step)?.what.movement();
    let movement = moves(dwell.step.checked_sub(1)?)?;
    let site = context.site_of(movement.span)?;
    let (speed, wait) = (context.sites[site].facts.speed?, &dwell.record.wait);
    moves(dwell.step.checked_sub(2)?)?;
    moves(dwell.step + 1)?;
    if context.sites[site].is_linear()
        || speed.tcp < MIN_SPEED
        || context.is_in_process(site)
        || context.carries_part(site)
        || !is_once(movement.span)
    {
        return None;
    }
    let sooner = |step: &Step| match step {
        Step::Wait(_) => Vec::new(),
        other => vec![Step::Wait(Box::new(wait.clone())), other.clone()],
    };
    let saving = context.evaluate(&[movement.span, wait.span], &sooner).ok()??;
    if saving.energy_j < MIN_SHARE * dwell.power_w * dwell.duration_s {
        return None;
    }
    let message = format!(
        "the robot waits {:.1} s in a pose that takes {:.0} W to hold; the one before takes less",
        dwell.duration_s, dwell.power_w
    );
    let change = format!("waiting before {}, not behind it", context.sites[site].name);
    let finding = Finding::new(&RULE, wait.span, message)
        .with_saving(change, saving)
        .with_related(movement.span, "it leaves the better pose here")
        .with_assumption("nothing needs the robot there while it waits");
    Some(finding)
}

/// A finding where a pose nearby takes less, the way there and back included.
fn nearby(context: &Context<'_>, model: &Model, dwell: &Dwell<'_>) -> Option<Finding> {
    let Dwell { duration_s, record, power_w, .. } = *dwell;
    let span = record.wait.span;
    let (pose, there_w) = lightest(model, &record.load, &record.q);
    if there_w >= (1.0 - MIN_SHARE) * power_w {
        return None;
    }
    let before = context.trace[..dwell.step].iter().rev();
    let template = before.into_iter().find_map(|done| done.what.movement())?;
    let way = |shorter: f64| {
        move |step: &Step| match step {
            Step::Wait(wait) => {
                let duration = wait.duration.map(|t| (t - shorter).max(0.0));
                vec![
                    to(template, pose),
                    Step::Wait(Box::new(Wait { duration, ..(**wait).clone() })),
                    to(template, record.q),
                ]
            }
            other => vec![other.clone()],
        }
    };
    let way_s = -context.difference(&[span], &way(0.0))?.time_s;
    if way_s >= duration_s {
        return None;
    }
    let saving = context.evaluate(&[span], &way(way_s)).ok()??;
    let message = format!(
        "the robot waits {duration_s:.1} s in a pose that takes {power_w:.0} W to hold; one nearby \
         takes {there_w:.0} W"
    );
    let change = format!(
        "MoveAbsJ {},v1000,fine before the wait, {way_s:.3} s less of it, and MoveAbsJ {},v1000,fine \
         behind it",
        jointtarget(&pose),
        jointtarget(&record.q)
    );
    let finding = Finding::new(&RULE, span, message)
        .with_saving(change, saving)
        .with_assumption("there is room for the way to the other pose");
    Some(finding)
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
