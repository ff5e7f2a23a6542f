//! Logs of a robot that is known.

use joulepath::dynamics::{Data, Load, torque};
use joulepath::excite::Series;
use joulepath::log::{Channel, Log};
use joulepath::robot::{Model, find};

/// The robot of the paper.
pub(crate) fn irb1600() -> Model {
    find("IRB1600-10/1.45").unwrap()
}

/// A periodic motion with random phases, within the limits of the IRB1600.
pub(crate) fn series(seed: u64) -> Series {
    let mut random = fastrand::Rng::with_seed(seed);
    let limits = [2.5, 1.2, 1.5, 3.0, 1.8, 5.0];
    let middle = [0.0, 0.3, -1.2, 0.0, 0.1, 0.0];
    let speeds = [2.4, 2.4, 2.5, 5.0, 5.4, 6.0];
    let harmonics = vec![1, 3, 4, 7];
    let amplitude = (0..6)
        .map(|joint: usize| {
            let raw: Vec<f64> =
                harmonics.iter().map(|k| (0.4 + random.f64()) / *k as f64).collect();
            let reach: f64 = raw.iter().sum();
            let fast: f64 = raw
                .iter()
                .zip(&harmonics)
                .map(|(a, k)| a * 0.2 * std::f64::consts::PI * *k as f64)
                .sum();
            let scale = (limits[joint] / reach).min(speeds[joint] / fast);
            raw.iter()
                .map(|a| {
                    let (sin, cos) = (std::f64::consts::TAU * random.f64()).sin_cos();
                    [scale * a * sin, scale * a * cos]
                })
                .collect()
        })
        .collect();
    Series { base_frequency: 0.1, harmonics, offset: middle.to_vec(), amplitude }
}

/// Standard normal.
pub(crate) fn normal(random: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.f64()).cos()
}

/// What a log has.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum With {
    Rates,
    Positions,
}

/// A log of `duration` s every `step` s; `noise` \[Nm\] with the memory `memory`.
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
    let of = |channel: fn(usize) -> Channel| (0..n).map(channel);
    channels.extend(of(Channel::Position));
    channels.extend(of(Channel::Velocity));
    channels.extend(of(Channel::Acceleration));
    channels.extend(of(Channel::Torque));
    if with == With::Positions {
        values.drain(1 + n..=3 * n);
        channels.drain(1 + n..=3 * n);
    }
    Log { channels, values, rows: (2..count as u64 + 2).collect(), rejected: Vec::new() }
}
