//! The robot of a run as a [`Plant`] for stream polishing.

use nalgebra::{Isometry3, SMatrix, SVector};

use super::keep_out;
use super::margins::Margins;
use super::plant::{DIFFERENCES, LEAST_STEPS, PathDerivatives, PathShares, Plant};
use super::robot_plant::{smooth_torque, smooth_torque_derivatives};
use super::run_problem::RunProblem;
use super::smoothed::Smoothed;
use crate::arm::kinematics::{Tcp, fk};
use crate::arm::robot::Model;
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
        let (pose, tool, model) = self.tcp(q);
        let at = self.problem.corridor.locate(&pose, place);
        let speed = tool.twist(model, q, qd).fixed_rows::<3>(0).norm();
        let [tcp, joints, distance] = self.smoothed.shares(&at, speed, qd);
        let speeds = [tcp, joints].map(|share| share / self.margins.speed);
        [speeds[0], speeds[1], distance / self.margins.distance, self.near(q)]
    }

    fn path_derivatives(&self, q: &Joints, qd: &Joints, mut place: usize) -> PathDerivatives {
        let (pose, tool, model) = self.tcp(q);
        let at = self.problem.corridor.locate(&pose, &mut place);
        let slopes = self.problem.corridor.slopes(&at, &pose, &tool.jacobian(model, q));
        let speed = tcp_speed(model, tool, q, qd);
        let [tcp, joints, distance] = self.smoothed.derivatives(&at, &slopes, speed, qd);
        let per = |by: [Joints; 2], margin: f64| by.map(|by| by.map(|slope| slope / margin));
        let margins = self.margins;
        [
            per(tcp, margins.speed),
            per(joints, margins.speed),
            per(distance, margins.distance),
            [self.near_derivatives(q), [0.0; DOF]],
        ]
    }

    fn polygon_share(&self, q: &Joints, place: &mut usize) -> f64 {
        let at = self.problem.corridor.locate(&self.tcp(q).0, place);
        self.near(q).max(self.smoothed.polygon_share(&at) / self.margins.edges)
    }

    fn polygon_derivatives(&self, q: &Joints, mut place: usize) -> Joints {
        let (pose, tool, model) = self.tcp(q);
        let at = self.problem.corridor.locate(&pose, &mut place);
        if self.near(q) > self.smoothed.polygon_share(&at) / self.margins.edges {
            return self.near_derivatives(q);
        }
        let slopes = self.problem.corridor.slopes(&at, &pose, &tool.jacobian(model, q));
        let slopes = self.smoothed.polygon_derivatives(&at, &slopes);
        slopes.map(|slope| slope / self.margins.edges)
    }
}

impl RunPlant<'_> {
    /// The pose of the TCP, with tool and model.
    fn tcp(&self, q: &Joints) -> (Isometry3<f64>, &Tcp, &Model) {
        let task = self.problem.task;
        let tool = &task.run.legs[0].tool;
        (tool.pose(&fk(task.model, q)), tool, task.model)
    }

    /// The clearance to the keep-out zones as a share of a limit; 0 without zones.
    fn near(&self, q: &Joints) -> f64 {
        let body = self.problem.body.as_ref();
        body.map_or(0.0, |body| keep_out::share(body, q, self.margins.room))
    }

    /// Its derivatives, 1/rad, by differences.
    fn near_derivatives(&self, q: &Joints) -> Joints {
        if self.problem.body.is_none() {
            return [0.0; DOF];
        }
        let here = self.near(q);
        std::array::from_fn(|j| {
            let mut next = *q;
            next[j] += DIFFERENCES[0];
            (self.near(&next) - here) / DIFFERENCES[0]
        })
    }
}

/// The TCP speed (m/s) with its derivatives by the joint angles and the joint speeds. The velocity is
/// J q̇; since J is the derivative of the position by q, that of the velocity is J̇.
fn tcp_speed(model: &Model, tool: &Tcp, q: &Joints, qd: &Joints) -> (f64, [Joints; 2]) {
    let jacobian = tool.jacobian(model, q);
    let rate = tool.jacobian_dot(model, q, qd);
    let velocity = (jacobian * SVector::from(*qd)).fixed_rows::<3>(0).into_owned();
    let speed = velocity.norm();
    let ahead = if speed > 0.0 { velocity / speed } else { velocity };
    let along = |matrix: SMatrix<f64, 6, DOF>| {
        std::array::from_fn(|j| matrix.fixed_view::<3, 1>(0, j).dot(&ahead))
    };
    (speed, [along(rate), along(jacobian)])
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use nalgebra::{Translation3, UnitQuaternion};

    use super::*;
    use crate::arm::robot::find;
    use crate::retime::optimize::corridor::tests::along;
    use crate::retime::optimize::smoothed::Located;

    /// Step of central differences, rad or rad/s, and their relative tolerance.
    const STEP: f64 = 1e-6;
    const CLOSE: f64 = 1e-5;

    /// The derivatives of f by q and by q̇, by central differences.
    fn differences(q: &Joints, qd: &Joints, f: impl Fn(&Joints, &Joints) -> f64) -> [Joints; 2] {
        std::array::from_fn(|kind| {
            std::array::from_fn(|j| {
                let at = |step: f64| {
                    let mut state = [*q, *qd];
                    state[kind][j] += step;
                    f(&state[0], &state[1])
                };
                (at(STEP) - at(-STEP)) / (2.0 * STEP)
            })
        })
    }

    fn assert_near(what: &str, by: [Joints; 2], expected: [Joints; 2]) {
        let scale = 1.0 + expected.as_flattened().iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (by, expected) in by.as_flattened().iter().zip(expected.as_flattened()) {
            let error = (by - expected).abs() / scale;
            assert!(error < CLOSE, "{what}: {by} instead of {expected}");
        }
    }

    #[test]
    fn derivatives_along_a_corridor_are_the_limits_of_differences() {
        let model = find("IRB1600-10/1.45").unwrap();
        let frame = Isometry3::from_parts(
            Translation3::new(0.1, -0.05, 0.2),
            UnitQuaternion::from_euler_angles(0.3, -0.5, 0.8),
        );
        let ends = [[0.2, 0.4, -0.3, 0.7, 0.9, -0.4], [0.25, 0.38, -0.25, 0.8, 0.8, -0.1]];
        let qd = [0.8, -0.5, 1.1, 2.0, -1.4, 0.6];
        let stationary = Isometry3::from_parts(Translation3::new(0.9, 0.2, 0.6), frame.rotation);
        for tool in [Tcp::Held(frame), Tcp::Stationary(stationary)] {
            let (corridor, smoothed) = along(&model, &tool, &ends);
            // Beside the path, between two of its places.
            let q: Joints = std::array::from_fn(|j| {
                0.45 * ends[0][j] + 0.55 * ends[1][j] + 1e-3 * [1.0, -1.0, 0.5, 2.0, -1.0, 3.0][j]
            });
            let locate = |q: &Joints| corridor.locate(&tool.pose(&fk(&model, q)), &mut 20);
            let at = locate(&q);
            assert!(at.share > 0.0 && at.share < 1.0 && at.distance > 1e-4, "{at:?}");
            let pose = tool.pose(&fk(&model, &q));
            let slopes = corridor.slopes(&at, &pose, &tool.jacobian(&model, &q));
            let rest = [0.0; DOF];
            for (what, by, of) in [
                ("distance", slopes.distance, (|at| at.distance) as fn(&Located) -> f64),
                ("share", slopes.share, |at| at.share),
            ] {
                assert_near(what, [by, rest], differences(&q, &qd, |q, _| of(&locate(q))));
            }
            let speed = tcp_speed(&model, &tool, &q, &qd);
            let of_speed = |q: &Joints, qd: &Joints| tcp_speed(&model, &tool, q, qd).0;
            assert_near("speed", speed.1, differences(&q, &qd, of_speed));
            let shares = |q: &Joints, qd: &Joints| smoothed.shares(&locate(q), of_speed(q, qd), qd);
            for (i, by) in smoothed.derivatives(&at, &slopes, speed, &qd).into_iter().enumerate() {
                assert_near("a share", by, differences(&q, &qd, |q, qd| shares(q, qd)[i]));
            }
            let polygon = |q: &Joints, _: &Joints| smoothed.polygon_share(&locate(q));
            let by = [smoothed.polygon_derivatives(&at, &slopes), rest];
            assert_near("the polygon", by, differences(&q, &qd, polygon));
        }
    }
}
