//! The costs of each piece before and after.

use std::collections::BTreeMap;

use super::figures::{Segment, SegmentKind};
use super::rests::Resting;
use super::work::Way;
use crate::rapid::text::Span;
use crate::retime::energy::{Account, EnergyParts};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::What;
use crate::retime::optimize::idle::Dwell;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::retime::PathUse;
use crate::retime::optimize::site::Site;

/// Dwells shorter than this are not listed, s: gripper times.
const SHORTEST_DWELL: f64 = 0.1;

/// The segments in the order of the source.
pub(super) fn segments(
    (before, before_account): (&Simulation, &Account),
    (after, after_account): (&Simulation, &Account),
    sites: &[Site],
    ways: &[Way],
    (dwells, restings): (&[Dwell], &[Resting]),
    not_reached: &[Span],
) -> Vec<Segment> {
    let cost = |simulation: &Simulation, account: &Account, events: &[usize]| {
        let time: f64 = events.iter().map(|i| simulation.events[*i].duration).sum();
        let energy = events
            .iter()
            .flat_map(|i| &account.events[*i])
            .fold(EnergyParts::default(), |sum, part| sum + *part);
        (time, energy.energy_j())
    };
    let mut segments = Vec::new();
    for (index, site) in sites.iter().enumerate() {
        let mut segment = Segment::new(site.span, SegmentKind::Timing, None);
        let mut bound = 0.0;
        for way in ways.iter().filter(|way| way.site == index) {
            let events = &site.variants[way.variant].events;
            segment.executions += events.len();
            if segment.pareto.is_empty() {
                segment.pareto.clone_from(&way.pareto);
            }
            let (time, energy) = cost(before, before_account, events);
            segment.time_before_s += time;
            segment.energy_before_j += energy;
            let (time, energy) = cost(after, after_account, events);
            segment.time_after_s += time;
            segment.energy_after_j += energy;
            match &way.outcome {
                Ok(retiming) => {
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
                Err(reason) => {
                    bound += energy;
                    segment.reason.get_or_insert(reason.clone());
                }
            }
            segment.events.extend(events);
        }
        segment.lower_bound_j = segment.rewritten.then_some(bound).filter(|b| b.is_finite());
        segments.push(segment);
    }
    segments.extend(left(before));
    segments.extend(
        not_reached
            .iter()
            .map(|span| Segment::new(*span, SegmentKind::Timing, Some(Reason::NotReached))),
    );
    segments.extend(idle(before, before_account, after_account, dwells, restings));
    segments.sort_by_key(|segment| segment.span);
    segments
}

/// Movements that could not be worked out, by statement.
fn left(simulation: &Simulation) -> Vec<Segment> {
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

/// Dwells by place.
fn idle(
    simulation: &Simulation,
    before: &Account,
    after: &Account,
    dwells: &[Dwell],
    restings: &[Resting],
) -> Vec<Segment> {
    let mut by_place: BTreeMap<_, Segment> = BTreeMap::new();
    for dwell in dwells {
        if dwell.duration < SHORTEST_DWELL && !matches!(dwell.reason, Reason::UnknownDwell) {
            continue;
        }
        let energy = |account: &Account| -> f64 {
            dwell.events.iter().flat_map(|i| &account.events[*i]).map(EnergyParts::energy_j).sum()
        };
        let time: f64 = dwell.events.iter().map(|i| simulation.events[*i].duration).sum();
        let segment = by_place.entry(dwell.span).or_insert_with(|| {
            Segment::new(dwell.span, SegmentKind::Idle, Some(dwell.reason.clone()))
        });
        segment.executions += 1;
        let resting = restings.iter().find(|r| r.events.iter().any(|e| dwell.events.contains(e)));
        if let Some(Resting { rest, .. }) = resting {
            segment.rewritten = true;
            segment.rewritten_executions += 1;
            segment.points = rest.out.points().len() + rest.back.points().len();
        }
        segment.time_before_s += time;
        segment.time_after_s += time;
        segment.energy_before_j += energy(before);
        segment.energy_after_j += energy(after);
        segment.potential_j += dwell.potential_j;
        segment.events.extend(&dwell.events);
    }
    by_place.into_values().collect()
}
