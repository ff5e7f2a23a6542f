//! Waits of known length that are spent at a pose nearby, in the emitted program: which they are,
//! what is emitted for them, and how a simulation of it compares with one that has the waits.

use std::collections::{BTreeMap, BTreeSet};

use super::outputs::{Writing, argument, compared, place};
use super::settings::Settings;
use super::work::{Source, TIME_TOLERANCE, Way};
use crate::arm::robot::Model;
use crate::rapid::ir::movement::Argument;
use crate::rapid::ir::number::number;
use crate::rapid::ir::value::Datum;
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
use crate::retime::optimize::site::Site;
use crate::retime::path::joint_path::{DOF, Joints};
use crate::tool::emit::{self, EmittedStream, MotionSettings, Pause};

/// Joints closer than this are the same place, rad.
const SAME_PLACE: f64 = 1e-6;
/// The same after the rounding of emitted text, rad.
const ENDPOINT_TOLERANCE: f64 = 1e-4;

/// A wait that is spent elsewhere.
pub(super) struct Resting {
    /// The statement.
    pub(super) span: Span,
    /// The events in which it ran.
    pub(super) events: Vec<usize>,
    /// The run before the first of them.
    run: usize,
    /// How long the wait is, s.
    duration: f64,
    /// What is emitted.
    pub(super) rest: Rest,
}

/// The waits of a program that may be spent elsewhere, as far as it pays: their length is constant,
/// they are always the same, and the run before each of them can be a stream itself. An output
/// that is set where the robot stands may start a process there: such a wait has to be made free
/// by a comment.
pub(super) fn restings(
    model: &Model,
    settings: &Settings,
    files: &[Source],
    simulation: &Simulation,
    sites: &[Site],
    ways: &[Way],
) -> Vec<Resting> {
    let Some(distance) = settings.dwell_pose else { return Vec::new() };
    let loads = settings.freedom.loads(model).for_other_ways(model);
    let free: BTreeSet<usize> = ways
        .iter()
        .filter(|way| matches!(way.outcome, Ok(_) | Err(Reason::NoSaving)))
        .flat_map(|way| sites[way.site].variants[way.variant].events.iter().copied())
        .collect();
    let mut places: BTreeMap<Span, Vec<usize>> = BTreeMap::new();
    for (index, event) in simulation.events.iter().enumerate() {
        if let What::Wait(record) = &event.what {
            places.entry(record.wait.span).or_default().push(index);
        }
    }
    let resting = |(span, events): (Span, Vec<usize>)| {
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
        if !alike || external || !stands_alone(files, span) {
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
        Some(Resting { span, run: first.run, duration: first.duration, events, rest })
    };
    places.into_iter().filter_map(resting).collect()
}

/// A wait with what came before it.
struct Standing<'a> {
    record: &'a WaitRecord,
    duration: f64,
    /// The event of the run that led here.
    run: usize,
    leading: &'a Run,
}

impl Standing<'_> {
    fn is_same(&self, other: &Standing<'_>) -> bool {
        (self.duration - other.duration).abs() < TIME_TOLERANCE
            && apart(&self.record.q, &other.record.q) < SAME_PLACE
            && self.record.load == other.record.load
            && self.record.wait.routine == other.record.wait.routine
    }
}

/// A wait of constant length where a run of the same routine has led to.
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
        && apart(&leading.end, &record.q) < SAME_PLACE;
    let duration = simulation.events[event].duration;
    (stated && at_home).then_some(Standing { record, duration, run, leading })
}

/// Whether a statement begins its line: what stands before it could be a condition.
fn stands_alone(files: &[Source], span: Span) -> bool {
    let bytes = &files[span.file.0 as usize].file.bytes[..span.start as usize];
    let line = bytes.iter().rev().take_while(|b| !matches!(b, b'\n' | b'\r'));
    line.into_iter().all(u8::is_ascii_whitespace)
}

fn apart(a: &Joints, b: &Joints) -> f64 {
    (0..DOF).map(|j| (a[j] - b[j]).abs()).fold(0.0, f64::max)
}

/// What is emitted for a wait.
pub(super) fn emitted(
    writing: &Writing<'_>,
    simulation: &Simulation,
    resting: &Resting,
) -> Option<emit::Site> {
    let What::Run(run) = &simulation.events[resting.run].what else { return None };
    let event = &simulation.events[resting.events[0]];
    let What::Wait(record) = &event.what else { return None };
    let movement = &run.moves.last()?.movement;
    let length = Datum::Num(record.wait.duration?);
    let length = Argument { span: record.wait.constant?, type_name: "num", datum: length };
    // Where it stands is guarded; what it holds there is the last movement's.
    let tool = movement.arguments.iter().find(|argument| argument.span == movement.tool_span);
    let arguments: Vec<Argument> = std::iter::once(length).chain(tool.cloned()).collect();
    let (parameters, values) = compared(writing, &arguments, movement);
    let Rest { out, wait_s, back, energy, energy_before_j, .. } = &resting.rest;
    let time = number(event.duration, 3);
    let place = place(writing.files, resting.span);
    let stream = EmittedStream {
        start: *out.start(),
        points: [out.points(), back.points()].concat(),
        intervals: [out.intervals(), back.intervals()].concat(),
        pause: Some(Pause { after: out.points().len() - 1, seconds: *wait_s }),
        external: movement.external?,
        values,
        origin: format!("{place}, a wait"),
        before: format!("{time} s {} J", number(*energy_before_j, 1)),
        after: format!("{time} s {} J", number(energy.energy_j(), 1)),
    };
    Some(emit::Site {
        span: resting.span,
        origin: place,
        parameters,
        settings: MotionSettings {
            fastest: 0.0,
            conf_joint: movement.settings.conf_joint,
            conf_linear: movement.settings.conf_linear,
            lines: false,
        },
        tool: argument(writing.files, movement.tool_span),
        streams: vec![stream],
        order: vec![Some(0); resting.events.len()],
    })
}

/// What became of a wait in the emitted program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fault {
    /// It takes so much longer than it should, s: the robot settles more often.
    Late(f64),
    /// It does not run as intended.
    Other,
}

/// A simulation of the emitted program with the waits where they were: settling before it, the way
/// there, standing and the way back are one event again, with the energy of all. Those that do not
/// run as intended are named by their index; the simulation is not whole then.
pub(super) fn folded(
    model: &Model,
    settings: &Settings,
    simulation: Simulation,
    account: Account,
    restings: &[Resting],
) -> ((Simulation, Account), BTreeMap<usize, Fault>) {
    let mut due: BTreeMap<usize, usize> = BTreeMap::new();
    for (index, resting) in restings.iter().enumerate() {
        due.extend(resting.events.iter().map(|event| (*event, index)));
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
        let resting = &restings[index];
        let settling = events.last_mut().map_or(0.0, unsettle);
        let fault = match lateness(model, settings, &parts, resting) {
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
    ((simulation, Account { total: account.total, events: energies }), faults)
}

/// Shortens the pauses of rests that are late, the first time; leaves out the other faulty ones.
pub(super) fn mend(restings: &mut Vec<Resting>, faults: &BTreeMap<usize, Fault>, first: bool) {
    let mut index = 0;
    restings.retain_mut(|resting| {
        let fault = faults.get(&index);
        index += 1;
        match fault {
            None => true,
            Some(Fault::Late(late)) if first && *late < resting.rest.wait_s => {
                resting.rest.wait_s -= late;
                true
            }
            Some(_) => false,
        }
    });
}

/// Events after the first one of a rest.
const WAY_AND_BACK: usize = 2;

/// Takes the settling off a run, as before a wait: what it took, s.
fn unsettle(event: &mut Event) -> f64 {
    let What::Run(run) = &mut event.what else { return 0.0 };
    let settling = std::mem::take(&mut run.settling);
    if let Some(last) = run.moves.last_mut() {
        last.duration -= settling;
    }
    event.duration -= settling;
    settling
}

/// How much longer than the wait three events take that are the way to a rest, standing there and
/// the way back, within the limits, s; `None` where they are not that.
fn lateness(model: &Model, settings: &Settings, parts: &[Event], resting: &Resting) -> Option<f64> {
    let [out, stand, back] = parts else { return None };
    let (What::Run(out), What::Wait(wait), What::Run(back)) = (&out.what, &stand.what, &back.what)
    else {
        return None;
    };
    let Rest { out: there, back: again, .. } = &resting.rest;
    let ways_hold = [(out, there), (back, again)].into_iter().all(|(run, intended)| {
        let [(_, TimedMotion::Stream(stream))] = run.motions.as_slice() else { return false };
        let tool = &run.legs[0].tool;
        let body = around(model, tool, &settings.freedom);
        let loads = settings.freedom.loads(model).for_other_ways(model);
        let room = Room::Free(&loads);
        let seen = check(model, &run.load, tool, stream, room, body.as_ref());
        seen.holds()
            && run.load == wait.load
            && apart(stream.end(), intended.end()) <= ENDPOINT_TOLERANCE
            && apart(stream.start(), intended.start()) <= ENDPOINT_TOLERANCE
    });
    let stands = apart(&wait.q, there.end()) <= ENDPOINT_TOLERANCE;
    let time: f64 = parts.iter().map(|event| event.duration).sum();
    (ways_hold && stands).then_some(time - resting.duration)
}
