//! Whether a robot reaches the targets of a program, without planning its motion.

use nalgebra::Isometry3;

use super::options::Options;
use super::state::VirtualController;
use crate::arm::robot::Model;
use crate::rapid::ir::exec::{Machine, WaitResult, execute};
use crate::rapid::ir::movement::{Movement, Output, Unresolved, Wait};
use crate::rapid::ir::program::{Program, RoutineId};
use crate::retime::path::joint_path::Joints;
use crate::retime::path::leg::first_difference;
use crate::retime::path::{LegKind, arrival};

/// The number of movements whose target, or whose line or arc at some points, is out of reach in the
/// programmed configuration. A program without such movements may still fail in a simulation, which
/// follows every line closely.
pub fn unreached(program: &Program, entry: RoutineId, model: &Model, options: &Options) -> usize {
    let controller = VirtualController::new(model, options);
    let mut machine = Reach { controller, certain: true, count: 0 };
    execute(program, entry, &mut machine);
    machine.count
}

struct Reach<'a> {
    controller: VirtualController<'a>,
    /// False after a movement whose end is not known.
    certain: bool,
    count: usize,
}

impl Machine for Reach<'_> {
    fn on_movement(&mut self, movement: Result<Movement, Unresolved>) {
        self.controller.moves += 1;
        let movement = match movement {
            Ok(movement) => movement,
            Err(unresolved) => {
                self.certain &= !unresolved.moves;
                return;
            }
        };
        self.controller.begin(&movement);
        let Ok(leg) = self.controller.leg(&movement) else {
            self.count += 1;
            self.certain = false;
            return;
        };
        let is_checked = self.certain && !leg.axiswise && !matches!(leg.kind, LegKind::Joint);
        let arrives = || {
            let end = arrival(self.controller.model, &leg);
            end.is_some_and(|end| first_difference(&end, &leg.end).is_none())
        };
        if is_checked && !arrives() {
            self.count += 1;
        }
        self.certain = true;
        self.controller.q = leg.end;
    }

    fn on_wait(&mut self, _: Wait) -> WaitResult {
        WaitResult::Ended
    }

    fn on_output(&mut self, _: Output) {}

    fn joints(&mut self) -> Option<Joints> {
        self.certain.then_some(self.controller.q)
    }

    fn flange(&self, q: &Joints) -> Option<Isometry3<f64>> {
        self.controller.flange(q)
    }

    fn override_percent(&self) -> f64 {
        self.controller.override_percent()
    }

    fn robot_type(&self) -> Option<String> {
        self.controller.robot_type()
    }

    fn endless_loop_passes(&self) -> u32 {
        self.controller.endless_loop_passes()
    }

    fn stated_level(&self, signal: &str) -> Option<f64> {
        self.controller.stated_level(signal)
    }

    fn is_at_limit(&self) -> bool {
        self.controller.is_too_large()
    }
}
