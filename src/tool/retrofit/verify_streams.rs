//! Verifies each stream against the run that it replaces.

use std::collections::{BTreeMap, BTreeSet};

use super::candidate::{Candidate, with_stream};
use super::figures::Verification;
use super::job::Original;
use super::order::same_event;
use super::settings::Settings;
use super::simulated::{ENDPOINT_TOLERANCE, TIME_TOLERANCE};
use crate::arm::robot::Model;
use crate::retime::motion::Simulation;
use crate::retime::motion::stream::Stream;
use crate::retime::motion::timed::TimedMotion;
use crate::retime::motion::timeline::{Event, What};
use crate::retime::optimize::check::{Check, Room, check};
use crate::retime::optimize::corridor::Corridor;
use crate::retime::optimize::freedom::Freedom;
use crate::retime::optimize::keep_out::body;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::retime::PathUse;
use crate::retime::path::joint_path::DOF;

/// Maximum distance of a simulated stream from the intended one, rad. The intended one already
/// contains the rounding of the text.
const INTENDED_TOLERANCE: f64 = 1e-6;
/// Time step of this comparison, s.
const STEP: f64 = 0.002;

/// Compares the streams of an emitted program that has the events of the original, and adds the
/// result to `verification`. Returns the candidates whose streams fail, with the reason.
pub(super) fn compare_streams(
    original: &Original<'_>,
    emitted: &Simulation,
    model: &Model,
    settings: &Settings,
    candidates: &[Candidate],
    verification: &mut Verification,
) -> Vec<(usize, Reason)> {
    let mut failed = Vec::new();
    let strict = settings.freedom.strict();
    for (index, candidate) in candidates.iter().enumerate() {
        let Some(retiming) = candidate.retiming() else { continue };
        let freedom = match retiming.path {
            PathUse::Left => &settings.freedom,
            PathUse::Kept | PathUse::KeptFor(_) => &strict,
        };
        for event in original.events(candidate) {
            let (before, after) =
                (&original.cycle.simulation.events[*event], &emitted.events[*event]);
            match compare(model, freedom, before, after, &retiming.stream) {
                Ok((check, distance)) => {
                    verification.worst = verification.worst.max(&check);
                    let intended_error_rad = &mut verification.intended_error_rad;
                    *intended_error_rad = intended_error_rad.max(distance);
                }
                Err(why) => {
                    failed.push((index, Reason::Verification(why.to_owned())));
                    break;
                }
            }
        }
    }
    verification.note("every stream keeps limits, path and ends", failed.is_empty());
    verification.note("every stream runs as intended at each moment", failed.is_empty());
    failed
}

/// All candidates with streams, with this reason.
pub(super) fn all_failed(candidates: &[Candidate], why: &str) -> Vec<(usize, Reason)> {
    let reason = || Reason::Verification(why.to_owned());
    with_stream(candidates).map(|(index, _)| (index, reason())).collect()
}

/// The stream at or before the first event that differs; all streams if there is none.
pub(super) fn reordering(
    original: &Original<'_>,
    emitted: &Simulation,
    candidates: &[Candidate],
) -> Vec<(usize, Reason)> {
    let why = "the emitted program runs in another order";
    let pairs = original.cycle.simulation.events.iter().zip(&emitted.events);
    let first = pairs.take_while(|(a, b)| same_event(a, b)).count();
    match streams(original, candidates).range(..=first).next_back() {
        Some((_, index)) => vec![(*index, Reason::Verification(why.into()))],
        None => all_failed(candidates, why),
    }
}

fn streams(original: &Original<'_>, candidates: &[Candidate]) -> BTreeMap<usize, usize> {
    with_stream(candidates)
        .flat_map(|(i, c)| original.events(c).iter().map(move |event| (*event, i)))
        .collect()
}

/// The streams that precede an unchanged movement that takes longer than before.
pub(super) fn slowing(
    original: &Original<'_>,
    emitted: &Simulation,
    candidates: &[Candidate],
) -> Vec<(usize, Reason)> {
    let streams = streams(original, candidates);
    let events = &original.cycle.simulation.events;
    let pairs = events.iter().zip(&emitted.events).enumerate();
    let slower = pairs.filter(|(event, (before, after))| {
        !streams.contains_key(event) && after.duration > before.duration + TIME_TOLERANCE
    });
    let before = slower.filter_map(|(event, _)| streams.range(..event).next_back());
    let blamed: BTreeSet<usize> = before.map(|(_, candidate)| *candidate).collect();
    let why = "a movement after it takes longer from where it ends";
    blamed.into_iter().map(|i| (i, Reason::Verification(why.into()))).collect()
}

/// The check of an emitted stream against the original run, and its distance (rad) from the
/// intended one.
fn compare(
    model: &Model,
    freedom: &Freedom,
    before: &Event,
    after: &Event,
    intended: &Stream,
) -> Result<(Check, f64), &'static str> {
    let (What::Run(run), What::Run(new)) = (&before.what, &after.what) else {
        return Err("another event stands in its place");
    };
    let [(_, TimedMotion::Stream(stream))] = new.motions.as_slice() else {
        return Err("the emitted points do not run as a stream");
    };
    let corridor =
        Corridor::new(model, run, freedom).ok_or("the original path is not one piece")?;
    if new.load != run.load {
        return Err("it runs with another tool or load");
    }
    let body = body(model, run, freedom);
    let tool = &run.legs[0].tool;
    let check = check(model, &run.load, tool, stream, Room::Corridor(&corridor), body.as_ref());
    if !check.holds() {
        return Err("a limit is exceeded by the emitted points");
    }
    if check.endpoint_error_rad > ENDPOINT_TOLERANCE {
        return Err("it ends elsewhere");
    }
    let strayed = distance(intended, stream);
    if strayed > INTENDED_TOLERANCE {
        return Err("the emitted points do not move as intended");
    }
    Ok((check, strayed))
}

/// Largest joint distance of two streams at the same time, rad; infinite if their durations differ.
fn distance(intended: &Stream, stream: &Stream) -> f64 {
    let duration = intended.duration();
    if (stream.duration() - duration).abs() > TIME_TOLERANCE {
        return f64::INFINITY;
    }
    let count = (duration / STEP).ceil().max(1.0) as usize;
    let apart = |i: usize| {
        let t = duration * i as f64 / count as f64;
        let (a, b) = (intended.eval(t).0, stream.eval(t).0);
        (0..DOF).map(|j| (a[j] - b[j]).abs()).fold(0.0, f64::max)
    };
    (0..=count).map(apart).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::*;

    #[test]
    fn another_motion_in_the_same_time_is_seen() {
        let stream = |middle: f64, times: [f64; 3]| {
            let points = vec![[0.1; DOF], [middle; DOF], [1.0; DOF]];
            Stream::new([0.0; DOF], points, times.to_vec()).unwrap()
        };
        let intended = stream(0.8, [0.1, 0.1, 0.1]);
        assert_eq!(distance(&intended, &intended), 0.0);
        assert!(distance(&intended, &stream(0.79, [0.1, 0.1, 0.1])) > 1e-3);
        assert!(distance(&intended, &stream(0.8, [0.09, 0.12, 0.09])) > 1e-3);
        assert!(distance(&intended, &stream(0.8, [0.1, 0.1, 0.2])).is_infinite());
    }
}
