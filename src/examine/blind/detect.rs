//! Detectability of a fault in the logs.
//!
//! The expected log-likelihood ratio in nats for known shape and size, with nominal parameters and
//! smooth model errors as nuisance parameters:
//!
//! ```text
//! ½ Δᵀ (Σ + B Bᵀ)⁻¹ Δ
//! ```
//!
//! Δ is the change of the period's mean, Σ the noise covariance of that mean, and each column of B
//! a nuisance times its standard deviation. Changes from period to period are added, with the noise
//! of a period and the usual variation of friction.

use nalgebra::{DMatrix, DVector, Vector3};

use super::mechanics::{Body, Joints};
use super::model_error::ModelError;
use super::motion::{Motion, PER_ROW, Sample};
use super::noise::Noise;
use super::plant::Plant;
use super::simulate::Row;
use super::trust::Trust;
use crate::arm::robot::MAX_DOF;

/// Parameters of a rigid body.
const OF_BODY: usize = 10;
/// Coulomb friction, viscous friction, rotor inertia.
const OF_JOINT: usize = 3;
/// Number of smooth functions for a joint's model error.
const SMOOTH: usize = 8;

/// Prior knowledge of the logs.
pub(super) struct Setting<'a> {
    pub(super) nominal: &'a Plant,
    pub(super) trust: Trust,
    pub(super) error: &'a ModelError,
    pub(super) noise: &'a Noise,
    /// Relative change of friction from period to period.
    pub(super) variation: f64,
}

/// Rows of a motion's log with and without a disturbance.
pub(super) struct Pair<'a> {
    pub(super) motion: &'a Motion,
    pub(super) with: &'a [Row],
    pub(super) without: &'a [Row],
}

/// Nats of the torques of all pairs.
pub(super) fn torque_nats(setting: &Setting<'_>, pairs: &[Pair<'_>]) -> f64 {
    let n = setting.nominal.dof;
    let columns = OF_BODY * n + OF_JOINT * n + SMOOTH * n;
    let mut gram = DMatrix::<f64>::identity(columns, columns);
    let mut projected = DVector::<f64>::zeros(columns);
    let mut rows = Vec::new();
    let mut squares = 0.0;
    for pair in pairs {
        let samples: Vec<Sample> = pair.motion.samples.iter().step_by(PER_ROW).copied().collect();
        let count = samples.len();
        let cycles = (pair.with.len() / count).max(1);
        let deltas = deltas(setting, pair, &samples);
        let mean: Vec<Joints> = (0..count)
            .map(|i| {
                std::array::from_fn(|joint| {
                    (0..cycles).map(|m| deltas[m * count + i][joint]).sum::<f64>() / cycles as f64
                })
            })
            .collect();
        let nuisance: Vec<DMatrix<f64>> =
            samples.iter().map(|sample| columns_at(setting, sample, columns)).collect();
        for joint in 0..n {
            let weight = (cycles as f64).sqrt() / setting.noise.innovation(joint).max(1e-12);
            let memory = setting.noise.memory;
            let mut block = DMatrix::<f64>::zeros(count, columns);
            let mut delta = DVector::<f64>::zeros(count);
            for i in 0..count {
                let before = (i + count - 1) % count;
                delta[i] = weight * (mean[i][joint] - memory * mean[before][joint]);
                for column in 0..columns {
                    let now = nuisance[i][(joint, column)];
                    block[(i, column)] =
                        weight * (now - memory * nuisance[before][(joint, column)]);
                }
            }
            gram += block.tr_mul(&block);
            projected += block.tr_mul(&delta);
            rows.push((block, delta));
            squares += between_periods(setting, &deltas, &mean, &samples, joint);
        }
    }
    // Δᵀ(Σ + BBᵀ)⁻¹Δ is the minimum of ‖Δ − B x‖² + ‖x‖² and insensitive to small errors of x; the
    // difference of the large sums would lose accuracy.
    let Some(factor) = gram.cholesky() else { return 0.0 };
    let x = factor.solve(&projected);
    let left: f64 = rows.iter().map(|(block, delta)| (delta - block * &x).norm_squared()).sum();
    0.5 * (squares + left + x.norm_squared())
}

/// Nats of the power.
pub(super) fn power_nats(noise: &Noise, pairs: &[Pair<'_>]) -> f64 {
    let white = noise.power * (1.0 - noise.memory * noise.memory).sqrt();
    let mut sum = 0.0;
    for pair in pairs {
        let delta: Vec<f64> =
            pair.with.iter().zip(pair.without).map(|(a, b)| a.power - b.power).collect();
        let fresh = delta.windows(2).map(|pair| (pair[1] - noise.memory * pair[0]) / white);
        sum += fresh.map(|x| x * x).sum::<f64>();
    }
    0.5 * sum
}

/// Torque changes of each row, less the change that the nominal model predicts from the logged
/// positions.
fn deltas(setting: &Setting<'_>, pair: &Pair<'_>, samples: &[Sample]) -> Vec<Joints> {
    let rows = pair.with.iter().zip(pair.without).enumerate();
    let mut expected: Vec<Option<Joints>> = vec![None; samples.len()];
    rows.map(|(i, (with, without))| {
        let mut delta: Joints = std::array::from_fn(|joint| with.tau[joint] - without.tau[joint]);
        if with.q != without.q {
            let k = i % samples.len();
            let known = *expected[k].get_or_insert_with(|| {
                let sample = &samples[k];
                let there = setting.nominal.rigid(&with.q, &sample.qd, &sample.qdd);
                let here = setting.nominal.rigid(&without.q, &sample.qd, &sample.qdd);
                std::array::from_fn(|joint| there[joint] - here[joint])
            });
            for (delta, known) in delta.iter_mut().zip(known) {
                *delta -= known;
            }
        }
        delta
    })
    .collect()
}

/// Whitened squares of the deviations from the mean; the friction of each period is free within its
/// usual variation.
fn between_periods(
    setting: &Setting<'_>,
    deltas: &[Joints],
    mean: &[Joints],
    samples: &[Sample],
    joint: usize,
) -> f64 {
    let count = mean.len();
    let weight = 1.0 / setting.noise.innovation(joint).max(1e-12);
    let memory = setting.noise.memory;
    let nominal = setting.nominal;
    let friction: Vec<f64> = samples
        .iter()
        .map(|sample| {
            let rate = nominal.motor(&sample.qd)[joint];
            let dry = if rate == 0.0 { 0.0 } else { nominal.coulomb[joint] * rate.signum() };
            setting.variation * (dry + nominal.viscous[joint] * rate)
        })
        .collect();
    deltas
        .chunks_exact(count)
        .map(|cycle| {
            let (mut squares, mut cross, mut column) = (0.0, 0.0, 1.0);
            let rest = |i: usize| cycle[i][joint] - mean[i][joint];
            for i in 1..count {
                let d = weight * (rest(i) - memory * rest(i - 1));
                let c = weight * (friction[i] - memory * friction[i - 1]);
                squares += d * d;
                cross += d * c;
                column += c * c;
            }
            (squares - cross * cross / column).max(0.0)
        })
        .sum()
}

/// Torques of each nuisance at one standard deviation, a row for each joint.
fn columns_at(setting: &Setting<'_>, sample: &Sample, columns: usize) -> DMatrix<f64> {
    let (nominal, trust) = (setting.nominal, setting.trust);
    let n = nominal.dof;
    let axes = nominal.axes(&sample.q, &sample.qd, &sample.qdd);
    let mut matrix = DMatrix::zeros(n, columns);
    let mut column = 0;
    let torque = |body: &Body| {
        let mut tau = [0.0; MAX_DOF];
        axes.add_body(body, &nominal.up, &mut tau);
        nominal.geometry.from_serial_torque(tau)
    };
    for body in nominal.bodies.iter().take(n) {
        let before = torque(body);
        for changed in varied(body, trust) {
            let after = torque(&changed);
            for joint in 0..n {
                matrix[(joint, column)] = after[joint] - before[joint];
            }
            column += 1;
        }
    }
    let (rate, acceleration) = (nominal.motor(&sample.qd), nominal.motor(&sample.qdd));
    for motor in 0..n {
        let dry = if rate[motor] == 0.0 { 0.0 } else { rate[motor].signum() };
        for torque in [
            trust.friction * nominal.coulomb[motor] * dry,
            trust.friction * nominal.viscous[motor] * rate[motor],
            trust.inertia * nominal.rotor[motor] * acceleration[motor],
        ] {
            let mut at_motors = [0.0; MAX_DOF];
            at_motors[motor] = torque;
            for (joint, tau) in nominal.at_joints(at_motors).iter().take(n).enumerate() {
                matrix[(joint, column)] = *tau;
            }
            column += 1;
        }
    }
    for joint in 0..n {
        let size = setting.error.size(joint) / 2.0;
        for value in setting.error.basis(joint, &sample.q, &sample.qd) {
            matrix[(joint, column)] = size * value;
            column += 1;
        }
    }
    matrix
}

/// The body with each of its parameters increased by a standard deviation.
fn varied(body: &Body, trust: Trust) -> [Body; OF_BODY] {
    let moment = trust.inertia * body.inertia.trace() / 3.0;
    std::array::from_fn(|number| {
        let mut body = body.clone();
        match number {
            0 => body.mass *= 1.0 + trust.mass,
            1..=3 => body.com += Vector3::ith(number - 1, trust.com),
            4..=6 => body.inertia[(number - 4, number - 4)] += moment,
            _ => {
                let (a, b) = [(0, 1), (0, 2), (1, 2)][number - 7];
                body.inertia[(a, b)] += 0.5 * moment;
                body.inertia[(b, a)] += 0.5 * moment;
            }
        }
        body
    })
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::super::fourier::fourier;
    use super::super::random::Random;
    use super::super::robots;
    use super::super::workspace::Workspace;
    use super::*;

    /// A nuisance changed by one standard deviation contributes at most half a nat, an offset of
    /// the same size much more.
    #[test]
    fn nuisances_are_not_detectable() {
        let mut random = Random::new(4, 1, "test");
        let model = robots::robot(&mut random).unwrap();
        let nominal = Plant::new(&model);
        let motion = fourier(&Workspace::new(&model), 4.0, &mut random);
        let samples: Vec<Sample> = motion.samples.iter().step_by(PER_ROW).copied().collect();
        let row = |plant: &Plant, sample: &Sample, offset: f64| {
            let mut tau = plant.torque(&sample.q, &sample.qd, &sample.qdd);
            // The first axis is vertical: no weight causes an offset.
            tau[0] += offset;
            Row { q: sample.q, tau, power: 0.0 }
        };
        let rows = |plant: &Plant, offset: f64| -> Vec<Row> {
            samples.iter().map(|sample| row(plant, sample, offset)).collect()
        };
        let without = rows(&nominal, 0.0);
        let sizes = without[0].tau.map(|_| 20.0);
        let noise = Noise::drawn(&sizes, &sizes, 100.0, &mut random);
        let error = ModelError::drawn(6, &sizes, &sizes, &sizes, &sizes, &mut random);
        let setting = Setting {
            nominal: &nominal,
            trust: Trust::COMMISSIONED,
            error: &error,
            noise: &noise,
            variation: 0.002,
        };
        let nats = |with: &[Row]| {
            torque_nats(&setting, &[Pair { motion: &motion, with, without: &without }])
        };
        let mut other = nominal.clone();
        let change = setting.trust.friction * other.viscous[1];
        other.viscous[1] += change;
        let of_parameter = nats(&rows(&other, 0.0));
        assert!(of_parameter > 0.0 && of_parameter <= 0.5 + 1e-6, "{of_parameter}");
        other = nominal.clone();
        other.bodies[2].mass *= 1.0 + setting.trust.mass;
        assert!(nats(&rows(&other, 0.0)) <= 0.5 + 1e-6);
        let offset = nats(&rows(&nominal, 5.0));
        assert!(offset > 20.0 * of_parameter, "{offset}");
    }
}
