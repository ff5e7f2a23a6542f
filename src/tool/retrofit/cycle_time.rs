//! The cycle as a model for the distribution of time among runs.

use super::job::Original;
use super::lowered::lateness;
use super::settings::Settings;
use crate::arm::dynamics::Load;
use crate::arm::robot::Model;
use crate::retime::energy::account::base;
use crate::retime::energy::power::holding_w;
use crate::retime::motion::Simulation;
use crate::retime::motion::arrivals::{Anchor, anchored};
use crate::retime::motion::timeline::{Event, WaitBasis, What};
use crate::retime::optimize::cycle::{Cycle, Part};
use crate::retime::optimize::resting::ways;
use crate::retime::path::joint_path::Joints;

/// The cycle as a sequence of parts; the rest of the takt (s) is spent at its end. Its energies are
/// without the power that is drawn at any time. Waits of known
/// arrival keep a margin: the lateness of the original under lower limits than assumed. `runs`: the
/// events of each run whose time is to be chosen.
pub(super) fn cycle(
    original: &Original<'_>,
    model: &Model,
    settings: &Settings,
    runs: &[&[usize]],
    takt: f64,
) -> Cycle {
    let simulation = &original.cycle.simulation;
    let mut parts: Vec<Part> =
        simulation.events.iter().map(|event| Part::Fixed(event.duration)).collect();
    for (run, events) in runs.iter().enumerate() {
        for event in *events {
            parts[*event] = Part::Run(run);
        }
    }
    let mut number = 0;
    for (index, event) in simulation.events.iter().enumerate() {
        let What::Wait(record) = &event.what else { continue };
        number += 1;
        let own = settings.options.arrivals.iter().find(|arrival| arrival.wait + 1 == number);
        if let Some(arrival) = own {
            let since = match arrival.after {
                Anchor::Own => continue,
                Anchor::Cycle => simulation.repeats_from.and_then(|first| first.checked_sub(1)),
                anchor => anchored(&simulation.events, anchor),
            };
            parts[index] = Part::Arrival {
                since,
                delay: arrival.delay_s,
                least: lateness(simulation, &original.lowered, since, index).min(event.duration),
                holding_w: holding_w(model, &record.load, &record.q).iter().sum(),
            };
            continue;
        }
        let Some(signal) = record.wait.signal.as_ref().map(|name| name.to_lowercase()) else {
            continue;
        };
        let delay = settings.options.inputs.get(&signal).copied();
        if let (WaitBasis::Input, Some(delay)) = (record.basis, delay) {
            let is_same = |event: &Event| match &event.what {
                What::Wait(other) => {
                    other.wait.signal.as_ref().is_some_and(|name| name.to_lowercase() == signal)
                }
                _ => false,
            };
            let since = simulation.events[..index].iter().rposition(is_same);
            parts[index] = Part::Arrival {
                since,
                delay,
                least: lateness(simulation, &original.lowered, since, index).min(event.duration),
                holding_w: holding_w(model, &record.load, &record.q).iter().sum(),
            };
        }
    }
    let holding = |(load, q): (&Load, &Joints)| holding_w(model, load, q).iter().sum();
    let (holding, base) = (original.cycle.end().map_or(0.0, holding), base_w(model));
    Cycle { parts, takt, resting: ways(base + holding, &settings.idle, base) }
}

/// Power that a robot with released brakes takes at any time, W.
pub(super) fn base_w(model: &Model) -> f64 {
    base(model, 1.0).energy_j()
}

/// Whether the cycle waits for an input whose time the user states.
pub(super) fn awaits_stated_input(simulation: &Simulation) -> bool {
    simulation.events.iter().any(|event| match &event.what {
        What::Wait(record) => record.basis == WaitBasis::Input && event.duration > 0.0,
        _ => false,
    })
}
