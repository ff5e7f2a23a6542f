//! Plays back a stream from its points and times alone.

use joulepath::arm::dynamics::{Data, torque};
use joulepath::retime::motion::stream::Stream;
use joulepath::retime::path::joint_path::{DOF, Joints};

use crate::cases::Case;

/// Step of the samples, s.
const STEP: f64 = 5e-4;
/// Speed that counts as zero, rad/s.
const STILL: f64 = 1e-9;

/// Knots: the midpoints of the intervals; in the first and the last one at two thirds of the
/// interval from rest.
fn knots(d: &[f64]) -> Vec<f64> {
    let n = d.len();
    let mut ends = vec![0.0];
    for x in d {
        ends.push(ends[ends.len() - 1] + x);
    }
    let total = ends[n];
    let inner = (0..n).map(|i| match i {
        _ if n == 1 => 0.5 * total,
        0 => ends[0] + d[0] * 2.0 / 3.0,
        i if i + 1 == n => total - d[i] * 2.0 / 3.0,
        i => 0.5 * (ends[i] + ends[i + 1]),
    });
    std::iter::once(0.0).chain(inner).chain([total]).collect()
}

/// The largest ratio to a limit, and the name of that limit.
pub(crate) fn worst(case: &Case, stream: &Stream) -> (f64, &'static str) {
    let (model, load) = (&case.model, &case.run().load);
    let t = knots(stream.intervals());
    let n = stream.points().len();
    let control = |i: usize| if i == 0 { *stream.start() } else { stream.points()[i - 1] };
    let velocity = |i: usize| -> Joints {
        if i == 0 || i == n + 1 {
            return [0.0; DOF];
        }
        let mean = 0.5 * (t[i + 1] - t[i - 1]);
        std::array::from_fn(|j| (control(i)[j] - control(i - 1)[j]) / mean)
    };
    let limit = |list: &Option<Vec<f64>>, j: usize| list.as_ref().map_or(f64::INFINITY, |l| l[j]);
    let limits = &model.limits;
    let mut data = Data::new();
    let mut worst = (0.0, "");
    let mut see = |share: f64, what: &'static str| {
        if share > worst.0 {
            worst = (share, what);
        }
    };
    let mut q = control(0);
    for i in 0..=n {
        let (h, from, to) = (t[i + 1] - t[i], velocity(i), velocity(i + 1));
        let qdd: Joints = std::array::from_fn(|j| (to[j] - from[j]) / h);
        let steps = (h / STEP).ceil() as usize;
        for k in 0..=steps {
            let tau = h * k as f64 / steps as f64;
            // At rest the spline has a rounding error of the speed, without a direction.
            let qd: Joints = std::array::from_fn(|j| {
                let speed = from[j] + tau * qdd[j];
                if speed.abs() < STILL { 0.0 } else { speed }
            });
            let here: Joints = std::array::from_fn(|j| q[j] + tau * (from[j] + 0.5 * tau * qdd[j]));
            let load = torque(model, &mut data, load, &here, &qd, &qdd);
            for j in 0..DOF {
                see(qd[j].abs() / limit(&limits.velocity, j), "velocity");
                see(qdd[j].abs() / limit(&limits.acceleration, j), "acceleration");
                let tau = load.rigid[j] + load.friction[j];
                see(tau.abs() / limit(&limits.torque, j), "torque");
                let [lo, hi] = limits.position[j];
                see(if here[j] < lo || here[j] > hi { 2.0 } else { 0.0 }, "position");
            }
        }
        q = std::array::from_fn(|j| q[j] + 0.5 * h * (from[j] + to[j]));
    }
    let end = case.run().end;
    let missed = (0..DOF).map(|j| (q[j] - end[j]).abs()).fold(0.0, f64::max);
    see(missed / 1e-5, "distance from the end");
    worst
}
