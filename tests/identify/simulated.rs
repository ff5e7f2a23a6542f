//! Logs of a known robot.

use joulepath::arm::dynamics::{Data, Load, torque};
use joulepath::arm::robot::Model;
use joulepath::learn::excite::Series;
use joulepath::learn::log::{Channel, Log};

use crate::excited::normal;

/// Content of a log.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum With {
    Rates,
    Positions,
}

/// A log of `duration` s with the interval `step` s; `noise` \[Nm\] with the correlation `memory`.
pub(crate) fn log(
    model: &Model,
    series: &Series,
    [duration, step]: [f64; 2],
    with: With,
    [noise, memory]: [f64; 2],
    random: &mut fastrand::Rng,
) -> Log {
    let n = model.dof;
    let count = (duration / step).round() as usize;
    let mut values = vec![Vec::with_capacity(count); 1 + 4 * n];
    let mut data = Data::new();
    let mut coloured = vec![0.0; n];
    let fresh = noise * (1.0 - memory * memory).sqrt();
    for row in 0..count {
        let t = step * row as f64;
        let [q, qd, qdd] = series.at(t);
        let parts = torque(model, &mut data, &Load::none(), &q[..n], &qd[..n], &qdd[..n]);
        values[0].push(t);
        for joint in 0..n {
            coloured[joint] = memory * coloured[joint] + fresh * normal(random);
            values[1 + joint].push(q[joint]);
            values[1 + n + joint].push(qd[joint]);
            values[1 + 2 * n + joint].push(qdd[joint]);
            values[1 + 3 * n + joint]
                .push(parts.rigid[joint] + parts.friction[joint] + coloured[joint]);
        }
    }
    let mut channels = vec![Channel::Time];
    let all = |channel: fn(usize) -> Channel| (0..n).map(channel);
    channels.extend(all(Channel::Position));
    channels.extend(all(Channel::Velocity));
    channels.extend(all(Channel::Acceleration));
    channels.extend(all(Channel::Torque));
    if with == With::Positions {
        values.drain(1 + n..=3 * n);
        channels.drain(1 + n..=3 * n);
    }
    Log {
        channels,
        values,
        rows: (2..count as u64 + 2).collect(),
        rejected: Vec::new(),
        degrees: Vec::new(),
    }
}
