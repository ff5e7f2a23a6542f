//! The robot stops only to set an output.
//!
//! ## What it does
//! Finds stop points behind which outputs are set and the robot moves on at once, without a wait.
//!
//! ## Why it wastes energy
//! The arm is braked and accelerated anew for a signal that `MoveLDO`, `MoveJDO` or `TriggL` can
//! set while it passes.
//!
//! ## How the saving is computed
//! The movements before and after the point are laid on a time line with `fine` and with a zone.
//!
//! ## Example
//! ```text
//! MoveL p1, v800, fine, tGlue;
//! SetDO doValve, 1;
//! MoveL p2, v800, fine, tGlue;
//! SetDO doValve, 0;
//! MoveL p3, v800, fine, tGlue;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveLDO p1, v800, z10, tGlue, doValve, 1;
//! MoveLDO p2, v800, z10, tGlue, doValve, 0;
//! MoveL p3, v800, fine, tGlue;
//! ```
//!
//! ## Safety
//! Without a fix: whether the signal may come while the robot moves, only the process knows.
//!
//! ## Assumptions
//! The process does not need a robot that stands. Points at which the tool turns back are taken
//! for gripping and left alone, and so are movements below 200 mm/s, those before them, and `MoveAbsJ`: other
//! machines wait for a robot that stands at home. The confidence is low.

use super::super::context::Context;
use super::super::edits::zone_within;
use super::super::flow::{Next, Through};
use super::super::rule::Finding;
use super::super::stops::{are_plain, is_ordinary, propose_zone};
use crate::rapid::builtins::MoveForm;

rule!("EW104", "stop-for-output", Stops, Text, Info, "stop_for_output.rs");

/// A larger change of direction is a way back, rad.
const MAX_TURN: f64 = 2.0;
/// Share of the room that a zone may take.
const SHARE: f64 = 0.3;
/// Largest zone that is proposed, m.
const MAX_ZONE: f64 = 0.015;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let stops: Vec<usize> =
        (0..context.sites.len()).filter(|index| stops_for_output(context, *index)).collect();
    for index in stops {
        let Some(corner) = context.corner(index).filter(|it| it.turn <= MAX_TURN) else { continue };
        let Some(zone) = zone_within((SHARE * corner.room()).min(MAX_ZONE)) else { continue };
        let message = format!(
            "{} stops only for the output behind it: MoveLDO, MoveJDO or TriggL set it in passing",
            context.sites[index].name
        );
        let finding = propose_zone(context, &RULE, index, zone, message);
        let assumption = "the process takes the signal while the robot moves";
        findings.extend(finding.map(|finding| finding.with_assumption(assumption).doubtful()));
    }
}

fn stops_for_output(context: &Context<'_>, index: usize) -> bool {
    let site = &context.sites[index];
    let is_pose = site.signature.form == MoveForm::AbsJ;
    if !site.is_stop() || is_pose || !is_ordinary(context, site) || context.is_slow(index) {
        return false;
    }
    let next = context.next(index, Through::NoEffect);
    !next.is_empty()
        && next.iter().all(|next| matches!(next, Next::Output(_)))
        && context.next_moves(index, Through::Outputs).is_some_and(|next| {
            are_plain(context, site, &next) && !next.iter().any(|it| context.is_slow(*it))
        })
}
