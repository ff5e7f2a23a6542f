//! Time and energy of each segment before and after.

use std::collections::BTreeMap;

use super::candidate::{Candidate, State};
use super::figures::{Segment, SegmentKind};
use super::job::Original;
use super::relocated_waits::RelocatedWait;
use super::simulated::Simulated;
use crate::rapid::text::Span;
use crate::retime::energy::EnergyParts;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::What;
use crate::retime::optimize::idle::Dwell;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::retime::PathUse;
use crate::retime::optimize::site::{Piece, not_reached};

/// Shorter dwells are not listed, s: gripper times.
const SHORTEST_DWELL: f64 = 0.1;

/// The segments in source order. `dwells`: of the original.
pub(super) fn segments(
    original: &Original<'_>,
    after: &Simulated,
    candidates: &[Candidate],
    dwells: &[Dwell],
    waits: &[RelocatedWait],
) -> Vec<Segment> {
    let before = &original.cycle;
    let mut segments = Vec::new();
    for (index, site) in original.sites.iter().enumerate() {
        let mut segment = Segment::new(site.span, SegmentKind::Timing, None);
        segment.pieces = site.pieces.iter().map(Piece::span).collect();
        let mut bound = 0.0;
        for candidate in candidates.iter().filter(|candidate| candidate.site == index) {
            let events = original.events(candidate);
            segment.executions += events.len();
            if segment.pareto.is_empty() {
                segment.pareto.clone_from(&candidate.pareto);
            }
            let (time, energy) = cost(before, events);
            segment.time_before_s += time;
            segment.energy_before_j += energy;
            let (time_after, energy_after) = cost(after, events);
            segment.time_after_s += time_after;
            segment.energy_after_j += energy_after;
            match &candidate.state {
                State::Done(retiming) => {
                    segment.rewritten = true;
                    match &retiming.path {
                        PathUse::Kept => {}
                        PathUse::KeptFor(reason) => {
                            segment.reason.get_or_insert(reason.clone());
                        }
                        PathUse::Left => segment.kind = SegmentKind::Path,
                    }
                    segment.rewritten_executions += events.len();
                    segment.points += retiming.stream.points().len();
                    bound += retiming.lower_bound_j * events.len() as f64;
                }
                State::Refused(reason) => {
                    bound += energy_after;
                    segment.reason.get_or_insert(reason.clone());
                }
                State::Pending => bound += energy_after,
            }
            segment.events.extend(events);
        }
        segment.lower_bound_j = segment.rewritten.then_some(bound).filter(|b| b.is_finite());
        segments.push(segment);
    }
    segments.extend(unresolved(&before.simulation));
    let not_reached = not_reached(original.program, &before.simulation);
    segments.extend(
        not_reached
            .iter()
            .map(|span| Segment::new(*span, SegmentKind::Timing, Some(Reason::NotReached))),
    );
    segments.extend(idle(before, after, dwells, waits));
    segments.sort_by_key(|segment| segment.span);
    segments
}

/// Time \[s\] and energy \[J\] of some events.
fn cost(cycle: &Simulated, events: &[usize]) -> (f64, f64) {
    let time: f64 = events.iter().map(|i| cycle.simulation.events[*i].duration).sum();
    let parts = events.iter().flat_map(|i| &cycle.account.events[*i]);
    (time, parts.fold(EnergyParts::default(), |sum, part| sum + *part).energy_j())
}

/// Movements that could not be resolved, by statement.
fn unresolved(simulation: &Simulation) -> Vec<Segment> {
    let mut by_place: BTreeMap<Span, Segment> = BTreeMap::new();
    for event in &simulation.events {
        if let What::Left(unresolved) = &event.what {
            let reason = Reason::Unresolved(unresolved.reason.clone());
            by_place
                .entry(unresolved.span)
                .or_insert_with(|| Segment::new(unresolved.span, SegmentKind::Timing, Some(reason)))
                .executions += 1;
        }
    }
    by_place.into_values().collect()
}

fn idle(
    before: &Simulated,
    after: &Simulated,
    dwells: &[Dwell],
    waits: &[RelocatedWait],
) -> Vec<Segment> {
    let mut by_place: BTreeMap<_, Segment> = BTreeMap::new();
    for dwell in dwells {
        if dwell.duration < SHORTEST_DWELL && !matches!(dwell.reason, Reason::UnknownDwell) {
            continue;
        }
        let [(time, energy), (time_after, energy_after)] =
            [before, after].map(|cycle| cost(cycle, &dwell.events));
        let segment = by_place.entry(dwell.span).or_insert_with(|| {
            Segment::new(dwell.span, SegmentKind::Idle, Some(dwell.reason.clone()))
        });
        segment.executions += 1;
        let wait = waits.iter().find(|wait| wait.events.iter().any(|e| dwell.events.contains(e)));
        if let Some(RelocatedWait { rest, .. }) = wait {
            segment.rewritten = true;
            segment.rewritten_executions += 1;
            segment.points = rest.out.points().len() + rest.back.points().len();
        }
        segment.time_before_s += time;
        segment.time_after_s += time_after;
        segment.energy_before_j += energy;
        segment.energy_after_j += energy_after;
        segment.potential_j += dwell.potential_j;
        segment.events.extend(&dwell.events);
    }
    by_place.into_values().collect()
}
