//! The robot travels round in a loop and comes back to where it was, having done nothing.
//!
//! ## What it does
//! Finds chains of joint movements with nothing between them, of which the last goes where the
//! first went, over two to six other points.
//!
//! ## Why it wastes energy
//! The whole loop is for nothing.
//!
//! ## How the saving is computed
//! The cycle is laid on a time line with the last movement of the loop alone.
//!
//! ## Example
//! ```text
//! MoveJ pWait, v1000, z50, tGrip;
//! MoveJ pLeft, v1000, z50, tGrip;
//! MoveJ pRight, v1000, z50, tGrip;
//! MoveJ pWait, v1000, fine, tGrip;
//! WaitTime 1;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pWait, v1000, fine, tGrip;
//! WaitTime 1;
//! ```
//!
//! ## Safety
//! Without a fix: somebody has to say what the loop was for.
//!
//! ## Assumptions
//! Joint movements alone have no purpose, unless the procedure does nothing else, or hardly anything
//! else. Loops with a movement next to work, in a process, below 500 mm/s or of less than 150 mm (an
//! edge that is deburred) are left alone. The confidence is low.

use super::super::context::Context;
use super::super::rule::Finding;
use super::move_to_same_place::same_goal;
use super::there_and_back::only_next;
use crate::rapid::text::Span;

rule!("EW403", "detour", Path, Text, Info, "detour.rs");

/// Points of a loop.
const MAX_POINTS: usize = 6;
/// Slower movements are taken for a process, m/s: as in EW402.
const MIN_SPEED: f64 = 0.5;
/// Shorter ways may follow a contour, as where an edge is deburred, m: as in EW101.
const MIN_STEP: f64 = 0.15;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for first in 0..context.sites.len() {
        let mut chain = vec![first];
        while chain.len() <= MAX_POINTS + 1 {
            let Some(next) = only_next(context, chain[chain.len() - 1]) else { break };
            let site = &context.sites[next];
            if site.is_linear() || !site.is_plain() || chain.contains(&next) {
                break;
            }
            if same_goal(context, first, next) {
                // A program that does nothing but move has its movements for a purpose.
                let process = context.has_process(&[chain.as_slice(), &[next]].concat());
                if chain.len() > 2 && chain.len() + 1 < context.sites.len() && process {
                    findings.extend(needless_loop(context, &chain, next));
                }
                break;
            }
            chain.push(next);
        }
    }
}

fn needless_loop(context: &Context<'_>, chain: &[usize], last: usize) -> Option<Finding> {
    let spans: Vec<Span> = chain.iter().map(|site| context.sites[*site].stmt.span).collect();
    let saving = context.evaluate(&spans, &|_| Vec::new()).ok()?;
    // A way over unknown points cannot be judged.
    if chain.iter().any(|site| context.sites[*site].facts.goal.is_none()) {
        return None;
    }
    // Without the chain, the last movement goes the way of the first one.
    let form = |site: usize| context.sites[site].signature.form;
    let touches_work = |site: &usize| {
        let is_short = context.corner(*site).is_none_or(|it| it.room() < MIN_STEP);
        is_short || context.is_next_to_work(*site) || is_at_work(context, *site)
    };
    // The last movement of a program has no corner.
    let is_short = context.corner(last).is_some_and(|it| it.room() < MIN_STEP);
    if form(chain[0]) != form(last)
        || chain.iter().any(touches_work)
        || is_short
        || is_at_work(context, last)
    {
        return None;
    }
    let points = chain.len() - 1;
    let message = format!("a loop over {points} points leads back to where it began, for nothing");
    let change = format!("leaving out the {} movements before this one", chain.len());
    let finding = Finding::new(&RULE, context.sites[last].stmt.span, message)
        .with_related(spans[0], "it begins here")
        .with_saving(change, saving)
        .doubtful();
    Some(finding)
}

/// Whether a movement of a loop may do the work itself: it is slow, or a process runs.
fn is_at_work(context: &Context<'_>, site: usize) -> bool {
    let is_slow = context.sites[site].facts.speed.is_none_or(|it| it.tcp < MIN_SPEED);
    is_slow || context.is_in_process(site)
}
