//! The robot of a run as a [`Plant`] for stream polishing.

use super::keep_out;
use super::margins::Margins;
use super::plant::{LEAST_STEPS, PathShares, Plant};
use super::robot_plant::{smooth_torque, smooth_torque_derivatives};
use super::run_problem::RunProblem;
use super::smoothed::Smoothed;
use crate::arm::kinematics::fk;
use crate::retime::motion::stream::Piece;
use crate::retime::path::joint_path::{DOF, Joints};

/// Longest TCP distance between two samples of a motion, m: the speed ceilings have steps.
pub(super) const LONGEST_STEP: f64 = 0.004;

/// The loaded robot with the margins of an attempt.
pub(super) struct RunPlant<'a> {
    pub(super) problem: &'a RunProblem<'a>,
    pub(super) margins: &'a Margins,
    /// Limits along the corridor.
    pub(super) smoothed: Smoothed,
}

impl Plant for RunPlant<'_> {
    fn torque(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
        let task = self.problem.task;
        smooth_torque(task.model, &task.run.load, q, qd, qdd)
    }

    fn torque_derivatives(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> [[Joints; DOF]; 3] {
        let task = self.problem.task;
        smooth_torque_derivatives(task.model, &task.run.load, q, qd, qdd)
    }

    fn dry_friction(&self) -> Joints {
        std::array::from_fn(|j| self.problem.task.model.friction.coulomb[j])
    }

    fn torque_limit(&self) -> Joints {
        self.problem.corridor.ceilings.loads.torque.map(|x| x * self.margins.torque())
    }

    fn steps(&self, piece: &Piece) -> usize {
        let speed = |qd: &Joints| -> f64 {
            let tcp = self.problem.lever.iter().zip(qd).map(|(lever, v)| (lever * v).powi(2));
            tcp.sum::<f64>().sqrt()
        };
        let way = speed(&piece.qd).max(speed(&piece.at(piece.length).1)) * piece.length;
        LEAST_STEPS.max(2 * (0.5 * way / LONGEST_STEP).ceil() as usize)
    }

    fn path_shares(&self, q: &Joints, qd: &Joints, place: &mut usize) -> PathShares {
        let task = self.problem.task;
        let tool = &task.run.legs[0].tool;
        let pose = tool.pose(&fk(task.model, q));
        let at = self.problem.corridor.locate(&pose, place);
        let speed = tool.twist(task.model, q, qd).fixed_rows::<3>(0).norm();
        let [tcp, joints, distance] = self.smoothed.shares(&at, speed, qd);
        let body = self.problem.body.as_ref();
        let near = body.map_or(0.0, |body| keep_out::share(body, q, self.margins.room));
        let speeds = [tcp, joints].map(|share| share / self.margins.speed);
        [speeds[0], speeds[1], distance / self.margins.distance, near]
    }

    fn polygon_share(&self, q: &Joints, place: &mut usize) -> f64 {
        let task = self.problem.task;
        let pose = task.run.legs[0].tool.pose(&fk(task.model, q));
        let distance = self.smoothed.polygon_share(&self.problem.corridor.locate(&pose, place));
        let body = self.problem.body.as_ref();
        let near = body.map_or(0.0, |body| keep_out::share(body, q, self.margins.room));
        near.max(distance / self.margins.edges)
    }
}
