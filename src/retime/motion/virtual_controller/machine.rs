//! The interface of the controller to the program executor.

use nalgebra::Isometry3;

use super::draft::{Draft, WaitDraft};
use super::load::{gripped, gripping};
use super::state::{Pending, VirtualController};
use crate::arm::dynamics::Load;
use crate::arm::kinematics::fk;
use crate::rapid::ir::exec::{Machine, WaitResult};
use crate::rapid::ir::movement::{Movement, Output, Unresolved, Wait};
use crate::retime::path::joint_path::Joints;

impl Machine for VirtualController<'_> {
    fn on_movement(&mut self, movement: Result<Movement, Unresolved>) {
        self.moves += 1;
        let movement = match movement {
            Ok(movement) => movement,
            Err(unresolved) => {
                self.flush();
                if unresolved.moves {
                    self.keep(Draft::Left(unresolved));
                }
                return;
            }
        };
        self.begin(&movement);
        match self.leg(&movement) {
            Ok(leg) => {
                self.q = leg.end;
                self.tool = Some(gripping(&movement));
                let fine = leg.zone.fine;
                self.pending_s += self.time_at_speed(&leg, &movement);
                self.pending.push(Pending { movement, leg });
                if fine {
                    self.flush();
                } else {
                    self.flush_if_late();
                }
            }
            Err(reason) => {
                self.flush();
                self.note(movement.span, &reason);
                let left = Unresolved { span: movement.span, reason, moves: true };
                self.keep(Draft::Left(left));
            }
        }
    }

    fn on_wait(&mut self, wait: Wait) -> WaitResult {
        self.flush();
        let may_time_out = wait.max_time.is_some() && self.input_at(&wait).is_some();
        let load = self
            .tool
            .as_ref()
            .map_or_else(Load::none, |tool| gripped(tool, wait.grip_load.as_ref()));
        self.keep(Draft::Wait(Box::new(WaitDraft { wait, q: self.q, load })));
        if !may_time_out {
            return WaitResult::Ended;
        }
        self.lay_out();
        self.waited_last
    }

    fn on_output(&mut self, output: Output) {
        // Fly-by movements continue during the output; its position in the order is kept.
        let position = self.pending.len();
        self.keep(Draft::Output(output, position));
    }

    fn joints(&mut self) -> Option<Joints> {
        if !self.pending.is_empty() {
            return None;
        }
        self.lay_out();
        self.certain.then_some(self.q)
    }

    fn flange(&self, q: &Joints) -> Option<Isometry3<f64>> {
        Some(self.model.kinematics.base * fk(self.model, q))
    }

    fn override_percent(&self) -> f64 {
        100.0 * self.options.speed_override.unwrap_or(1.0)
    }

    fn robot_type(&self) -> Option<String> {
        Some(self.model.type_name().to_owned())
    }

    fn on_endless_loop(&mut self) {
        // The pending movements become the next event, and their end belongs to the loop.
        self.repeats_from.get_or_insert(self.events.len() + self.drafts.len());
    }

    fn on_loop_left(&mut self) {
        self.repeats_from = None;
    }

    fn input_has_changed(&mut self, signal: &str) -> Option<bool> {
        let key = signal.to_lowercase();
        let at = self.input_change_time(signal)?;
        let come = self.time + self.pending_s >= at;
        if come {
            self.waited.insert(key, at);
        }
        Some(come)
    }

    fn input_change_time(&mut self, signal: &str) -> Option<f64> {
        let key = signal.to_lowercase();
        let delay = self.options.inputs.get(&key).copied();
        self.asked.insert(key.clone());
        let delay = delay?;
        self.lay_out();
        Some(self.waited.get(&key).copied().unwrap_or(0.0) + delay)
    }

    fn endless_loop_passes(&self) -> u32 {
        self.options.passes.unwrap_or(1)
    }

    fn stated_level(&self, signal: &str) -> Option<f64> {
        self.options.levels.get(signal).copied()
    }

    fn is_at_limit(&self) -> bool {
        self.is_too_large() || self.late
    }
}
