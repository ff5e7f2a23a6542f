//! What differs from the model in a plausible robot, as the features of its torques take it.

use nalgebra::DVector;

use crate::dynamics::{RIGID, link_parameters};
use crate::robot::Model;
use crate::robot::prior::Plausible;

/// What differs from the model in a robot.
#[derive(Clone, Debug)]
pub struct Change {
    pub(super) joints: Vec<ChangeOfJoint>,
    pub(super) base_w: f64,
    pub(super) coils_w: f64,
}

#[derive(Clone, Debug)]
pub(super) struct ChangeOfJoint {
    /// Differences of the features' parameters; the first is 1, for the model's own torque.
    pub(super) values: DVector<f64>,
    pub(super) loss: f64,
    pub(super) model_loss: f64,
}

impl Change {
    /// Of a plausible robot.
    pub fn of(model: &Model, robot: &Plausible) -> Change {
        let own = Plausible::of(model);
        let bodies: Vec<[f64; RIGID]> = robot
            .links
            .iter()
            .zip(&own.links)
            .map(|(new, old)| {
                let (new, old) = (link_parameters(new), link_parameters(old));
                std::array::from_fn(|p| new[p] - old[p])
            })
            .collect();
        let joint = |j: usize| {
            let of_joint = [
                robot.rotors[j] - own.rotors[j],
                robot.viscous[j] - own.viscous[j],
                robot.coulomb[j] - own.coulomb[j],
                robot.spring - own.spring,
            ];
            let values = std::iter::once(1.0)
                .chain(bodies[j..].iter().flatten().copied())
                .chain(of_joint)
                .collect::<Vec<f64>>();
            ChangeOfJoint {
                values: DVector::from_vec(values),
                loss: robot.loss[j],
                model_loss: own.loss[j],
            }
        };
        Change {
            joints: (0..model.dof).map(joint).collect(),
            base_w: robot.base_w - own.base_w,
            coils_w: robot.coils_w - own.coils_w,
        }
    }
}
