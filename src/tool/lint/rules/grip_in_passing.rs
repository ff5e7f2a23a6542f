//! An output is set behind a movement that has a zone: the gripper acts before the robot stands.
//!
//! ## What it does
//! Finds lines and arcs with a zone behind which, on every way, an output is set and then a wait follows,
//! or behind which the tool goes back the way it came: a grip, which needs a robot that stands.
//!
//! ## Why it wastes energy
//! The controller sets the output when the tool reaches the zone, not when it is at the point. The
//! part is missed or shifted, and the cycle runs for nothing; and where a wait follows, the zone
//! becomes a stop with a warning in each cycle, and spares no time.
//!
//! ## How the saving is computed
//! None is told: the gain is a grip that does not fail.
//!
//! ## Example
//! ```text
//! MoveL pPick, v300, z10, tGrip;
//! Set doGripClose;
//! WaitTime 0.3;
//! MoveL pOver, v300, z10, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveL pPick, v300, fine, tGrip;
//! Set doGripClose;
//! WaitTime 0.3;
//! MoveL pOver, v300, z10, tGrip;
//! ```
//!
//! ## Safety
//! Without a fix: where the output only tells something, it may come in passing.
//!
//! ## Assumptions
//! Where the robot waits right behind an output, or goes back, it grips, lets go or works there.
//! Outputs that are set in passing, with a way that goes on, are none of this, and neither are joint
//! movements and outputs before a `WaitRob`.

use super::super::context::Context;
use super::super::flow::{Next, Place, Through};
use super::super::rule::Finding;
use super::super::statements::called_name;

rule!("EW105", "grip-in-passing", Stops, Text, Warning, "grip_in_passing.rs");

/// A larger change of direction is a way back, rad: as in EW101.
const MAX_TURN: f64 = 2.36;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        let passes = site.facts.zone.is_some_and(|zone| !zone.fine);
        if !passes || !site.is_plain() || !site.is_linear() || !site.reachable {
            continue;
        }
        let next = context.next(index, Through::NoEffect);
        let outputs = next.iter().map(|next| match next {
            Next::Output(place) => Some(*place),
            _ => None,
        });
        let Some(outputs) = outputs.collect::<Option<Vec<_>>>().filter(|it| !it.is_empty()) else {
            continue;
        };
        let waits = |place: &Place| {
            let behind = context.flow.following(*place, Through::Outputs);
            !behind.is_empty() && behind.iter().all(|next| is_process_wait(context, *next))
        };
        let goes_back = || context.corner(index).is_some_and(|corner| corner.turn > MAX_TURN);
        if outputs.iter().all(waits) || goes_back() {
            let written = site.zone.map(|zone| context.text(zone.span)).unwrap_or_default();
            let message = format!(
                "the output behind this {} comes when the tool enters {written}, before the robot \
                 stands: it needs fine",
                site.name
            );
            findings.push(Finding::new(&RULE, site.stmt.span, message));
        }
    }
}

/// Whether a next action waits for a process; `WaitRob` only makes the robot stand.
fn is_process_wait(context: &Context<'_>, next: Next) -> bool {
    let Next::Wait(place) = next else { return false };
    let name = context.flow.statement(place).and_then(called_name);
    name.is_none_or(|name| name.key != "waitrob")
}
