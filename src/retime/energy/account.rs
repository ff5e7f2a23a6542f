//! The energy of a simulation per movement and per wait.

use std::sync::Arc;

use rayon::prelude::*;

use super::parts::EnergyParts;
use super::power::{holding_w, motion_energy};
use crate::arm::dynamics::Load;
use crate::arm::robot::Model;
use crate::retime::motion::memo::{Memo, key};
use crate::retime::motion::timeline::{Event, Run, Simulation, What};
use crate::retime::path::joint_path::Joints;

/// Energies of runs that are kept at least.
const KEPT: usize = 10_000;

/// Energies of a simulation.
#[derive(Clone, Debug)]
pub struct Account {
    /// Sum over all events.
    pub total: EnergyParts,
    /// Per event and, within a run, per movement (other events have one entry).
    pub events: Vec<Vec<EnergyParts>>,
}

/// The energies of the last runs of a robot.
#[derive(Debug)]
pub struct Energies {
    model: Model,
    kept: Memo<Arc<Vec<EnergyParts>>>,
}

impl Energies {
    /// No energies.
    #[must_use]
    pub fn new(model: &Model) -> Energies {
        Energies { model: model.clone(), kept: Memo::new(KEPT) }
    }

    /// Whether they are those of a robot.
    pub fn is_of(&self, model: &Model) -> bool {
        self.model == *model
    }

    /// The energy of every event with the robot. That of a run with a key is not computed again where it
    /// is known.
    pub fn account(&self, simulation: &Simulation) -> Account {
        summed(&self.model, simulation, |run| match run.key {
            Some(of) => {
                let of = key(&(of, run.settling));
                (*self.kept.get_or(of, || Arc::new(run_energy(&self.model, run)))).clone()
            }
            None => run_energy(&self.model, run),
        })
    }
}

/// The energy of every event.
pub fn account(model: &Model, simulation: &Simulation) -> Account {
    summed(model, simulation, |run| run_energy(model, run))
}

fn summed(
    model: &Model,
    simulation: &Simulation,
    run_energy: impl Fn(&Run) -> Vec<EnergyParts> + Sync,
) -> Account {
    let event = |event: &Event| match &event.what {
        What::Run(run) => run_energy(run),
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
