//! How near a simulated cycle comes to singularities and keep-outs.

use crate::arm::kinematics::{Capsule, Obstacle, singularity};
use crate::arm::robot::Model;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Run, What};
use crate::retime::optimize::freedom::Freedom;
use crate::retime::optimize::keep_out::around;
use crate::retime::path::LegKind;

/// Time between two looked-at positions, s.
const STEP_S: f64 = 0.004;
/// |sin q5| that a line or arc may always have: 5°.
const WRIST: f64 = 0.0872;
/// |sin| of the elbow's angle that a line or arc may always have: 5°.
const ELBOW: f64 = 0.0872;
/// Distance of the wrist centre from axis 1 that a line or arc may always have, m.
const SHOULDER_M: f64 = 0.05;

/// The least distances of a cycle. Infinite where nothing is near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// |sin q5| on lines and arcs: axes 4 and 6 are collinear at 0.
    pub wrist: f64,
    /// |sin| of the elbow's angle on lines and arcs.
    pub elbow: f64,
    /// Distance of the wrist centre from axis 1 on lines and arcs, m.
    pub shoulder_m: f64,
    /// A lower bound of the clearance of arm and tool to the keep-outs, m.
    pub clearance_m: f64,
}

impl Room {
    /// The distances of a simulated cycle. `obstacles` are in the robot's base frame.
    pub(super) fn of(model: &Model, simulation: &Simulation, obstacles: &[Obstacle]) -> Room {
        let none = f64::INFINITY;
        let mut room = Room { wrist: none, elbow: none, shoulder_m: none, clearance_m: none };
        let runs = simulation.events.iter().filter_map(|event| match &event.what {
            What::Run(run) => Some(run),
            _ => None,
        });
        for run in runs {
            room.singularities(model, run);
            if !obstacles.is_empty() {
                room.clearance(model, run, obstacles);
            }
        }
        room
    }

    fn singularities(&mut self, model: &Model, run: &Run) {
        for (record, leg) in run.moves.iter().zip(&run.legs) {
            if matches!(leg.kind, LegKind::Joint) {
                continue;
            }
            for t in times(record.t_start, record.duration) {
                let Some(near) = singularity(model, &run.at(t).q) else { return };
                self.wrist = self.wrist.min(near.wrist);
                self.elbow = self.elbow.min(near.elbow);
                self.shoulder_m = self.shoulder_m.min(near.shoulder);
            }
        }
    }

    /// The clearance at each position, less what the arm may move until the next one.
    fn clearance(&mut self, model: &Model, run: &Run, obstacles: &[Obstacle]) {
        let freedom = Freedom { keep_out: obstacles.to_vec(), ..Freedom::default() };
        let Some(body) = run.legs.first().and_then(|leg| around(model, &leg.tool, &freedom)) else {
            return;
        };
        let reach: f64 = body.capsules(&run.start).iter().map(Capsule::length).sum();
        for t in times(0.0, run.duration()) {
            let state = run.at(t);
            let turning: f64 =
                model.kinematics.to_serial(&state.qd).iter().map(|rate| rate.abs()).sum();
            let between = 0.5 * STEP_S * reach * turning;
            self.clearance_m = self.clearance_m.min(body.margins(&state.q)[0] - between);
        }
    }

    /// Whether lines and arcs keep their distance from singularities: the usual one, or that of today.
    pub(super) fn is_regular(&self, today: &Room) -> bool {
        self.wrist >= today.wrist.min(WRIST)
            && self.elbow >= today.elbow.min(ELBOW)
            && self.shoulder_m >= today.shoulder_m.min(SHOULDER_M)
    }

    /// Whether arm and tool stay out of the keep-outs, or as far in as today.
    pub(super) fn is_clear(&self, today: &Room) -> bool {
        self.clearance_m >= today.clearance_m.min(0.0)
    }
}

/// Times in a stretch, s, both ends included.
fn times(start: f64, duration: f64) -> impl Iterator<Item = f64> {
    let count = (duration / STEP_S).ceil().max(1.0) as usize;
    (0..=count).map(move |i| start + duration * i as f64 / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_keep_the_usual_distance_or_that_of_today() {
        let far = Room { wrist: 0.5, elbow: 0.5, shoulder_m: 0.4, clearance_m: 0.1 };
        assert!(far.is_regular(&far) && far.is_clear(&far));
        for near in [
            Room { wrist: 0.05, ..far },
            Room { elbow: 0.05, ..far },
            Room { shoulder_m: 0.03, ..far },
        ] {
            assert!(!near.is_regular(&far), "{near:?}");
            assert!(near.is_regular(&near), "as today: {near:?}");
            assert!(far.is_regular(&near));
        }
        let inside = Room { clearance_m: -0.02, ..far };
        assert!(!inside.is_clear(&far) && inside.is_clear(&inside));
    }
}
