//! `PathAccLim` and `WorldAccLim` on the averaged motion.
//!
//! The average preserves bounds of the joints but not of the TCP, whose position is not linear in
//! them: sampling the averaged motion finds the excess in corners.

use super::sampling::SpeedCap;
use super::timed::TimedMotion;
use crate::arm::robot::Model;
use crate::retime::path::JointPath;

/// Longest step between two samples, s.
const STEP: f64 = 0.002;
/// Where the TCP turns back, its acceleration along the path has steps: at speeds that the lower limit
/// reaches within this time, s, the mean change of speed over twice this time counts.
const HALF_SPAN: f64 = 0.01;

/// True if a leg has a limit on the TCP acceleration.
pub(super) fn limited(caps: &[SpeedCap]) -> bool {
    caps.iter().any(|cap| {
        cap.world_acceleration.is_finite() || cap.path_acceleration.iter().any(|x| x.is_finite())
    })
}

/// The largest used share of these limits on each leg.
pub(super) fn worst(
    model: &Model,
    path: &JointPath,
    caps: &[SpeedCap],
    motion: &TimedMotion,
) -> Vec<f64> {
    let mut begin = 0.0;
    let leg_worst = |leg: usize| {
        let end = motion.time_at(path.leg_end(leg));
        let tool = path.extent(leg).tool;
        let [up, down] = caps[leg].path_acceleration;
        let speed = |time: f64| {
            let state = motion.at(time);
            let twist = tool.jacobian(model, &state.q) * nalgebra::Vector6::from(state.qd);
            twist.fixed_rows::<3>(0).norm()
        };
        let steps = ((end - begin) / STEP).ceil().max(1.0);
        let mut worst: f64 = 0.0;
        for i in 0..=steps as usize {
            let time = begin + (end - begin) * i as f64 / steps;
            let state = motion.at(time);
            let qd = nalgebra::Vector6::from(state.qd);
            let jacobian = tool.jacobian(model, &state.q);
            let a = jacobian * nalgebra::Vector6::from(state.qdd)
                + tool.jacobian_dot(model, &state.q, &state.qd) * qd;
            let a = a.fixed_rows::<3>(0);
            worst = worst.max(a.norm() / caps[leg].world_acceleration);
            let v = (jacobian * qd).fixed_rows::<3>(0).into_owned();
            let along = if v.norm() > HALF_SPAN * up.min(down) {
                a.dot(&v) / v.norm()
            } else {
                let [from, to] = [(time - HALF_SPAN).max(begin), (time + HALF_SPAN).min(end)];
                if to > from { (speed(to) - speed(from)) / (to - from) } else { 0.0 }
            };
            worst = worst.max(along / up).max(-along / down);
        }
        begin = end;
        worst
    };
    path.legs().map(leg_worst).collect()
}
