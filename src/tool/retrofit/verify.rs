//! The verifier: reads the emitted text, simulates it, and compares.

use std::collections::{BTreeMap, BTreeSet};

use super::figures::{OutputFile, OutputKind, Verification};
use super::outputs::read_again;
use super::rests::{self, Fault, Resting};
use super::settings::Settings;
use super::work::{Source, Way, nothing_to_verify, read_program};
use crate::arm::robot::Model;
use crate::rapid::syntax;
use crate::retime::energy::{Account, account};
use crate::retime::motion::stream::Stream;
use crate::retime::motion::timed::TimedMotion;
use crate::retime::motion::timeline::{Event, Run, What};
use crate::retime::motion::{Simulation, simulate};
use crate::retime::optimize::check::{Check, Room, check};
use crate::retime::optimize::corridor::Corridor;
use crate::retime::optimize::freedom::Freedom;
use crate::retime::optimize::keep_out::body;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::retime::PathUse;
use crate::retime::optimize::site::Site;
use crate::retime::path::joint_path::DOF;

/// Largest distance of an end point from the original one, rad.
const ENDPOINT_TOLERANCE: f64 = 1e-4;
/// Rounding of a sum of times, s.
const TIME_TOLERANCE: f64 = 1e-6;
/// Largest distance of a simulated stream from the intended one at any time, rad: the rounding of
/// the text is in the intended one already.
const INTENDED_TOLERANCE: f64 = 1e-6;
/// Step between two comparisons of them, s.
const STEP: f64 = 0.002;

/// One attempt.
pub(super) struct Attempt {
    /// The cycle of the emitted program, with the waits where they were.
    pub(super) simulation: Simulation,
    /// Its energy.
    pub(super) account: Account,
    /// What was seen.
    pub(super) verification: Verification,
    /// Ways that did not hold, with the reason.
    pub(super) failed: Vec<(usize, Reason)>,
    /// Waits that are not spent elsewhere as intended, by their index.
    pub(super) restless: BTreeMap<usize, Fault>,
}

/// Verifies an emitted program. Every way that fails is named; where the fault can't be given
/// to one way, all of them are.
pub(super) fn verify(
    files: &[Source],
    outputs: &[OutputFile],
    model: &Model,
    settings: &Settings,
    original: &Simulation,
    (sites, ways, restings): (&[Site], &[Way], &[Resting]),
) -> Attempt {
    let rewritten: Vec<usize> = (0..ways.len()).filter(|i| ways[*i].outcome.is_ok()).collect();
    let emitted = read_again(outputs);
    let mut verification = nothing_to_verify();
    let mut note = |what: &str, held: bool| verification.checks.push((what.to_owned(), held));
    let everything = |why: &str| {
        rewritten.iter().map(|i| (*i, Reason::Verification(why.to_owned()))).collect::<Vec<_>>()
    };

    let clean = outputs.iter().all(|output| match output.kind {
        OutputKind::New => {
            let parse = syntax::parse(&output.bytes);
            parse.errors.is_empty() && parse.tolerances.is_empty()
        }
        OutputKind::Changed => {
            let errors = |bytes: &[u8]| syntax::parse(bytes).errors.len();
            let before = output.input.map_or(0, |i| errors(&files[i].file.bytes));
            errors(&output.bytes) <= before
        }
        OutputKind::Unchanged => true,
    });
    note("the emitted text parses", clean);
    let bytes_kept = outputs.iter().all(|output| match (output.kind, output.input) {
        (OutputKind::Changed, Some(i)) => is_subsequence(&files[i].file.bytes, &output.bytes),
        (OutputKind::Unchanged, Some(i)) => files[i].file.bytes == output.bytes,
        _ => true,
    });
    note("every byte of the original is kept", bytes_kept);
    let program = read_program(&emitted, &settings.entry);
    let Ok((program, entry)) = program else {
        note("the emitted program has its entry", false);
        verification.passed = false;
        let failed = everything("the emitted text could not be read again");
        let restless = (0..restings.len()).map(|index| (index, Fault::Other)).collect();
        let simulation = empty();
        let account = account(model, &simulation);
        return Attempt { simulation, account, verification, failed, restless };
    };
    let simulation = simulate(&program, entry, model, &settings.options);
    let joules = account(model, &simulation);
    let ((simulation, joules), mut restless) =
        rests::folded(model, settings, simulation, joules, restings);
    note("waits that are spent elsewhere take their time", restless.is_empty());
    let mut failed = if clean && bytes_kept {
        Vec::new()
    } else {
        everything("the emitted text could not be read again")
    };

    let same_events = same_order(original, &simulation);
    note("movements, waits and outputs come in the same order", same_events);
    if !same_events && !restings.is_empty() {
        // Rather than judge the streams by it, the waits go back to where they were.
        for index in 0..restings.len() {
            restless.entry(index).or_insert(Fault::Other);
        }
    } else if !same_events && failed.is_empty() {
        let why = "the emitted program runs in another order";
        failed = match reordering(original, &simulation, sites, ways) {
            Some(way) => vec![(way, Reason::Verification(why.into()))],
            None => everything(why),
        };
    }
    let cycle_kept = match settings.budget {
        super::Budget::AsBefore => simulation.cycle_s <= original.cycle_s + TIME_TOLERANCE,
        super::Budget::Takt(takt) => {
            simulation.cycle_s <= takt.max(original.cycle_s) + TIME_TOLERANCE
        }
        super::Budget::Factor(_) => true,
    };
    note("the cycle takes no longer than allowed", cycle_kept);
    if !cycle_kept && same_events && failed.is_empty() {
        failed = slowed(original, &simulation, sites, ways);
    }
    if failed.is_empty() && same_events {
        let mut worst = Check::none();
        let mut strayed: f64 = 0.0;
        let strict = settings.freedom.strict();
        for i in rewritten {
            let way = &ways[i];
            for event in &sites[way.site].variants[way.variant].events {
                let (before, after) = (&original.events[*event], &simulation.events[*event]);
                let Ok(retiming) = &way.outcome else { continue };
                let freedom = match retiming.path {
                    PathUse::Left => &settings.freedom,
                    _ => &strict,
                };
                match compare(model, freedom, before, after, &retiming.stream) {
                    Ok((check, distance)) => {
                        worst = worst.max(&check);
                        strayed = strayed.max(distance);
                    }
                    Err(why) => {
                        failed.push((i, Reason::Verification(why)));
                        break;
                    }
                }
            }
        }
        verification.worst = worst;
        verification.intended_error_rad = strayed;
        let held = failed.is_empty();
        verification.checks.push(("every stream keeps limits, path and ends".into(), held));
        verification.checks.push(("every stream runs as intended at each moment".into(), held));
    }
    verification.passed = failed.is_empty() && verification.checks.iter().all(|(_, held)| *held);
    Attempt { simulation, account: joules, verification, failed, restless }
}

/// The stream at the first event that is another one than before, or the last one before it.
fn reordering(
    original: &Simulation,
    simulation: &Simulation,
    sites: &[Site],
    ways: &[Way],
) -> Option<usize> {
    let pairs = original.events.iter().zip(&simulation.events);
    let first = pairs.take_while(|(a, b)| same_event(a, b)).count();
    streams(sites, ways).range(..=first).next_back().map(|(_, way)| *way)
}

/// The ways with streams, by the events in which they run.
fn streams(sites: &[Site], ways: &[Way]) -> BTreeMap<usize, usize> {
    let mut streams = BTreeMap::new();
    for (i, way) in ways.iter().enumerate().filter(|(_, way)| way.outcome.is_ok()) {
        let events = &sites[way.site].variants[way.variant].events;
        streams.extend(events.iter().map(|event| (*event, i)));
    }
    streams
}

/// The streams behind which a movement that stays takes longer than before.
fn slowed(
    original: &Simulation,
    simulation: &Simulation,
    sites: &[Site],
    ways: &[Way],
) -> Vec<(usize, Reason)> {
    let streams = streams(sites, ways);
    let pairs = original.events.iter().zip(&simulation.events).enumerate();
    let slower = pairs.filter(|(event, (before, after))| {
        !streams.contains_key(event) && after.duration > before.duration + TIME_TOLERANCE
    });
    let before = slower.filter_map(|(event, _)| streams.range(..event).next_back());
    let blamed: BTreeSet<usize> = before.map(|(_, way)| *way).collect();
    let why = "a movement after it takes longer from where it ends";
    blamed.into_iter().map(|i| (i, Reason::Verification(why.into()))).collect()
}

fn empty() -> Simulation {
    Simulation {
        events: Vec::new(),
        cycle_s: 0.0,
        repeats_from: None,
        unresolved: Vec::new(),
        assumed: Vec::new(),
        inputs_asked: BTreeSet::new(),
    }
}

/// Whether all bytes of `part` stand in `whole`, in order.
fn is_subsequence(part: &[u8], whole: &[u8]) -> bool {
    let mut rest = whole.iter();
    part.iter().all(|byte| rest.any(|other| other == byte))
}

/// The same kinds of events with the same outputs, waits and ends.
pub(super) fn same_order(a: &Simulation, b: &Simulation) -> bool {
    a.events.len() == b.events.len()
        && a.events.iter().zip(&b.events).all(|(a, b)| same_event(a, b))
}

fn same_event(a: &Event, b: &Event) -> bool {
    match (&a.what, &b.what) {
        (What::Run(a), What::Run(b)) => same_ends(a, b),
        (What::Wait(a), What::Wait(b)) => {
            a.wait.instruction == b.wait.instruction && a.wait.signal == b.wait.signal
        }
        (What::Output(a, _), What::Output(b, _)) => a.signal == b.signal && a.value == b.value,
        (What::Left(a), What::Left(b)) => a.reason == b.reason,
        _ => false,
    }
}

fn same_ends(a: &Run, b: &Run) -> bool {
    (0..DOF).all(|j| {
        (a.start[j] - b.start[j]).abs() <= ENDPOINT_TOLERANCE
            && (a.end[j] - b.end[j]).abs() <= ENDPOINT_TOLERANCE
    })
}

/// The stream that runs now against the run that was, and its distance (rad) from the intended
/// one.
fn compare(
    model: &Model,
    freedom: &Freedom,
    before: &Event,
    after: &Event,
    intended: &Stream,
) -> Result<(Check, f64), String> {
    let (What::Run(run), What::Run(new)) = (&before.what, &after.what) else {
        return Err("another event stands in its place".into());
    };
    let [(_, TimedMotion::Stream(stream))] = new.motions.as_slice() else {
        return Err("the emitted points do not run as a stream".into());
    };
    let corridor =
        Corridor::new(model, run, freedom).ok_or("the original path is not one piece")?;
    if new.load != run.load {
        return Err("it runs with another tool or load".into());
    }
    let body = body(model, run, freedom);
    let tool = &run.legs[0].tool;
    let check = check(model, &run.load, tool, stream, Room::Corridor(&corridor), body.as_ref());
    if !check.holds() {
        return Err("a limit is exceeded by the emitted points".into());
    }
    if check.endpoint_error_rad > ENDPOINT_TOLERANCE {
        return Err("it ends elsewhere".into());
    }
    let strayed = distance(intended, stream);
    if strayed > INTENDED_TOLERANCE {
        return Err("the emitted points do not move as intended".into());
    }
    Ok((check, strayed))
}

/// Largest distance of a joint between two streams at the same time, rad; infinite where they do
/// not take the same time.
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
