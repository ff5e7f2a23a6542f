//! Model errors of healthy robots: small smooth torques of position and speed, ripple below the
//! noise, slightly increased friction at low speed.

use std::f64::consts::TAU;

use super::action::Moment;
use super::mechanics::Joints;
use super::random::Random;
use crate::arm::robot::MAX_DOF;

/// Number of waves over position and over speed, for each joint.
const WAVES: usize = 3;
/// Model error of a joint over its torque's rms.
const SHARE: [f64; 2] = [0.001, 0.006];
/// Ripple over the noise's standard deviation.
const RIPPLE: f64 = 0.15;
/// Stiction over Coulomb friction, and the speed at which it has vanished \[rad/s\].
const STICTION: f64 = 0.02;
const SLOW: f64 = 0.08;

/// Unmodelled torques of a healthy robot.
#[derive(Clone, Debug)]
pub(super) struct ModelError {
    joints: Vec<JointError>,
}

#[derive(Clone, Debug)]
struct JointError {
    /// Approximate rms of the smooth part \[Nm\].
    size: f64,
    fastest: f64,
    waves: [[f64; 6]; WAVES],
    ripple: f64,
    order: f64,
    stiction: f64,
}

impl ModelError {
    /// Random model errors for torques with the rms `rms` \[Nm\], rates up to `fastest` \[rad/s\]
    /// and noise with the standard deviations `noise` \[Nm\].
    pub(super) fn drawn(
        dof: usize,
        rms: &Joints,
        fastest: &Joints,
        noise: &Joints,
        ratio: &Joints,
        random: &mut Random,
    ) -> ModelError {
        let joints = (0..dof)
            .map(|joint| JointError {
                size: random.log_between(SHARE[0], SHARE[1]) * rms[joint],
                fastest: fastest[joint].max(1e-3),
                waves: std::array::from_fn(|_| {
                    [
                        random.between(0.5, 2.5),
                        random.between(0.0, TAU),
                        random.normal(),
                        random.between(0.5, 2.5),
                        random.between(0.0, TAU),
                        random.normal(),
                    ]
                }),
                ripple: RIPPLE * noise[joint] * random.unit(),
                order: ratio[joint],
                stiction: STICTION * random.unit(),
            })
            .collect();
        ModelError { joints }
    }

    /// Typical size of a joint's smooth part \[Nm\].
    pub(super) fn size(&self, joint: usize) -> f64 {
        self.joints.get(joint).map_or(0.0, |error| error.size)
    }

    pub(super) fn add(&self, m: &Moment, tau: &mut Joints) {
        for (joint, error) in self.joints.iter().enumerate() {
            let (q, v) = (m.q[joint], m.qd[joint]);
            let wave = |[a, phase, c, b, shift, d]: &[f64; 6]| {
                c * (a * q + phase).sin() + d * (b * v / error.fastest * 2.0 + shift).sin()
            };
            let smooth: f64 = error.waves.iter().map(wave).sum();
            tau[joint] += error.size * smooth / (WAVES as f64).sqrt()
                + error.ripple * (error.order * q).cos()
                + error.stiction * m.coulomb[joint] * (-v.abs() / SLOW).exp() * m.sign[joint];
        }
    }

    /// Smooth functions of a joint's position and speed with an rms of about 1: nuisance terms for
    /// a diagnosis.
    pub(super) fn basis(&self, joint: usize, q: &Joints, qd: &Joints) -> [f64; 8] {
        let Some(error) = self.joints.get(joint) else { return [0.0; 8] };
        let x = qd[joint] / error.fastest;
        let root = std::f64::consts::SQRT_2;
        let (s1, c1) = q[joint].sin_cos();
        let (s2, c2) = (2.0 * q[joint]).sin_cos();
        let (s3, c3) = (2.0 * x).sin_cos();
        let (s4, c4) = (5.0 * x).sin_cos();
        [s1, c1, s2, c2, s3, c3, s4, c4].map(|value| root * value)
    }
}

/// Friction factors of each period: a small variation from period to period.
pub(super) fn variation(cycles: usize, size: f64, random: &mut Random) -> Vec<Joints> {
    let mut drift = [0.0; MAX_DOF];
    (0..cycles)
        .map(|_| {
            std::array::from_fn(|joint| {
                drift[joint] += 0.2 * size * random.normal();
                1.0 + drift[joint] + size * random.normal_within(3.0)
            })
        })
        .collect()
}
