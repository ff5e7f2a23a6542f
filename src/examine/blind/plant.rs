//! The simulated robot: bodies, rotors, friction.

use nalgebra::{Isometry3, Matrix3, Vector3};

use super::mechanics::{Axes, Body, GRAVITY, Joints, add, of_slice};
use crate::arm::robot::{Geometry, Link, MAX_DOF, Model};

/// Axes 5 and 6, from 0.
const WRIST: [usize; 2] = [4, 5];

/// Parameters that determine the torques of a robot without disturbances.
#[derive(Clone, Debug)]
pub(super) struct Plant {
    pub(super) dof: usize,
    pub(super) geometry: Geometry,
    /// One body for each link, then the loads.
    pub(super) bodies: Vec<Body>,
    /// Acceleration opposite to gravity, in the base frame \[m/s²\].
    pub(super) up: Vector3<f64>,
    /// Inertia of the rotors at the joints \[kg m²\].
    pub(super) rotor: Joints,
    /// Coulomb friction \[Nm\].
    pub(super) coulomb: Joints,
    /// Viscous friction \[Nm s/rad\].
    pub(super) viscous: Joints,
    /// Turns of motor 6 for one of axis 5.
    pub(super) coupling: f64,
}

impl Plant {
    /// The plant of a robot model.
    pub(super) fn new(model: &Model) -> Plant {
        let mut rotor = [0.0; MAX_DOF];
        if let Some(motors) = &model.motors {
            for (joint, inertia) in rotor.iter_mut().enumerate().take(model.dof) {
                *inertia = motors.ratio[joint].powi(2) * motors.rotor_inertia[joint];
            }
        }
        let body = |(joint, link): (usize, &Link)| Body {
            joint,
            mass: link.mass,
            com: link.com,
            inertia: link.inertia,
        };
        Plant {
            dof: model.dof,
            geometry: model.kinematics.clone(),
            bodies: model.links.iter().enumerate().map(body).collect(),
            up: model.kinematics.up() * GRAVITY,
            rotor,
            coulomb: of_slice(&model.friction.coulomb),
            viscous: of_slice(&model.friction.viscous),
            coupling: model.wrist.coupling,
        }
    }

    /// Motor rates, divided by the gear ratios, from joint rates.
    pub(super) fn motor(&self, joint: &Joints) -> Joints {
        let mut rates = *joint;
        rates[WRIST[1]] += self.coupling * rates[WRIST[0]];
        rates
    }

    /// Joint torques from motor torques times the gear ratios.
    pub(super) fn at_joints(&self, mut tau: Joints) -> Joints {
        tau[WRIST[0]] += self.coupling * tau[WRIST[1]];
        tau
    }

    /// Torques through the gears from joint torques.
    pub(super) fn through_gears(&self, mut tau: Joints) -> Joints {
        tau[WRIST[0]] -= self.coupling * tau[WRIST[1]];
        tau
    }

    /// The axes in motion.
    pub(super) fn axes(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Axes {
        let serial = |x: &Joints| self.geometry.to_serial(x);
        Axes::at(&self.geometry, &serial(q), &serial(qd), &serial(qdd))
    }

    /// Torques of the rigid bodies alone \[Nm\].
    pub(super) fn rigid(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
        self.bodies_alone(q, qd, qdd, &self.up)
    }

    /// Column of the mass matrix for a joint's acceleration, without rotors.
    pub(super) fn inertia_column(&self, q: &Joints, joint: usize) -> Joints {
        let still = [0.0; MAX_DOF];
        let mut unit = still;
        unit[joint] = 1.0;
        self.bodies_alone(q, &still, &unit, &Vector3::zeros())
    }

    fn bodies_alone(&self, q: &Joints, qd: &Joints, qdd: &Joints, up: &Vector3<f64>) -> Joints {
        let axes = self.axes(q, qd, qdd);
        let mut tau = [0.0; MAX_DOF];
        for body in &self.bodies {
            axes.add_body(body, up, &mut tau);
        }
        self.geometry.from_serial_torque(tau)
    }

    /// Torques of bodies, rotors, Coulomb and viscous friction \[Nm\].
    pub(super) fn torque(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
        let mut tau = self.rigid(q, qd, qdd);
        let (rate, acceleration) = (self.motor(qd), self.motor(qdd));
        let mut gears = [0.0; MAX_DOF];
        for i in 0..self.dof {
            let sign = if rate[i] == 0.0 { 0.0 } else { rate[i].signum() };
            gears[i] = self.rotor[i] * acceleration[i]
                + self.coulomb[i] * sign
                + self.viscous[i] * rate[i];
        }
        add(&mut tau, &self.at_joints(gears));
        tau
    }

    /// A body given in the flange frame, in the frame of the last joint.
    pub(super) fn on_flange(&self, mass: f64, com: Vector3<f64>, inertia: Matrix3<f64>) -> Body {
        let flange: &Isometry3<f64> = &self.geometry.flange;
        let turned = flange.rotation.to_rotation_matrix();
        Body {
            joint: self.dof.saturating_sub(1),
            mass,
            com: flange.transform_point(&com.into()).coords,
            inertia: turned.matrix() * inertia * turned.matrix().transpose(),
        }
    }
}

/// The torques of a model's bodies, rotors, Coulomb and viscous friction \[Nm\] at the motion `q`
/// \[rad\], `qd` \[rad/s\], `qdd` \[rad/s²\]; surplus entries are ignored. Friction has the sign of
/// the velocity and is 0 at rest.
#[cfg(feature = "internals")]
#[must_use]
pub fn torque(
    model: &Model,
    q: &[f64; MAX_DOF],
    qd: &[f64; MAX_DOF],
    qdd: &[f64; MAX_DOF],
) -> [f64; MAX_DOF] {
    Plant::new(model).torque(q, qd, qdd)
}
