//! Limits on the length of a simulation.

use super::state::VirtualController;
use crate::arm::kinematics::fk;
use crate::rapid::ir::movement::Movement;
use crate::retime::motion::run_plan::{Planned, RunDraft};
use crate::retime::motion::timeline::What;
use crate::retime::path::{Leg, LegKind};

/// Default time limit of a simulation, s: ten hours.
const MAX_TIME: f64 = 36_000.0;
/// Largest number of events of a simulation.
const MAX_EVENTS: usize = 200_000;
/// Largest number of movements of a simulation; their motions take memory.
const MAX_MOVES: usize = 50_000;
/// Smallest share to which zones shorten movements.
const SHORTEST: f64 = 0.5;

impl VirtualController<'_> {
    pub(super) fn max_time(&self) -> f64 {
        self.options.max_time.unwrap_or(MAX_TIME)
    }

    pub(super) fn is_too_large(&self) -> bool {
        let events = self.events.len() + self.drafts.len() + self.pending.len();
        self.moves > MAX_MOVES || events > MAX_EVENTS
    }

    /// Duration of a movement without acceleration, s.
    pub(super) fn time_at_speed(&self, leg: &Leg, movement: &Movement) -> f64 {
        if let Some(time) = self.timed(movement) {
            return time;
        }
        let before = leg.tool.pose(&fk(self.model, &leg.start));
        let way = match leg.kind {
            LegKind::Joint => 0.0,
            _ => (leg.target.translation.vector - before.translation.vector).norm(),
        };
        let joints = self.model.limits.velocity.iter().flatten();
        let turns = leg.start.iter().zip(&leg.end).zip(joints);
        let slowest = turns.map(|((a, b), speed)| (b - a).abs() / speed).fold(0.0, f64::max);
        slowest.max(way / leg.speed.tcp)
    }

    /// Ends the pending fly-by movements if they exceed the time limit even with shortening zones.
    pub(super) fn flush_if_late(&mut self) {
        if self.time + SHORTEST * self.pending_s > self.max_time() {
            self.flush();
            self.lay_out();
            self.late = true;
        }
    }

    /// The run up to the movement that exceeds the time limit; the robot stops after it.
    pub(super) fn up_to_time_limit(&mut self, run: RunDraft, plan: Planned) -> (RunDraft, Planned) {
        let left = self.max_time() - self.time;
        let mut t = 0.0;
        let late = plan.pieces.iter().position(|(duration, _)| {
            t += duration;
            t > left
        });
        let Some(late) = late else { return (run, plan) };
        self.late = true;
        if late + 1 == run.movements.len() {
            return (run, plan);
        }
        let run = run.truncated(late + 1);
        let plan = run.task.plan(self.model, None);
        (run, plan)
    }

    /// Notes the statement at which a limit ended the simulation.
    pub(super) fn note_limit(&mut self) {
        let reason = if self.late {
            format!(
                "the cycle lasts longer than {} s (--max-time): it is shown up to the end of this \
                 instruction, at {:.3} s",
                self.max_time(),
                self.time
            )
        } else if self.is_too_large() {
            format!(
                "more than {MAX_MOVES} movements or {MAX_EVENTS} stops, waits and outputs, as if \
                 the program did not end: the cycle is shown up to here (--max-time ends it earlier)"
            )
        } else {
            return;
        };
        let span = self.events.iter().rev().find_map(|event| match &event.what {
            What::Run(run) => run.moves.last().map(|record| record.movement.span),
            What::Wait(record) => Some(record.wait.span),
            What::Output(output, _) => Some(output.span),
            What::Left(left) => Some(left.span),
        });
        if let Some(span) = span {
            self.note(span, &reason);
        }
    }
}
