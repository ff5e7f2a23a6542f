//! A line is kept where nothing asks for one.
//!
//! ## What it does
//! Finds long, fast `MoveL` that begin and end in the zones of other movements: the robot passes
//! both of their ends, so nothing happens there.
//!
//! ## Why it wastes energy
//! On a line the joints have to follow the TCP; in a joint movement each axis goes the shortest
//! way and the slowest one sets the time.
//!
//! ## How the saving is computed
//! The movement is laid on a time line as a line and as a joint movement.
//!
//! ## Example
//! ```text
//! MoveJ pOver, v1000, z50, tGrip;
//! MoveL pBeyond, v1000, z50, tGrip;
//! MoveJ pMachine, v1000, fine, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pOver, v1000, z50, tGrip;
//! MoveJ pBeyond, v1000, z50, tGrip;
//! MoveJ pMachine, v1000, fine, tGrip;
//! ```
//!
//! ## Safety
//! Unsafe: the way between the points is another one. Check that it is free. With a part there is no fix, and
//! the confidence is low.
//!
//! ## Assumptions
//! There is room between the two points; ways below 200 mm and speeds below 500 mm/s are left
//! alone, and so are lines before or behind another line.

use super::super::context::Context;
use super::super::edits::{as_joint, replace};
use super::super::flow::Through;
use super::super::rule::Finding;
use crate::rapid::builtins::MoveForm;

rule!("EW205", "line-in-free-air", Speed, Robot, Info, "line_in_free_air.rs");

/// Shortest way, m.
const MIN_WAY: f64 = 0.2;
/// Least speed, m/s.
const MIN_SPEED: f64 = 0.5;
/// Smallest zone that is passed in free air, m.
const MIN_ZONE: f64 = 0.005;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        let passes = |site: usize| {
            let site = &context.sites[site];
            let zone = site.facts.zone.filter(|zone| !zone.fine && zone.tcp >= MIN_ZONE);
            site.is_plain() && zone.is_some()
        };
        let is_joint = |site: &usize| !context.sites[*site].is_linear();
        let fast = site.facts.speed.is_some_and(|speed| speed.tcp >= MIN_SPEED);
        let before = context.before(index);
        if site.signature.form != MoveForm::Linear
            || !passes(index)
            || context.is_next_to_work(index)
            || context.is_in_process(index)
            || !fast
            || before.is_empty()
            || context.is_unknown_before(index)
            || !before.iter().all(|before| passes(*before) && is_joint(before))
            || context
                .next_moves(index, Through::NoEffect)
                .is_none_or(|next| !next.iter().all(is_joint))
            || context.corner(index).is_none_or(|corner| corner.before < MIN_WAY)
        {
            continue;
        }
        let Ok(Some(saving)) = context.evaluate(&[site.stmt.span], &as_joint) else { continue };
        let message = format!("{} keeps a line between two points that are only passed", site.name);
        let finding = Finding::new(&RULE, site.stmt.span, message)
            .with_saving(format!("MoveJ in place of {}", site.name), saving)
            .with_assumption("the way of a joint movement is free");
        // A part takes more room beside the line than the tool.
        findings.push(if context.carries_part(index) {
            finding.doubtful()
        } else {
            finding.with_unsafe_fix([replace(site.name_span, "MoveJ")])
        });
    }
}
