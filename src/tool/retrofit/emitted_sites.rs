//! The emitted streams of a site or a wait, and the values that their guard compares.

use std::collections::BTreeMap;

use super::candidate::{Candidate, with_stream};
use super::emission_context::{EmissionContext, argument, compared, place};
use super::guards::one_line;
use super::job::Original;
use super::relocated_waits::RelocatedWait;
use crate::rapid::ir::movement::{Argument, Movement};
use crate::rapid::ir::number::number;
use crate::rapid::ir::value::Datum;
use crate::rapid::text::Span;
use crate::retime::motion::timeline::{MoveRecord, Run, What};
use crate::retime::optimize::rest::Rest;
use crate::retime::optimize::site::Piece;
use crate::retime::path::joint_path::are_close;
use crate::tool::emit::{self, EmittedStream, MotionSettings, Now, Parameter, Pause, PutOff, Word};

/// A piece with its guard.
pub(super) struct EmittedPiece {
    pub(super) site: emit::Site,
    /// Its executions: event, and place in the run.
    executions: Vec<((usize, usize), Execution)>,
}

/// An execution of a piece.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Execution {
    /// Index of the site.
    site: usize,
    /// What its guard finds.
    way: Option<usize>,
}

impl EmittedPiece {
    /// Share of the guard's executions that belong to a site of the original.
    pub(super) fn share_of(&self, site: usize) -> f64 {
        let own = self.executions.iter().filter(|(_, execution)| execution.site == site).count();
        own as f64 / self.executions.len().max(1) as f64
    }
}

/// The guarded pieces: at the last piece of a run a stream, at those before movements to put off.
pub(super) fn emitted_pieces(
    context: &EmissionContext<'_>,
    original: &Original<'_>,
    candidates: &[Candidate],
) -> Vec<EmittedPiece> {
    let mut pieces: BTreeMap<Piece, EmittedPiece> = BTreeMap::new();
    let mut ways: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let mut states = 0;
    for (index, candidate) in with_stream(candidates) {
        let Some(run) = original.run(candidate) else { continue };
        let mut follows = 0;
        for (place, (piece, moves)) in parts(original, candidate, run).enumerate() {
            let is_last = place + 1 == original.sites[candidate.site].pieces.len();
            let arguments = arguments(moves);
            let (parameters, values) = compared(context, &arguments, &moves[0].movement);
            let emitted = pieces
                .entry(piece)
                .or_insert_with(|| emitted_piece(context, piece, moves, parameters.clone()));
            let settings = &mut emitted.site.settings;
            settings.fastest = settings.fastest.max(fastest(moves));
            let begins_alike = |other: &EmittedStream| {
                other.follows == follows
                    && other.values == values
                    && are_close(&other.start, &run.start, SAME_START)
            };
            let streams = &mut emitted.site.streams;
            let known =
                streams.iter().position(|other| other.puts_off.is_some() && begins_alike(other));
            let way = known.filter(|_| !is_last).or_else(|| {
                let stream = stream(context, original, candidate, (run, piece))?;
                let puts_off = (!is_last).then(|| {
                    states += 1;
                    PutOff { state: states, statements: statements(context, moves, &parameters) }
                });
                streams.push(EmittedStream { values, follows, puts_off, ..stream });
                Some(streams.len() - 1)
            });
            let Some(way) = way else { break };
            ways.insert((index, place), way);
            follows = streams[way].puts_off.as_ref().map_or(0, |put_off| put_off.state);
        }
    }
    for (index, candidate) in candidates.iter().enumerate() {
        for (place, piece) in original.sites[candidate.site].pieces.iter().enumerate() {
            let Some(emitted) = pieces.get_mut(piece) else { continue };
            let way = ways.get(&(index, place)).copied();
            let execution = Execution { site: candidate.site, way };
            let events = original.events(candidate).iter();
            emitted.executions.extend(events.map(|event| ((*event, place), execution)));
        }
    }
    let mut pieces: Vec<EmittedPiece> = pieces.into_values().collect();
    for piece in &mut pieces {
        piece.executions.sort_unstable();
        piece.site.order = piece.executions.iter().map(|(_, execution)| execution.way).collect();
    }
    pieces
}

/// Start positions closer than this are equal, rad.
const SAME_START: f64 = 1e-6;

/// The pieces of a run with their movements.
fn parts<'a>(
    original: &'a Original<'_>,
    candidate: &Candidate,
    run: &'a Run,
) -> impl Iterator<Item = (Piece, &'a [MoveRecord])> {
    let mut rest = run.moves.as_slice();
    original.sites[candidate.site].pieces.iter().map(move |piece| {
        let (own, others) = rest.split_at(piece.count.min(rest.len()));
        rest = others;
        (*piece, own)
    })
}

fn arguments(moves: &[MoveRecord]) -> Vec<Argument> {
    let mut arguments: Vec<Argument> = Vec::new();
    for argument in moves.iter().flat_map(|record| &record.movement.arguments) {
        if !arguments.contains(argument) {
            arguments.push(argument.clone());
        }
    }
    arguments
}

/// A piece without streams.
fn emitted_piece(
    context: &EmissionContext<'_>,
    piece: Piece,
    moves: &[MoveRecord],
    parameters: Vec<Parameter>,
) -> EmittedPiece {
    let movements = || moves.iter().map(|record| &record.movement);
    let first = &moves[0].movement;
    let site = emit::Site {
        span: piece.span(),
        origin: place(context.files, piece.span()),
        parameters,
        settings: MotionSettings {
            fastest: fastest(moves),
            conf_joint: first.settings.conf_joint,
            conf_linear: first.settings.conf_linear,
            lines: movements().any(|movement| movement.line_speed().is_finite()),
        },
        tool: argument(context.files, first.tool_span),
        streams: Vec::new(),
        order: Vec::new(),
    };
    EmittedPiece { site, executions: Vec::new() }
}

/// The largest speed that `VelSet` allows movements, mm/s.
fn fastest(moves: &[MoveRecord]) -> f64 {
    let speed = |record: &MoveRecord| {
        let Movement { speed, settings, .. } = &record.movement;
        1e3 * (speed.tcp * settings.speed_override).min(settings.speed_max)
    };
    moves.iter().map(speed).fold(0.0, f64::max).min(MOST_SPEED)
}

/// The statements of movements, with the compared values in place of their arguments.
fn statements(
    context: &EmissionContext<'_>,
    moves: &[MoveRecord],
    parameters: &[Parameter],
) -> Vec<Vec<Word>> {
    let statement = |record: &MoveRecord| {
        let Movement { span, arguments, .. } = &record.movement;
        let mut arguments: Vec<&Argument> = arguments.iter().collect();
        arguments.sort_by_key(|argument| argument.span.start);
        let mut words = Vec::new();
        let mut text = |start: u32, end: u32| {
            let text = one_line(context.files, Span { start, end, ..*span });
            let is_word = text.ends_with(|c: char| c.is_alphanumeric() || c == '_');
            words.push(Word::Text(if is_word { text + " " } else { text }));
        };
        let mut from = span.start;
        let mut places = Vec::new();
        for argument in arguments {
            let written = one_line(context.files, argument.span);
            let is_own = |parameter: &Parameter| {
                matches!(&parameter.now, Now::Argument(text) if *text == written)
                    && parameter.type_name == argument.type_name
            };
            let Some(index) = parameters.iter().position(is_own) else { continue };
            text(from, argument.span.start);
            places.push(index);
            from = argument.span.end;
        }
        text(from, span.end);
        let mut places = places.into_iter();
        let texts = words.into_iter();
        texts.flat_map(|word| [Some(word), places.next().map(Word::Parameter)]).flatten().collect()
    };
    moves.iter().map(statement).collect()
}

/// The speed limit of `VelSet` by default, mm/s: it cuts faster programmed speeds.
const MOST_SPEED: f64 = 5000.0;

/// The stream of a candidate, as the guard of one of its pieces may find it.
fn stream(
    context: &EmissionContext<'_>,
    original: &Original<'_>,
    candidate: &Candidate,
    (run, piece): (&Run, Piece),
) -> Option<EmittedStream> {
    let retiming = candidate.retiming()?;
    let site = &original.sites[candidate.site];
    let variants = site.variants.len();
    let variant = if variants > 1 {
        format!(", way {} of {variants}", candidate.variant + 1)
    } else {
        String::new()
    };
    let before: f64 = retiming.energy_before_j;
    let first = &run.moves.first()?.movement;
    // The override of VelSet stretches `\T`.
    let speed = first.settings.speed_override;
    Some(EmittedStream {
        start: run.start,
        points: retiming.stream.points().to_vec(),
        intervals: retiming.stream.intervals().iter().map(|time| speed * time).collect(),
        pause: None,
        external: first.external?,
        values: Vec::new(),
        follows: 0,
        puts_off: None,
        origin: format!("{}{variant}", place(context.files, piece.span())),
        before: format!("{} s {} J", number(run.duration(), 3), number(before, 1)),
        after: format!(
            "{} s {} J",
            number(retiming.duration_s, 3),
            number(retiming.energy.energy_j(), 1)
        ),
    })
}

/// The emitted stream of a relocated wait.
pub(super) fn emitted_wait(
    context: &EmissionContext<'_>,
    original: &Original<'_>,
    wait: &RelocatedWait,
) -> Option<emit::Site> {
    let events = &original.cycle.simulation.events;
    let What::Run(run) = &events[wait.run].what else { return None };
    let event = &events[wait.events[0]];
    let What::Wait(record) = &event.what else { return None };
    let movement = &run.moves.last()?.movement;
    let length = Datum::Num(record.wait.duration?);
    let length = Argument { span: record.wait.constant?, type_name: "num", datum: length };
    // The guard compares the position; the tool is that of the last movement.
    let tool = movement.arguments.iter().find(|argument| argument.span == movement.tool_span);
    let arguments: Vec<Argument> = std::iter::once(length).chain(tool.cloned()).collect();
    let (parameters, values) = compared(context, &arguments, movement);
    let Rest { out, wait_s, back, energy, energy_before_j, .. } = &wait.rest;
    let time = number(event.duration, 3);
    let place = place(context.files, wait.span);
    let stream = EmittedStream {
        start: *out.start(),
        points: [out.points(), back.points()].concat(),
        intervals: [out.intervals(), back.intervals()].concat(),
        pause: Some(Pause { after: out.points().len() - 1, seconds: *wait_s }),
        external: movement.external?,
        values,
        origin: format!("{place}, a wait"),
        follows: 0,
        puts_off: None,
        before: format!("{time} s {} J", number(*energy_before_j, 1)),
        after: format!("{time} s {} J", number(energy.energy_j(), 1)),
    };
    Some(emit::Site {
        span: wait.span,
        origin: place,
        parameters,
        settings: MotionSettings {
            fastest: 0.0,
            conf_joint: movement.settings.conf_joint,
            conf_linear: movement.settings.conf_linear,
            lines: false,
        },
        tool: argument(context.files, movement.tool_span),
        streams: vec![stream],
        order: vec![Some(0); wait.events.len()],
    })
}
