//! The interface of a robot for stream optimisation, and the cost of a realised stream.

use super::path_energy::{EnergyModel, EnergyParts};
use crate::retime::motion::stream::{DOF, Joints, Piece, Stream};

/// Number of the limits that [`Plant::path_shares`] returns.
const PATH_LIMITS: usize = 4;
/// Used shares of the path limits.
pub type PathShares = [f64; PATH_LIMITS];
/// Their derivatives by the joint angles and the joint speeds.
pub type PathDerivatives = [[Joints; 2]; PATH_LIMITS];

/// The robot that executes a stream.
pub trait Plant {
    /// Torques without Coulomb friction, Nm, at angles (rad), velocities and accelerations.
    fn torque(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints;

    /// Derivatives of [`torque`](Plant::torque) by q (Nm/rad), q̇ and q̈ of each joint:
    /// `[kind][joint that changes][torque]`. The default takes finite differences.
    fn torque_derivatives(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> [[Joints; DOF]; 3] {
        let here = self.torque(q, qd, qdd);
        std::array::from_fn(|kind| {
            std::array::from_fn(|joint| {
                let mut state = [*q, *qd, *qdd];
                state[kind][joint] += DIFFERENCES[kind];
                let [q, qd, qdd] = state;
                let next = self.torque(&q, &qd, &qdd);
                std::array::from_fn(|j| (next[j] - here[j]) / DIFFERENCES[kind])
            })
        })
    }

    /// Coulomb friction of each joint, Nm.
    fn dry_friction(&self) -> Joints;

    /// Largest |τ| of each joint, Nm.
    fn torque_limit(&self) -> Joints;

    /// Shares of the other limits: TCP speed, joint speeds at this place of the path, distance of
    /// the TCP from the path, and clearance to keep-out zones. `place` is the index of the previous
    /// place on the path and is updated, since a path may cross itself.
    fn path_shares(&self, _q: &Joints, _qd: &Joints, _place: &mut usize) -> PathShares {
        PathShares::default()
    }

    /// The derivatives of [`path_shares`](Plant::path_shares), 1/rad and s/rad.
    fn path_derivatives(&self, _q: &Joints, _qd: &Joints, _place: usize) -> PathDerivatives {
        PathDerivatives::default()
    }

    /// Share of the limits at a position on the polygon of the points: distance from the path and
    /// clearance to keep-out zones. `place` as above.
    fn polygon_share(&self, _q: &Joints, _place: &mut usize) -> f64 {
        0.0
    }

    /// The derivatives of [`polygon_share`](Plant::polygon_share), 1/rad.
    fn polygon_derivatives(&self, _q: &Joints, _place: usize) -> Joints {
        Joints::default()
    }

    /// Number of integration steps on a piece, even.
    fn steps(&self, _piece: &Piece) -> usize {
        LEAST_STEPS
    }

    /// Torques with Coulomb friction, Nm; without it at rest.
    fn full_torque(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
        let (smooth, dry) = (self.torque(q, qd, qdd), self.dry_friction());
        std::array::from_fn(|j| smooth[j] + dry[j] * direction(qd[j]))
    }
}

/// Speed below which a joint is at rest, rad/s: at the end of a motion Coulomb friction does not
/// help to brake.
pub(super) const STILL: f64 = 1e-9;

/// The sign of a velocity, 0 at rest.
pub(super) fn direction(velocity: f64) -> f64 {
    if velocity.abs() < STILL { 0.0 } else { velocity.signum() }
}

/// Steps of the forward differences in q (rad), q̇ (rad/s) and q̈ (rad/s²).
pub(super) const DIFFERENCES: [f64; 3] = [1e-5, 1e-4, 1e-3];
/// Margin to the limits, as a share.
pub(super) const ROOM: f64 = 1e-3;
/// Smallest number of integration steps on a piece; even for Simpson's rule.
pub(super) const LEAST_STEPS: usize = 8;

/// Stretches of a piece, of each of which the largest share of a limit counts.
pub(super) const STRETCHES: usize = 3;

/// The stretch of sample `i` of `steps`.
pub(super) fn stretch(i: usize, steps: usize) -> usize {
    (STRETCHES * i / steps).min(STRETCHES - 1)
}

/// Cost of the realised motion of a stream and its used shares of the limits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Realised {
    /// Energies. Friction contains the Coulomb part; the mechanical part contains the viscous one,
    /// since a plant does not separate it.
    pub energy: EnergyParts,
    /// The largest used share of a torque or path limit.
    pub worst_share: f64,
    /// Sum over the stretches and the limits of the largest excess of a share over 1 − `ROOM`.
    pub excess: f64,
}

/// Evaluates a stream on a plant by Simpson's rule on each piece.
pub fn realise(stream: &Stream, plant: &impl Plant, model: &EnergyModel) -> Realised {
    let (dry, limit) = (plant.dry_friction(), plant.torque_limit());
    let mut out = Realised::default();
    let sum = &mut out.energy;
    let mut place = 0;
    for piece in stream.pieces() {
        let steps = plant.steps(&piece);
        let step = piece.length / steps as f64;
        let mut excess = [[0.0f64; DOF + PATH_LIMITS]; STRETCHES];
        for i in 0..=steps {
            let (q, qd, qdd) = piece.at(i as f64 * step);
            let ends = i == 0 || i == steps;
            let weight = if ends { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
            let seconds = weight / 3.0 * step;
            let smooth = plant.torque(&q, &qd, &qdd);
            let torque: Joints = std::array::from_fn(|j| smooth[j] + dry[j] * direction(qd[j]));
            let power: Joints = std::array::from_fn(|j| torque[j] * qd[j]);
            sum.time += seconds;
            sum.base += seconds * model.base_w;
            sum.drive += seconds * model.braked(&power);
            let path = plant.path_shares(&q, &qd, &mut place);
            let loads = (0..DOF).map(|j| torque[j].abs() / limit[j]);
            for (share, excess) in path.into_iter().chain(loads).zip(&mut excess[stretch(i, steps)])
            {
                out.worst_share = out.worst_share.max(share);
                *excess = excess.max(share - (1.0 - ROOM));
            }
            for j in 0..DOF {
                sum.mechanical += seconds * model.work * smooth[j] * qd[j];
                sum.friction += seconds * model.work * dry[j] * qd[j].abs();
                sum.speed += seconds * model.speed * qd[j] * qd[j];
                sum.copper += seconds * model.loss[j] * torque[j] * torque[j];
            }
        }
        out.excess += excess.as_flattened().iter().sum::<f64>();
    }
    let mut place = 0;
    for edge in stream.polygon() {
        for share in EDGE_PLACES.map(|tau| plant.polygon_share(&edge.at(tau).0, &mut place)) {
            out.worst_share = out.worst_share.max(share);
            out.excess += (share - (1.0 - ROOM)).max(0.0);
        }
    }
    out
}

/// Samples on each edge of the polygon, as shares of its length.
pub(super) const EDGE_PLACES: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
