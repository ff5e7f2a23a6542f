//! Magnitudes of the torques and the power of motions.

use super::mechanics::Joints;
use super::motion::Motion;
use super::plant::Plant;
use super::simulate::Supply;
use crate::arm::robot::MAX_DOF;

/// Only one of this many samples is evaluated.
const LOOK: usize = 10;

/// Magnitudes of the torques of motions.
pub(super) struct Sizes {
    pub(super) rms: Joints,
    pub(super) peak: Joints,
    pub(super) fastest: Joints,
    pub(super) load: Joints,
}

pub(super) fn sizes(plant: &Plant, motions: &[Motion]) -> Sizes {
    let zero = [0.0; MAX_DOF];
    let mut sizes = Sizes { rms: zero, peak: zero, fastest: zero, load: zero };
    let mut count = 0.0;
    for sample in motions.iter().flat_map(|motion| motion.samples.iter().step_by(LOOK)) {
        let tau = plant.torque(&sample.q, &sample.qd, &sample.qdd);
        let load = plant.through_gears(plant.rigid(&sample.q, &sample.qd, &sample.qdd));
        let rate = plant.motor(&sample.qd);
        count += 1.0;
        for joint in 0..plant.dof {
            sizes.rms[joint] += tau[joint] * tau[joint];
            sizes.load[joint] += load[joint] * load[joint];
            sizes.peak[joint] = sizes.peak[joint].max(tau[joint].abs());
            sizes.fastest[joint] = sizes.fastest[joint].max(rate[joint].abs());
        }
    }
    for joint in 0..plant.dof {
        sizes.rms[joint] = (sizes.rms[joint] / f64::max(count, 1.0)).sqrt().max(1e-3);
        sizes.load[joint] = (sizes.load[joint] / f64::max(count, 1.0)).sqrt().max(1e-3);
    }
    sizes
}

/// Rms of the motion-dependent power \[W\].
pub(super) fn rms_power(plant: &Plant, supply: &Supply, motions: &[Motion]) -> f64 {
    let (mut squares, mut count) = (0.0, 0.0);
    for sample in motions.iter().flat_map(|motion| motion.samples.iter().step_by(LOOK)) {
        let tau = plant.torque(&sample.q, &sample.qd, &sample.qdd);
        let watts: f64 =
            (0..plant.dof).map(|j| tau[j] * sample.qd[j] + supply.loss[j] * tau[j] * tau[j]).sum();
        squares += watts * watts;
        count += 1.0;
    }
    (squares / f64::max(count, 1.0)).sqrt()
}
