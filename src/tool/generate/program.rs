//! The files of a generated program, and their verification by reading and simulation.

use super::error::GenerateError;
use super::follow::{self, Followed, Sampled, TOLERANCE};
use super::measure::Measure;
use super::moves::{Moves, Target};
use super::settings::Form;
use crate::arm::kinematics::{Conf, limits_ok};
use crate::arm::robot::Model;
use crate::rapid::ir::number::number;
use crate::retime::motion::stream::Stream;
use crate::retime::motion::timed::TimedMotion;
use crate::retime::motion::timeline::What;
use crate::retime::motion::{Options, Simulation};
use crate::retime::path::joint_path::DOF;
use crate::tool::emit::{self, EmitError, GeneratedMove, GeneratedNames, jointtarget, stream_time};
use crate::tool::retrofit::{OutputFile, file_and_line, parses, read_again, run_again};

/// Maximum distance of a reached point from the requested one, rad.
const REACHED: f64 = 1e-4;
/// Samples of a simulated motion per second.
const SAMPLES: f64 = 500.0;

pub(super) fn stream(
    names: &GeneratedNames,
    stream: &Stream,
) -> Result<Vec<OutputFile>, GenerateError> {
    let start = GeneratedMove {
        instruction: "MoveAbsJ",
        target: jointtarget(stream.start()),
        speed: "v200".into(),
        zone: "fine".into(),
    };
    let last = stream.points().len() - 1;
    let points = stream.points().iter().zip(stream.intervals()).enumerate();
    let points = points.map(|(i, (q, t))| GeneratedMove {
        instruction: "MoveAbsJ",
        target: jointtarget(q),
        speed: stream_time(*t),
        zone: if i == last { "fine" } else { "z200" }.into(),
    });
    let moves: Vec<GeneratedMove> = std::iter::once(start).chain(points).collect();
    let seconds = number(stream.duration(), 3);
    let about = format!("A trajectory of {seconds} s as a stream of {} points", last + 1);
    with_main_module(names, emit::generated_module(names, &about, &moves)?)
}

pub(super) fn moves(
    names: &GeneratedNames,
    moves: &Moves,
) -> Result<Vec<OutputFile>, GenerateError> {
    let robtarget = |target: &Target| {
        let position = target.pose.translation.vector * 1e3;
        let r = target.pose.rotation;
        let [x, y, z] = [position.x, position.y, position.z].map(|x| number(x, 4));
        let [w, i, j, k] = [r.w, r.i, r.j, r.k].map(|part| number(part, 9));
        let Conf { cf1, cf4, cf6, cfx } = target.conf;
        format!(
            "[[{x},{y},{z}],[{w},{i},{j},{k}],[{cf1},{cf4},{cf6},{cfx}],[9E9,9E9,9E9,9E9,9E9,9E9]]"
        )
    };
    let list: Vec<GeneratedMove> = moves
        .targets
        .iter()
        .enumerate()
        .map(|(i, target)| GeneratedMove {
            instruction: match moves.form {
                Form::MoveJ => "MoveJ",
                // A line needs a known start.
                Form::MoveL if i == 0 => "MoveJ",
                Form::MoveL => "MoveL",
                Form::AbsJ | Form::Egm => "MoveAbsJ",
            },
            target: match moves.form {
                Form::MoveJ | Form::MoveL => robtarget(target),
                Form::AbsJ | Form::Egm => jointtarget(&target.q),
            },
            speed: target.speed.clone(),
            zone: target.zone.clone(),
        })
        .collect();
    let about = format!("{} points", list.len());
    with_main_module(names, emit::generated_module(names, &about, &list)?)
}

/// Positions for externally guided motion, with their module.
pub(super) fn egm(
    names: &GeneratedNames,
    sampled: &Sampled,
) -> Result<Vec<OutputFile>, GenerateError> {
    let text = emit::egm_rows(&sampled.positions);
    let module = emit::egm_module(names, &sampled.positions, "tool0", "wobj0")?;
    let mut outputs = with_main_module(names, module)?;
    outputs.push(OutputFile::added(format!("{}.csv", names.module), text));
    check_text(&outputs[..2])?;
    Ok(outputs)
}

/// The module, and the module with the entry routine.
fn with_main_module(
    names: &GeneratedNames,
    module: String,
) -> Result<Vec<OutputFile>, GenerateError> {
    let main: Result<String, EmitError> = emit::main_module(names);
    Ok(vec![
        OutputFile::added(format!("{}.mod", names.module), module),
        OutputFile::added(format!("{}.mod", names.main), main?),
    ])
}

fn check_text(outputs: &[OutputFile]) -> Result<(), GenerateError> {
    if parses(&[], outputs) { Ok(()) } else { Err(unverified("the text does not parse")) }
}

fn unverified(what: impl Into<String>) -> GenerateError {
    GenerateError::Verification(what.into())
}

/// Simulates the emitted text.
fn simulated(model: &Model, outputs: &[OutputFile]) -> Result<Simulation, GenerateError> {
    check_text(outputs)?;
    let simulation = run_again(outputs, "main", model, &Options::default())
        .map_err(|error| unverified(error.to_string()))?;
    match simulation.unresolved.first() {
        Some(note) => {
            let place = file_and_line(&read_again(outputs), note.span);
            Err(unverified(format!("{place}: {}", note.reason)))
        }
        None => Ok(simulation),
    }
}

/// Verifies the emitted stream by simulation.
pub(super) fn verify_stream(
    model: &Model,
    outputs: &[OutputFile],
    followed: &Followed,
) -> Result<Measure, GenerateError> {
    let simulation = simulated(model, outputs)?;
    let stream = simulation.events.iter().rev().find_map(|event| match &event.what {
        What::Run(run) => match run.motions.as_slice() {
            [(_, TimedMotion::Stream(stream))] => Some(stream),
            _ => None,
        },
        _ => None,
    });
    let stream = stream.ok_or_else(|| unverified("the points do not run as a stream"))?;
    let measure = follow::measure(model, stream, &followed.reference);
    if let Some(fault) = measure.exceeded_limit() {
        return Err(unverified(fault));
    }
    if measure.deviation_m > TOLERANCE {
        return Err(unverified("the stream strays from the trajectory"));
    }
    Ok(measure)
}

/// Verifies the emitted movements by simulation; returns their time from the first point on.
pub(super) fn verify_moves(
    model: &Model,
    outputs: &[OutputFile],
    moves: &Moves,
) -> Result<f64, GenerateError> {
    let simulation = simulated(model, outputs)?;
    let mut reached = 0;
    for event in &simulation.events {
        let What::Run(run) = &event.what else { continue };
        if let Some(problem) = &run.problem {
            return Err(unverified(format!("row {}: {problem}", reached + 2)));
        }
        for leg in &run.legs {
            let far = |j: usize| (leg.end[j] - moves.targets[reached].q[j]).abs();
            if let Some(joint) = (0..DOF).find(|j| far(*j) > REACHED) {
                return Err(unverified(format!(
                    "row {}: the movement would end with joint {} elsewhere; give its configuration \
                     (cf1,cf4,cf6,cfx), or another point between",
                    reached + 2,
                    joint + 1
                )));
            }
            reached += 1;
        }
        let count = (run.duration() * SAMPLES).ceil().max(1.0) as usize;
        let mut times = (0..=count).map(|i| run.duration() * i as f64 / count as f64);
        if let Some(violation) = times.find_map(|t| limits_ok(model, &run.at(t).q).err()) {
            return Err(unverified(format!("on the way to row {}: {violation}", reached + 1)));
        }
    }
    if reached != moves.targets.len() {
        return Err(unverified(format!("{reached} of {} points are reached", moves.targets.len())));
    }
    let first = simulation.events.first().map_or(0.0, |event| match &event.what {
        What::Run(run) => run.moves.first().map_or(0.0, |first| first.duration),
        _ => 0.0,
    });
    Ok(simulation.cycle_s - first)
}
