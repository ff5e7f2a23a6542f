//! A robot, a motion that excites it, and noise.

use joulepath::arm::robot::{Model, find};
use joulepath::learn::excite::Series;

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
