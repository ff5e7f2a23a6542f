//! A simulated RAPID program as the cycle of a plant, and the same with other movements.

use joulepath::arm::robot::Model;
use joulepath::examine::plant::{Power, Script, Step};
use joulepath::retime::energy::account::{account, base};
use joulepath::retime::energy::power::holding_w;
use joulepath::retime::energy::{Account, EnergyParts};
use joulepath::retime::motion::Simulation;
use joulepath::retime::motion::timeline::What;
use joulepath::tool::retrofit::Source;

/// The plant never closes the brakes: joulepath does not count on it either.
const NEVER_S: f64 = 1e9;

/// What a robot takes at rest: base power and brake coils, and the mean of the holding power over the
/// waits of a cycle.
pub(crate) fn standing(model: &Model, simulation: &Simulation) -> Power {
    let waits = simulation.events.iter().filter_map(|event| match &event.what {
        What::Wait(wait) => Some(holding_w(model, &wait.load, &wait.q).iter().sum::<f64>()),
        _ => None,
    });
    let holding: Vec<f64> = waits.collect();
    Power {
        base_w: base(model, 1.0).energy_j(),
        hold_w: holding.iter().sum::<f64>() / holding.len().max(1) as f64,
        brakes_after_s: NEVER_S,
    }
}

/// The cycle of a program as steps of the plant: a movement for each run from rest to rest, with its
/// energy beyond the power of standing.
pub(crate) fn script(
    model: &Model,
    files: &[Source],
    simulation: &Simulation,
    standing: Power,
) -> Script {
    let energies: Account = account(model, simulation);
    let place = |span: joulepath::rapid::text::Span| {
        let source = &files[span.file.0 as usize];
        (source.relative.clone(), source.file.position(span.start).line as usize)
    };
    let first = simulation.repeats_from.unwrap_or(0);
    let events = simulation.events.iter().zip(&energies.events).skip(first);
    let steps = events.filter_map(|(event, parts)| {
        Some(match &event.what {
            What::Run(run) => {
                let (file, line) = place(run.moves.last()?.movement.span);
                let all: f64 = parts.iter().map(EnergyParts::energy_j).sum();
                let energy_j = all - (standing.base_w + standing.hold_w) * event.duration;
                Step::Move { file, line, duration_s: event.duration, energy_j, stops: true }
            }
            What::Wait(record) => {
                let (file, line) = place(record.wait.span);
                match (&record.wait.signal, record.wait.duration) {
                    (Some(signal), None) => Step::Wait { file, line, signal: signal.to_string() },
                    _ => Step::Pause { file, line, seconds: event.duration },
                }
            }
            What::Output(output, _) => {
                let (file, line) = place(output.span);
                let level = u8::from(&*output.value == "1");
                Step::Output { file, line, signal: output.signal.to_string(), level }
            }
            What::Left(_) => return None,
        })
    });
    Script::single(steps.collect())
}

/// The steps of the original with the durations and energies of another program's movements. `None` if it has
/// more or fewer: a wait reached its time limit, which the plant does not simulate.
pub(crate) fn retimed(original: &Script, other: &Script) -> Option<Script> {
    let mut changed = original.clone();
    let new: Vec<(f64, f64)> = moves(other);
    if moves(original).len() != new.len() {
        return None;
    }
    let mut new = new.into_iter();
    for step in &mut changed.variants[0].steps {
        if let Step::Move { duration_s, energy_j, .. } = step
            && let Some(of) = new.next()
        {
            (*duration_s, *energy_j) = of;
        }
    }
    Some(changed)
}

fn moves(script: &Script) -> Vec<(f64, f64)> {
    let steps = script.variants[0].steps.iter();
    let timed = steps.filter_map(|step| match step {
        Step::Move { duration_s, energy_j, .. } => Some((*duration_s, *energy_j)),
        _ => None,
    });
    timed.collect()
}
