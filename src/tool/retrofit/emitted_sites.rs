//! The emitted streams of a site or a wait, and the values that their guard compares.

use super::candidate::Candidate;
use super::emission_context::{EmissionContext, argument, compared, place};
use super::job::Original;
use super::relocated_waits::RelocatedWait;
use crate::rapid::ir::movement::Argument;
use crate::rapid::ir::number::number;
use crate::rapid::ir::value::Datum;
use crate::retime::motion::timeline::What;
use crate::retime::optimize::rest::Rest;
use crate::tool::emit::{self, EmittedStream, MotionSettings, Parameter, Pause};

/// A site with its streams; `None` without streams.
pub(super) fn emitted_site(
    context: &EmissionContext<'_>,
    original: &Original<'_>,
    candidates: &[Candidate],
    index: usize,
) -> Option<emit::Site> {
    let own = || candidates.iter().filter(|candidate| candidate.site == index);
    let run = original.run(own().find(|candidate| candidate.retiming().is_some())?)?;
    let site = &original.sites[index];
    let mut streams: Vec<(Vec<Parameter>, EmittedStream)> = Vec::new();
    let mut order: Vec<(usize, Option<usize>)> = Vec::new();
    for candidate in own() {
        let stream = stream(context, original, candidate);
        let runs = stream.is_some().then_some(streams.len());
        order.extend(original.events(candidate).iter().map(|event| (*event, runs)));
        streams.extend(stream);
    }
    order.sort_unstable();
    let parameters = streams.first()?.0.clone();
    let movements = || run.moves.iter().map(|record| &record.movement);
    let first = movements().next()?;
    Some(emit::Site {
        span: site.span,
        origin: place(context.files, site.span),
        parameters,
        settings: MotionSettings {
            fastest: movements().map(|m| 1e3 * m.speed.tcp).fold(0.0, f64::max).min(MOST_SPEED),
            conf_joint: first.settings.conf_joint,
            conf_linear: first.settings.conf_linear,
            lines: movements().any(|movement| movement.line_speed().is_finite()),
        },
        tool: argument(context.files, first.tool_span),
        streams: streams.into_iter().map(|(_, stream)| stream).collect(),
        order: order.into_iter().map(|(_, runs)| runs).collect(),
    })
}

/// The speed limit of `VelSet` by default, mm/s: it cuts faster programmed speeds.
const MOST_SPEED: f64 = 5000.0;

fn stream(
    context: &EmissionContext<'_>,
    original: &Original<'_>,
    candidate: &Candidate,
) -> Option<(Vec<Parameter>, EmittedStream)> {
    let retiming = candidate.retiming()?;
    let run = original.run(candidate)?;
    let site = &original.sites[candidate.site];
    let variants = site.variants.len();
    let variant = if variants > 1 {
        format!(", way {} of {variants}", candidate.variant + 1)
    } else {
        String::new()
    };
    let first = &run.moves.first()?.movement;
    let (parameters, values) =
        compared(context, &site.variants[candidate.variant].arguments, first);
    let before: f64 = retiming.energy_before_j;
    let stream = EmittedStream {
        start: run.start,
        points: retiming.stream.points().to_vec(),
        intervals: retiming.stream.intervals().to_vec(),
        pause: None,
        external: first.external?,
        values,
        origin: format!("{}{variant}", place(context.files, site.span)),
        before: format!("{} s {} J", number(run.duration(), 3), number(before, 1)),
        after: format!(
            "{} s {} J",
            number(retiming.duration_s, 3),
            number(retiming.energy.energy_j(), 1)
        ),
    };
    Some((parameters, stream))
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
