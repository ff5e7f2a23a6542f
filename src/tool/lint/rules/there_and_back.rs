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
//! The cycle is laid on a time line without the first two of the three movements.
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
//! Ways that are gone several times are left alone.

use super::super::context::Context;
use super::super::flow::Through;
use super::super::rule::Finding;
use super::move_to_same_place::same_goal;
use crate::rapid::builtins::MoveForm;

rule!("EW402", "there-and-back", Path, Text, Info, "there_and_back.rs");

/// Slower lines are taken for a process, m/s.
const FAST: f64 = 0.5;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for first in 0..context.sites.len() {
        let Some(there) = only_next(context, first) else { continue };
        let Some(back) = only_next(context, there) else { continue };
        if back == first || !same_goal(context, first, back) || same_goal(context, first, there) {
            continue;
        }
        let idle = |site: usize| {
            let site = &context.sites[site];
            let fast = site.facts.speed.is_some_and(|speed| speed.tcp >= FAST);
            let arc = site.signature.form == MoveForm::Circular;
            site.is_plain() && fast && site.reachable && !arc
        };
        let again = only_next(context, back).is_some_and(|next| same_goal(context, there, next));
        let before = context.before(first);
        let shaken = before.iter().any(|before| same_goal(context, *before, there));
        // A program that does nothing but move has its movements for a purpose.
        let works = context.works(&[first, there, back]);
        if !idle(there) || !idle(back) || again || shaken || !works {
            continue;
        }
        let [a, b, c] = [first, there, back].map(|site| &context.sites[site]);
        let spans = [a.stmt.span, b.stmt.span];
        let Ok(saving) = context.weigh(&spans, &|_| Vec::new()).saving() else { continue };
        if saving.is_some_and(|saving| saving.time_s < 0.0) {
            continue;
        }
        let message = format!("{} goes there and straight back, for nothing", b.name);
        let mut finding = Finding::new(&RULE, b.stmt.span, message);
        finding.related.push((a.stmt.span, "from here".to_owned()));
        finding.related.push((c.stmt.span, "back again".to_owned()));
        "leaving out this movement and the one before".clone_into(&mut finding.change);
        finding.saving = saving;
        findings.push(finding);
    }
}

/// The only movement that follows a movement, if nothing stands between and no other leads to it.
pub(super) fn only_next(context: &Context<'_>, site: usize) -> Option<usize> {
    let next = context.next_moves(site, Through::Quiet)?;
    let [next] = next.as_slice() else { return None };
    (context.before(*next) == [site] && !context.may_start(*next)).then_some(*next)
}
