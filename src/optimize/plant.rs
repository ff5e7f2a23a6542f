//! What the optimiser of a stream asks of the robot, and what a realised stream costs there.

use super::path_energy::{EnergyModel, EnergyParts};
use crate::motion::stream::{DOF, Joints, Stream};

/// The robot that runs a stream.
pub trait Plant {
    /// Torques without dry friction, Nm, at positions (rad), velocities and accelerations.
    fn torque(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints;

    /// Dry friction of each joint, Nm, which acts against its motion.
    fn dry_friction(&self) -> Joints;

    /// Largest |τ| of each joint, Nm.
    fn torque_limit(&self) -> Joints;

    /// A speed that has a ceiling, such as that of the tool, over the ceiling.
    fn speed_share(&self, _q: &Joints, _qd: &Joints) -> f64 {
        0.0
    }

    /// Torques with dry friction, Nm; none at rest.
    fn full_torque(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
        let (smooth, dry) = (self.torque(q, qd, qdd), self.dry_friction());
        std::array::from_fn(|j| smooth[j] + dry[j] * direction(qd[j]))
    }
}

/// The sign of a velocity, 0 at rest.
pub(super) fn direction(velocity: f64) -> f64 {
    if velocity == 0.0 { 0.0 } else { velocity.signum() }
}

/// Simpson's rule on each part of a piece: (time as a share of the part, weight).
const SIMPSON: [(f64, f64); 3] = [(0.0, 1.0 / 6.0), (0.5, 4.0 / 6.0), (1.0, 1.0 / 6.0)];
/// Parts of a piece.
const PARTS: usize = 4;

/// The energies of the motion that a stream is realised as. Friction holds the dry part; the
/// viscous part is with the mechanical one, from which a plant does not tell it.
pub fn stream_energy(stream: &Stream, plant: &impl Plant, model: &EnergyModel) -> EnergyParts {
    let dry = plant.dry_friction();
    let mut sum = EnergyParts::default();
    for piece in stream.pieces() {
        let part = piece.length / PARTS as f64;
        for (i, (share, weight)) in (0..PARTS).flat_map(|i| SIMPSON.map(|point| (i, point))) {
            let (q, qd, qdd) = piece.at((i as f64 + share) * part);
            let seconds = weight * part;
            let smooth = plant.torque(&q, &qd, &qdd);
            let torque: Joints = std::array::from_fn(|j| smooth[j] + dry[j] * direction(qd[j]));
            let power: Joints = std::array::from_fn(|j| torque[j] * qd[j]);
            sum.time += seconds;
            sum.base += seconds * model.base_w;
            sum.drive += seconds * model.braked(&power);
            for j in 0..DOF {
                sum.mechanical += seconds * smooth[j] * qd[j];
                sum.friction += seconds * dry[j] * qd[j].abs();
                sum.copper += seconds * model.loss[j] * torque[j] * torque[j];
            }
        }
    }
    sum
}

/// The largest share of a torque limit or of the speed ceiling that the realised motion uses, at
/// the same places.
pub fn worst_share(stream: &Stream, plant: &impl Plant) -> f64 {
    let limit = plant.torque_limit();
    let mut worst = 0.0f64;
    for piece in stream.pieces() {
        for i in 0..=2 * PARTS {
            let (q, qd, qdd) = piece.at(piece.length * i as f64 / (2 * PARTS) as f64);
            let torque = plant.full_torque(&q, &qd, &qdd);
            worst = (0..DOF).fold(worst, |worst, j| worst.max(torque[j].abs() / limit[j]));
            worst = worst.max(plant.speed_share(&q, &qd));
        }
    }
    worst
}
