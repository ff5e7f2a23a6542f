//! Ranges of the drawn motions.

use super::mechanics::Joints;
use crate::arm::robot::{MAX_DOF, Model};

/// Used share of a joint's range, and widest used range \[rad\].
const OF_RANGE: f64 = 0.8;
const WIDEST_RANGE: f64 = 4.0;
/// Used shares of the limits of speed and acceleration.
const OF_VELOCITY: f64 = 0.8;
const OF_ACCELERATION: f64 = 0.7;
/// Default limits \[rad/s, rad/s²\].
const USUAL_VELOCITY: f64 = 3.0;
const USUAL_ACCELERATION: f64 = 12.0;

/// Ranges of the joints \[rad\] with largest rates and accelerations.
#[derive(Clone, Debug)]
pub(super) struct Workspace {
    pub(super) dof: usize,
    pub(super) range: [[f64; 2]; MAX_DOF],
    pub(super) velocity: Joints,
    pub(super) acceleration: Joints,
}

impl Workspace {
    pub(super) fn new(model: &Model) -> Workspace {
        let mut workspace = Workspace {
            dof: model.dof,
            range: [[0.0; 2]; MAX_DOF],
            velocity: [USUAL_VELOCITY; MAX_DOF],
            acceleration: [USUAL_ACCELERATION; MAX_DOF],
        };
        for joint in 0..model.dof {
            let [low, high] = model.limits.position[joint];
            let half = (0.5 * OF_RANGE * (high - low)).min(0.5 * WIDEST_RANGE);
            let middle = f64::midpoint(low, high);
            workspace.range[joint] = [middle - half, middle + half];
        }
        for (limit, share, own) in [
            (&model.limits.velocity, OF_VELOCITY, &mut workspace.velocity),
            (&model.limits.acceleration, OF_ACCELERATION, &mut workspace.acceleration),
        ] {
            if let Some(limit) = limit {
                for (to, from) in own.iter_mut().zip(limit) {
                    *to = share * from;
                }
            }
        }
        // The forearm of a parallelogram moves with the upper arm: half a range suits both.
        if let Some([low, high]) = model.limits.coupled {
            let half = 0.25 * (high - low).min(2.0);
            for joint in [1, 2] {
                let middle = f64::midpoint(workspace.range[joint][0], workspace.range[joint][1]);
                workspace.range[joint] = [middle - half, middle + half];
            }
        }
        workspace
    }
}
