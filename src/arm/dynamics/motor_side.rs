//! Rotors and friction at the motor side.
//!
//! With coupled wrist gears motor 6 also turns with axis 5: with φ = C q the motor angles over the
//! gear ratios, torques map as `τ = Cᵀ τ_m`.

use crate::arm::robot::{MAX_DOF, Model};

use super::joint_matrix::JointMatrix;

/// Joints 5 and 6, from 0.
const WRIST: [usize; 2] = [4, 5];

/// C x: motor velocities or accelerations over the gear ratios, from those of the joints.
#[must_use]
pub fn motor_rates(model: &Model, joint_rates: &[f64]) -> [f64; MAX_DOF] {
    let mut rates = [0.0; MAX_DOF];
    for (to, from) in rates.iter_mut().zip(joint_rates).take(model.dof) {
        *to = *from;
    }
    rates[WRIST[1]] += model.wrist.coupling * rates[WRIST[0]];
    rates
}

/// C⁻ᵀ τ: motor torques times the gear ratios, from joint torques.
#[must_use]
pub fn motor_torques(model: &Model, mut tau: [f64; MAX_DOF]) -> [f64; MAX_DOF] {
    tau[WRIST[0]] -= model.wrist.coupling * tau[WRIST[1]];
    tau
}

/// Cᵀ τ: joint torques from motor torques.
pub(super) fn joint_torques(model: &Model, mut tau: [f64; MAX_DOF]) -> [f64; MAX_DOF] {
    tau[WRIST[0]] += model.wrist.coupling * tau[WRIST[1]];
    tau
}

/// Torques that accelerate the rotors by `qdd`; 0 if the robot has no dynamics.
pub(super) fn rotor_torques(model: &Model, qdd: &[f64]) -> [f64; MAX_DOF] {
    let Some(motors) = model.motors.as_ref().filter(|_| model.has_dynamics()) else {
        return [0.0; MAX_DOF];
    };
    let mut tau = motor_rates(model, qdd);
    for joint in 0..model.dof {
        tau[joint] *= motors.reflected_inertia(joint);
    }
    joint_torques(model, tau)
}

/// Apparent torques of a log in proportion to motor accelerations and speeds \[Nm\].
#[must_use]
pub fn apparent_torques(model: &Model, qd: &[f64], qdd: &[f64]) -> [f64; MAX_DOF] {
    let sensors = &model.sensors;
    let (rates, accelerations) = (motor_rates(model, qd), motor_rates(model, qdd));
    let mut tau = [0.0; MAX_DOF];
    for joint in 0..model.dof {
        tau[joint] = sensors.apparent_inertia[joint] * accelerations[joint]
            + sensors.apparent_viscous[joint] * rates[joint];
    }
    joint_torques(model, tau)
}

/// Adds the rotor inertia Cᵀ diag(n² `J_m`) C.
pub(super) fn add_rotors(model: &Model, matrix: &mut JointMatrix) {
    let Some(motors) = model.motors.as_ref().filter(|_| model.has_dynamics()) else { return };
    for joint in 0..model.dof {
        matrix[(joint, joint)] += motors.reflected_inertia(joint);
    }
    let coupling = model.wrist.coupling;
    if coupling != 0.0 {
        let [fifth, sixth] = WRIST;
        let inertia = motors.reflected_inertia(sixth);
        matrix[(fifth, fifth)] += coupling * coupling * inertia;
        matrix[(fifth, sixth)] += coupling * inertia;
        matrix[(sixth, fifth)] += coupling * inertia;
    }
}
