//! The input of the reports of a simulation.

use crate::arm::robot::Model;
use crate::rapid::text::Span;
use crate::retime::energy::plausible::Plausibility;
use crate::retime::energy::{Account, EnergyParts};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{MoveRecord, WaitBasis, What};

/// A simulated cycle and its energy.
#[derive(Clone, Copy)]
pub struct Simulated<'a> {
    /// The robot.
    pub model: &'a Model,
    /// The routine that starts the program.
    pub entry: &'a str,
    /// The cycle.
    pub simulation: &'a Simulation,
    /// Its energy.
    pub account: &'a Account,
    /// Intervals over plausible robots.
    pub plausible: Option<&'a Plausibility>,
}

/// A movement or a wait of the cycle.
pub(super) struct Step<'a> {
    pub(super) span: Span,
    pub(super) instruction: &'a str,
    pub(super) routine: &'a str,
    /// s from the start of the cycle.
    pub(super) t_start: f64,
    /// s.
    pub(super) duration: f64,
    pub(super) energy_j: f64,
    pub(super) kind: StepKind<'a>,
}

/// The kind of a step.
#[derive(Clone, Copy)]
pub(super) enum StepKind<'a> {
    Move(&'a MoveRecord),
    Wait(WaitBasis),
}

impl<'a> Simulated<'a> {
    /// The movements and waits of the cycle, in order.
    pub(super) fn steps(&self) -> Vec<Step<'a>> {
        let mut steps = Vec::new();
        for (event, parts) in self.simulation.events.iter().zip(&self.account.events) {
            let mut energies = parts.iter().map(EnergyParts::energy_j);
            match &event.what {
                What::Run(run) => {
                    steps.extend(run.moves.iter().zip(energies).map(|(record, energy_j)| Step {
                        span: record.movement.span,
                        instruction: &record.movement.instruction,
                        routine: &record.movement.routine,
                        t_start: event.t_start + record.t_start,
                        duration: record.duration,
                        energy_j,
                        kind: StepKind::Move(record),
                    }));
                }
                What::Wait(record) => steps.push(Step {
                    span: record.wait.span,
                    instruction: &record.wait.instruction,
                    routine: &record.wait.routine,
                    t_start: event.t_start,
                    duration: event.duration,
                    energy_j: energies.next().unwrap_or_default(),
                    kind: StepKind::Wait(record.basis),
                }),
                What::Output(..) | What::Left(_) => {}
            }
        }
        steps
    }
}
