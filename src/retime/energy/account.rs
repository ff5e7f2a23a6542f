//! The energy of a simulation per movement and per wait.

use rayon::prelude::*;

use super::parts::EnergyParts;
use super::power::{holding_w, motion_energy};
use crate::arm::dynamics::Load;
use crate::arm::robot::Model;
use crate::retime::motion::timeline::{Event, Run, Simulation, What};
use crate::retime::path::joint_path::Joints;

/// Energies of a simulation.
#[derive(Clone, Debug)]
pub struct Account {
    /// Sum over all events.
    pub total: EnergyParts,
    /// Per event and, within a run, per movement (other events have one entry).
    pub events: Vec<Vec<EnergyParts>>,
}

/// The energy of every event.
pub fn account(model: &Model, simulation: &Simulation) -> Account {
    let event = |event: &Event| match &event.what {
        What::Run(run) => run_energy(model, run),
        What::Wait(wait) => vec![at_rest(model, &wait.load, &wait.q, event.duration)],
        What::Output(..) | What::Left(_) => vec![EnergyParts::default()],
    };
    let events: Vec<Vec<EnergyParts>> = simulation.events.par_iter().map(event).collect();
    let mut total = EnergyParts::default();
    for part in events.iter().flatten() {
        total += *part;
    }
    Account { total, events }
}

/// The energy of a run per movement.
pub fn run_energy(model: &Model, run: &Run) -> Vec<EnergyParts> {
    let last = run.moves.len().saturating_sub(1);
    let moves = run.moves.par_iter().enumerate().map(|(i, record)| {
        let rest = if i == last { run.settling } else { 0.0 };
        let from = record.t_start;
        let to = record.t_start + record.duration - rest;
        let mut part = base(model, to - from);
        for (begin, motion) in run.motions_between(from, to) {
            let (a, b) = ((from - begin).max(0.0), (to - begin).min(motion.duration()));
            if b > a {
                part += motion_energy(model, &run.load, motion, a, b);
            }
        }
        if rest > 0.0 {
            part += at_rest(model, &run.load, &run.end, rest);
        }
        part
    });
    moves.collect()
}

/// Energy of a robot at rest with released brakes.
pub fn at_rest(model: &Model, load: &Load, q: &Joints, duration: f64) -> EnergyParts {
    let holding: f64 = holding_w(model, load, q).iter().sum();
    let mut parts = base(model, duration);
    parts.idle_j += holding * duration;
    parts
}

/// Energy of base power and released brakes.
pub fn base(model: &Model, duration: f64) -> EnergyParts {
    EnergyParts {
        idle_j: model.drive.base_w * duration,
        brake_j: model.brakes.as_ref().map_or(0.0, |b| b.power_released_w) * duration,
        ..EnergyParts::default()
    }
}
