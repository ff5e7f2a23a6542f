//! The alternative to streams: only the programmed speeds of movements change.
//!
//! The robot stands still between runs, so one simulation tries a speed for all runs at once. This
//! gives the energy of each run over time. The cycle time is distributed as for streams, then the
//! speeds for these times are searched. Programmed speeds of lines and arcs are upper limits; zones
//! and targets stay. A speed datum is written as a product with that datum, so its later changes
//! still act.

use std::collections::BTreeSet;

use super::candidate::{State, candidates, pending, with_states};
use super::figures::Verification;
use super::files::unchanged;
use super::job::Job;
use super::lower_limits;
use super::outputs::Outputs;
use super::rewritten::Rewritten;
use super::settings::{Budget, Objective};
use super::simulated::Simulated;
use super::speed_search::search;
use super::speed_slots::slots;
use super::uncertainty::{ENOUGH, share_that_saves};
use super::verify::{Attempt, Rewrite, verify};
use crate::retime::optimize::reason::Reason;

/// Minimum relative saving of all energy; repeating the grid search changes its result by about
/// this.
const WORTHWHILE: f64 = 1e-3;

/// Changes the speeds of a program; it stays unchanged if no other speeds are better.
pub(super) fn rewritten(job: &Job<'_>, progress: &dyn Fn(usize, usize)) -> Rewritten {
    let Job { original, model, settings, .. } = job;
    let (slots, candidates) = slots(original, settings, candidates(&original.sites));
    let mut reason = Reason::NoSaving;
    let mut kept = None;
    if let Some((factors, outputs)) = search(job, &slots, progress) {
        let rewrite = Rewrite::Speeds { slots: &slots, factors: &factors };
        let attempt = verify(original, &outputs, model, settings, rewrite);
        match reason_to_stay(job, &attempt) {
            None => {
                let pairs = slots.iter().zip(&factors);
                let changed = pairs.filter(|(slot, factor)| slot.is_changed(**factor));
                let spans: BTreeSet<_> =
                    changed.map(|(slot, _)| original.sites[slot.site].span).collect();
                kept = Some((outputs, attempt.simulated, attempt.verification, spans));
            }
            Some(found) => reason = found,
        }
    }
    let refused = pending(&candidates).map(|(index, candidate)| {
        let is_tried = slots.iter().any(|slot| slot.site == candidate.site);
        let reason = if is_tried { reason.clone() } else { Reason::NoSaving };
        (index, State::Refused(reason))
    });
    let refused: Vec<_> = refused.collect();
    let (files, simulated, verification, respeeded) = kept.unwrap_or_else(|| {
        let simulated = Simulated::new(original.program, original.entry, model, &settings.options);
        (unchanged(original.files), simulated, Verification::none(), BTreeSet::new())
    });
    let lowered = lower_limits::emitted_under(&original.lowered, &files, settings);
    Rewritten {
        candidates: with_states(candidates, refused),
        waits: Vec::new(),
        outputs: Outputs { files, guards: Vec::new() },
        simulated,
        verification,
        lower_limits: lower_limits::cycles(&original.lowered, &lowered),
        respeeded,
    }
}

/// Why all other speeds are rejected, if they are.
fn reason_to_stay(job: &Job<'_>, attempt: &Attempt) -> Option<Reason> {
    let Job { original, model, settings, robots, .. } = job;
    if let Some(why) = attempt.verification.broken() {
        return Some(Reason::Verification(format!("did not hold: {why}")));
    }
    if settings.objective == Objective::Time || settings.budget != Budget::AsBefore {
        return None;
    }
    let [before_j, after_j] =
        [&original.cycle, &attempt.simulated].map(|cycle| cycle.account.total.energy_j());
    if after_j + WORTHWHILE * before_j >= before_j {
        return Some(Reason::NoSaving);
    }
    let share = share_that_saves(model, robots.as_ref()?, &original.cycle, &attempt.simulated);
    (share < ENOUGH).then_some(Reason::UncertainSaving(share))
}
