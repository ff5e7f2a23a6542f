//! The robot stops again and again only to set an output.
//!
//! ## What it does
//! Finds stop points behind which outputs are set and the robot moves on at once, without a wait,
//! where that happens at least twice in the program or in a cycle.
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
//! for gripping and left alone.

use super::super::context::Context;
use super::super::edits::zone_within;
use super::super::flow::{Next, Through};
use super::super::rule::Finding;
use super::super::stops::with_zone;
use crate::rapid::ir::hir::RoutineKind;

rule!("EW104", "stop-for-output", Stops, Text, Info, "stop_for_output.rs");

/// A larger change of direction is a way back, rad.
const BACK: f64 = 2.0;
/// Share of the room that a zone may take, and the most, m.
const PROPOSED: (f64, f64) = (0.3, 0.015);
/// How often it has to happen.
const REPEATED: usize = 2;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let stops: Vec<usize> =
        (0..context.sites.len()).filter(|index| stops_for_output(context, *index)).collect();
    let times: usize =
        stops.iter().map(|index| context.sites[*index].executions.len().max(1)).sum();
    if times < REPEATED {
        return;
    }
    for index in stops {
        let site = &context.sites[index];
        let (Some(corner), Some(argument)) = (context.corner(index), site.zone) else { continue };
        let room = (PROPOSED.0 * corner.room()).min(PROPOSED.1);
        let Some(zone) = zone_within(room).filter(|_| corner.turn <= BACK) else { continue };
        let weighed = context.weigh(&[site.stmt.span], &|step| with_zone(step, zone));
        let Ok(saving) = weighed.saving() else { continue };
        let message = format!(
            "{} stops only for the output behind it: MoveLDO, MoveJDO or TriggL set it in passing",
            site.name
        );
        let mut finding = Finding::new(&RULE, site.stmt.span, message);
        finding.change = format!("{} in place of {}", zone.name, context.text(argument.span));
        finding.saving = saving;
        finding.assumptions.push("the process takes the signal while the robot moves".to_owned());
        findings.push(finding);
    }
}

fn stops_for_output(context: &Context<'_>, index: usize) -> bool {
    let site = &context.sites[index];
    let trap = matches!(context.program.routine(site.place.0).kind, RoutineKind::Trap);
    if !site.is_stop() || !site.is_plain() || !site.reachable || trap {
        return false;
    }
    let next = context.next(index, Through::Quiet);
    let outputs = next.iter().all(|next| matches!(next, Next::Output(_)));
    outputs
        && !next.is_empty()
        && context.next_moves(index, Through::Outputs).is_some_and(|next| {
            next.iter().all(|next| {
                let next = &context.sites[*next];
                next.is_plain() && next.tool_key() == site.tool_key()
            })
        })
}
