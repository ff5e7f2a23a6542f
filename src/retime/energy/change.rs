//! Parameter differences of plausible robots from the model, in the order of the features.

use nalgebra::DMatrix;

use super::features;
use crate::arm::dynamics::{RIGID, link_parameters};
use crate::arm::robot::Model;
use crate::arm::robot::prior::Plausible;

/// Parameter differences of robots from the model.
#[derive(Clone, Debug)]
pub struct Changes {
    pub(super) joints: Vec<JointChanges>,
    /// Base power per robot, W.
    pub(super) base_w: Vec<f64>,
    /// Brake coil power per robot, W.
    pub(super) coils_w: Vec<f64>,
}

#[derive(Clone, Debug)]
pub(super) struct JointChanges {
    /// Parameter differences, one column per robot; the first entry is 1, the factor of the
    /// torque of the model.
    pub(super) values: DMatrix<f64>,
    /// Loss constant per robot, W/(Nm)².
    pub(super) loss: Vec<f64>,
    pub(super) model_loss: f64,
}

impl Changes {
    /// The differences of plausible robots.
    pub fn new(model: &Model, robots: &[Plausible]) -> Changes {
        let own = Plausible::nominal(model);
        let parameters = |robot: &Plausible| -> Vec<[f64; RIGID]> {
            robot.links.iter().map(link_parameters).collect()
        };
        let own_bodies = parameters(&own);
        let bodies: Vec<Vec<[f64; RIGID]>> = robots.iter().map(parameters).collect();
        let joint = |j: usize| {
            let mut values = DMatrix::zeros(features::count(model, j), robots.len());
            for ((mut column, robot), bodies) in values.column_iter_mut().zip(robots).zip(&bodies) {
                let bodies = bodies[j..].iter().flatten().zip(own_bodies[j..].iter().flatten());
                let of_joint = [
                    robot.rotors[j] - own.rotors[j],
                    robot.viscous[j] - own.viscous[j],
                    robot.coulomb[j] - own.coulomb[j],
                    robot.spring - own.spring,
                ];
                let all =
                    std::iter::once(1.0).chain(bodies.map(|(new, old)| new - old)).chain(of_joint);
                column.iter_mut().zip(all).for_each(|(value, x)| *value = x);
            }
            let loss = robots.iter().map(|robot| robot.loss[j]).collect();
            JointChanges { values, loss, model_loss: own.loss[j] }
        };
        Changes {
            joints: (0..model.dof).map(joint).collect(),
            base_w: robots.iter().map(|robot| robot.base_w - own.base_w).collect(),
            coils_w: robots.iter().map(|robot| robot.coils_w - own.coils_w).collect(),
        }
    }

    /// Base power and brake coil power of the first robot, W.
    pub(super) fn supply_w(&self) -> f64 {
        self.base_w[0] + self.coils_w[0]
    }

    /// The difference of one robot.
    pub fn from_one(model: &Model, robot: &Plausible) -> Changes {
        Changes::new(model, std::slice::from_ref(robot))
    }
}
