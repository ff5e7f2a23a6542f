//! Waits of known length that are spent at a nearby pose of lower holding power, and the comparison
//! of the emitted program with the original waits.

use std::collections::{BTreeMap, BTreeSet};

use super::candidate::{Candidate, State};
use super::files::Source;
use super::job::Job;
use super::settings::Settings;
use super::simulated::{ENDPOINT_TOLERANCE, Simulated, TIME_TOLERANCE};
use crate::arm::robot::Model;
use crate::rapid::text::Span;
use crate::retime::energy::account::{at_rest, run_energy};
use crate::retime::energy::{Account, EnergyParts};
use crate::retime::motion::Simulation;
use crate::retime::motion::timed::TimedMotion;
use crate::retime::motion::timeline::{Event, Run, WaitBasis, WaitRecord, What};
use crate::retime::optimize::check::{Room, check};
use crate::retime::optimize::keep_out::around;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::rest::{Rest, Standstill, rest};
use crate::retime::path::joint_path::are_close;

/// Smaller joint distances count as the same place, rad.
const SAME_PLACE: f64 = 1e-6;

/// A wait at another pose.
pub(super) struct RelocatedWait {
    pub(super) span: Span,
    /// Its events in the original.
    pub(super) events: Vec<usize>,
    /// The run before the first of them.
    pub(super) run: usize,
    /// Length of the wait, s.
    duration: f64,
    /// The emitted motion.
    pub(super) rest: Rest,
}

/// The waits that may be relocated and for which it pays: constant length, equal executions, and a
/// preceding run that can be a stream. An output set before the wait may start a process at that
/// place; such a wait is relocated only if a comment makes it free.
pub(super) fn relocated_waits(job: &Job<'_>, candidates: &[Candidate]) -> Vec<RelocatedWait> {
    let Job { original, model, settings, .. } = job;
    let simulation = &original.cycle.simulation;
    let Some(distance) = settings.dwell_pose else { return Vec::new() };
    let loads = settings.freedom.loads(model).for_new_motions(model);
    let may_be_stream = |candidate: &&Candidate| {
        matches!(candidate.state, State::Done(_) | State::Refused(Reason::NoSaving))
    };
    let free: BTreeSet<usize> = candidates
        .iter()
        .filter(may_be_stream)
        .flat_map(|candidate| original.events(candidate).iter().copied())
        .collect();
    let mut places: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
    for (index, event) in simulation.events.iter().enumerate() {
        if let What::Wait(record) = &event.what {
            places.entry(record.wait.span).or_default().push(index);
        }
    }
    let relocated = |(span, events): (Span, Vec<usize>)| {
        let first = standing(simulation, events[0])?;
        let alike = events.iter().all(|event| {
            standing(simulation, *event).is_some_and(|other| {
                let events = &simulation.events[other.run..*event];
                let sets = events.iter().any(|event| matches!(event.what, What::Output(..)));
                free.contains(&other.run)
                    && first.is_same(&other)
                    && (!sets || settings.freedom.freed.contains(&span))
            })
        });
        let external = first.record.wait.external.is_some();
        let last = &first.leading.moves.last()?.movement;
        let is_scaled = last.settings.shares() != [1.0; 3];
        if !alike || external || is_scaled || !stands_alone(original.files, span) {
            return None;
        }
        let tool = &first.leading.legs.last()?.tool;
        let body = around(model, tool, &settings.freedom);
        let standstill = Standstill {
            model,
            load: &first.record.load,
            tool,
            q: first.record.q,
            duration: first.duration,
            loads: &loads,
            body: body.as_ref(),
        };
        let rest = rest(&standstill, distance, settings.spacing_s)?;
        Some(RelocatedWait { span, run: first.run, duration: first.duration, events, rest })
    };
    places.into_iter().filter_map(relocated).collect()
}

/// A wait with the run before it.
struct Standing<'a> {
    record: &'a WaitRecord,
    duration: f64,
    /// The event of the preceding run.
    run: usize,
    leading: &'a Run,
}

impl Standing<'_> {
    fn is_same(&self, other: &Standing<'_>) -> bool {
        (self.duration - other.duration).abs() < TIME_TOLERANCE
            && are_close(&self.record.q, &other.record.q, SAME_PLACE)
            && self.record.load == other.record.load
            && self.record.wait.routine == other.record.wait.routine
    }
}

/// A wait of constant length after a run of the same routine.
fn standing(simulation: &Simulation, event: usize) -> Option<Standing<'_>> {
    let What::Wait(record) = &simulation.events[event].what else { return None };
    let stated = record.basis == WaitBasis::Stated
        && record.wait.constant.is_some()
        && record.position_known
        && record.wait.signal.is_none()
        && record.wait.instruction.eq_ignore_ascii_case("WaitTime");
    let before = &simulation.events[..event];
    let run = before.iter().rposition(|e| matches!(e.what, What::Run(_) | What::Left(_)))?;
    let What::Run(leading) = &simulation.events[run].what else { return None };
    let last = &leading.moves.last()?.movement;
    let at_home = last.routine == record.wait.routine
        && last.span.file == record.wait.span.file
        && leading.load == record.load
        && are_close(&leading.end, &record.q, SAME_PLACE);
    let duration = simulation.events[event].duration;
    (stated && at_home).then_some(Standing { record, duration, run, leading })
}

/// Whether a statement begins its line; text before it could be a condition.
fn stands_alone(files: &[Source], span: Span) -> bool {
    let bytes = &files[span.file.0 as usize].file.bytes[..span.start as usize];
    let line = bytes.iter().rev().take_while(|b| !matches!(b, b'\n' | b'\r'));
    line.into_iter().all(u8::is_ascii_whitespace)
}

/// A fault of a relocated wait in the emitted program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fault {
    /// It takes this much too long, s: the robot settles more often.
    Late(f64),
    /// It does not run as intended.
    Other,
}

/// The simulation with each relocated wait folded into one event at its original place: settling,
/// way out, standing, way back, with the sum of their energies. Also the faults by index of the
/// wait; with faults the simulation is incomplete.
pub(super) fn with_waits_folded(
    model: &Model,
    settings: &Settings,
    emitted: Simulated,
    waits: &[RelocatedWait],
) -> (Simulated, BTreeMap<usize, Fault>) {
    let Simulated { simulation, account } = emitted;
    let mut due: BTreeMap<usize, usize> = BTreeMap::new();
    for (index, wait) in waits.iter().enumerate() {
        due.extend(wait.events.iter().map(|event| (*event, index)));
    }
    let mut faults = BTreeMap::new();
    let mut events: Vec<Event> = Vec::with_capacity(simulation.events.len());
    let mut energies: Vec<Vec<EnergyParts>> = Vec::with_capacity(events.capacity());
    let mut repeats_from = simulation.repeats_from;
    let mut left = simulation.events.into_iter().zip(account.events);
    let mut taken = 0;
    while let Some((event, energy)) = left.next() {
        if simulation.repeats_from == Some(taken) {
            repeats_from = Some(events.len());
        }
        taken += 1;
        let Some(index) = due.get(&events.len()).copied() else {
            events.push(event);
            energies.push(energy);
            continue;
        };
        let (mut parts, mut parts_energy) = (vec![event], vec![energy]);
        for (event, energy) in left.by_ref().take(WAY_AND_BACK) {
            parts.push(event);
            parts_energy.push(energy);
            taken += 1;
        }
        let settling = events.last_mut().map_or(0.0, remove_settling);
        let fault = match excess_time(model, settings, &parts, &waits[index]) {
            Some(late) if (late + settling).abs() <= TIME_TOLERANCE => None,
            Some(late) if late + settling > 0.0 => Some(Fault::Late(late + settling)),
            _ => Some(Fault::Other),
        };
        if let Some(fault) = fault {
            faults.entry(index).or_insert(fault);
        }
        let mut whole = parts_energy.iter().flatten().fold(EnergyParts::default(), |a, b| a + *b);
        if let (Some(Event { what: What::Run(run), .. }), Some(before), true) =
            (events.last(), energies.last_mut(), settling > 0.0)
        {
            *before = run_energy(model, run);
            whole += at_rest(model, &run.load, &run.end, settling);
        }
        let t_start = parts[0].t_start - settling;
        let duration = settling + parts.iter().map(|event| event.duration).sum::<f64>();
        let standing = parts.into_iter().map(|event| event.what).nth(1);
        if let Some(what) = standing {
            events.push(Event { t_start, duration, what });
            energies.push(vec![whole]);
        }
    }
    let simulation = Simulation { events, repeats_from, ..simulation };
    let account = Account { total: account.total, events: energies };
    (Simulated { simulation, account }, faults)
}

/// Removes the faulty waits; in the first round, late ones get shorter pauses instead.
pub(super) fn repaired(
    waits: Vec<RelocatedWait>,
    faults: &BTreeMap<usize, Fault>,
    first: bool,
) -> Vec<RelocatedWait> {
    let mend = |(index, mut wait): (usize, RelocatedWait)| match faults.get(&index) {
        None => Some(wait),
        Some(Fault::Late(late)) if first && *late < wait.rest.wait_s => {
            wait.rest.wait_s -= late;
            Some(wait)
        }
        Some(_) => None,
    };
    waits.into_iter().enumerate().filter_map(mend).collect()
}

/// Number of events of a relocated wait after the first.
const WAY_AND_BACK: usize = 2;

/// Removes the settling time of a run and returns it, s.
fn remove_settling(event: &mut Event) -> f64 {
    let What::Run(run) = &mut event.what else { return 0.0 };
    let settling = std::mem::take(&mut run.settling);
    if let Some(last) = run.moves.last_mut() {
        last.duration -= settling;
    }
    event.duration -= settling;
    settling
}

/// Excess time of the three events (way out, standing, way back) over the wait, s; `None` if they
/// are not these or exceed limits.
fn excess_time(
    model: &Model,
    settings: &Settings,
    parts: &[Event],
    wait: &RelocatedWait,
) -> Option<f64> {
    let [out, stand, back] = parts else { return None };
    let (What::Run(out), What::Wait(record), What::Run(back)) =
        (&out.what, &stand.what, &back.what)
    else {
        return None;
    };
    let Rest { out: there, back: again, .. } = &wait.rest;
    let ways_hold = [(out, there), (back, again)].into_iter().all(|(run, intended)| {
        let [(_, TimedMotion::Stream(stream))] = run.motions.as_slice() else { return false };
        let tool = &run.legs[0].tool;
        let body = around(model, tool, &settings.freedom);
        let loads = settings.freedom.loads(model).for_new_motions(model);
        let room = Room::Free(&loads);
        let seen = check(model, &run.load, tool, stream, room, body.as_ref());
        seen.holds()
            && run.load == record.load
            && are_close(stream.end(), intended.end(), ENDPOINT_TOLERANCE)
            && are_close(stream.start(), intended.start(), ENDPOINT_TOLERANCE)
    });
    let stands = are_close(&record.q, there.end(), ENDPOINT_TOLERANCE);
    let time: f64 = parts.iter().map(|event| event.duration).sum();
    (ways_hold && stands).then_some(time - wait.duration)
}
