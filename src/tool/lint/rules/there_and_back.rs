//! The robot goes somewhere and comes straight back, having done nothing there.
//!
//! ## What it does
//! Finds three movements in a row, with nothing between them, of which the last goes where the
//! first went; the way is a joint movement or faster than 500 mm/s.
//!
//! ## Why it wastes energy
//! The way there and back is for nothing.
//!
//! ## How the saving is computed
//! The cycle is laid on a time line without the first two of the three movements; without the last two where
//! the first one is next to work.
//!
//! ## Example
//! ```text
//! MoveJ pWait, v1000, z50, tGrip;
//! MoveJ pOver, v1000, z50, tGrip;
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
//! Without a fix: being there may have been the purpose (to lift a part, to shake something off,
//! to be seen). Somebody has to say that the way was for nothing.
//!
//! ## Assumptions
//! Movements alone have no purpose, unless the procedure does nothing else, or hardly anything else.
//! Ways that are gone several times, and movements next to work or in a process, are left alone. The
//! confidence is low.

use super::super::context::Context;
use super::super::flow::Through;
use super::super::rule::Finding;
use super::move_to_same_place::same_goal;
use crate::rapid::builtins::MoveForm;

rule!("EW402", "there-and-back", Path, Text, Info, "there_and_back.rs");

/// Slower lines are taken for a process, m/s.
const MIN_SPEED: f64 = 0.5;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let found = |first| back_to(context, first);
    findings.extend((0..context.sites.len()).filter_map(found));
}

fn back_to(context: &Context<'_>, first: usize) -> Option<Finding> {
    let there = only_next(context, first)?;
    let back = only_next(context, there)?;
    if back == first || !same_goal(context, first, back) || same_goal(context, first, there) {
        return None;
    }
    let idle = |site: usize| {
        let site = &context.sites[site];
        let fast = site.facts.speed.is_some_and(|speed| speed.tcp >= MIN_SPEED);
        let arc = site.signature.form == MoveForm::Circular;
        site.is_plain() && fast && site.reachable && !arc
    };
    let again = only_next(context, back).is_some_and(|next| same_goal(context, there, next));
    let shaken = context.before(first).iter().any(|before| same_goal(context, *before, there));
    // A program that does nothing but move has its movements for a purpose.
    let process = context.has_process(&[first, there, back]);
    if !idle(there) || !idle(back) || again || shaken || !process {
        return None;
    }
    let same_form = context.sites[first].signature.form == context.sites[back].signature.form;
    let free = |site: usize| !context.is_next_to_work(site) && !context.is_in_process(site);
    let [a, b, c] = [first, there, back].map(|site| &context.sites[site]);
    let (needless, change) = if same_form && free(first) && free(there) {
        // The last movement goes the way of the first one.
        ([a, b], "leaving out this movement and the one before")
    } else if free(there) && free(back) {
        ([b, c], "leaving out this movement and the next one")
    } else {
        return None;
    };
    let spans = needless.map(|site| site.stmt.span);
    let saving = context.evaluate(&spans, &|_| Vec::new()).ok()?;
    if saving.is_some_and(|saving| saving.time_s < 0.0) {
        return None;
    }
    let message = format!("{} goes there and straight back, for nothing", b.name);
    let finding = Finding::new(&RULE, b.stmt.span, message)
        .with_related(a.stmt.span, "from here")
        .with_related(c.stmt.span, "back again")
        .with_saving(change, saving)
        .doubtful();
    Some(finding)
}

/// The only movement that follows a movement, if nothing stands between and no other leads to it.
pub(super) fn only_next(context: &Context<'_>, site: usize) -> Option<usize> {
    let next = context.next_moves(site, Through::NoEffect)?;
    let [next] = next.as_slice() else { return None };
    (context.before(*next) == [site] && !context.is_unknown_before(*next)).then_some(*next)
}
