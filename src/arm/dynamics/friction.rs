//! Friction of the joints.
//!
//! ```text
//! τ_f = f_C s + f_v q̇ + f_s exp(−(q̇/v_s)²) s + f_a |q̇| + f_d s² + μ |τ_L| s
//! ```
//!
//! with s the sign of the velocity: Coulomb, viscous, Stribeck (B. Armstrong-Hélouvry, P. Dupont,
//! C. Canudas de Wit, "A Survey of Models, Analysis Tools and Compensation Methods for the Control
//! of Machines with Friction", Automatica 30, 1994), differences between directions, and a part
//! that grows with the gear torque `τ_L`. Velocities and torques are those of the motors, which
//! differ from those of the joints only in a coupled wrist.

use crate::arm::robot::{MAX_DOF, Model};

use super::motor_side::{joint_torques, motor_rates, motor_torques};

/// Friction torque of each joint \[Nm\] at the velocities `qd` \[rad/s\], with `load_torque` \[Nm\]
/// through the gears. Exact: s = sign(q̇) with sign(0) = 0.
#[must_use]
pub fn friction(model: &Model, qd: &[f64], load_torque: &[f64; MAX_DOF]) -> [f64; MAX_DOF] {
    friction_with_signs(model, qd, load_torque, &motor_rates(model, qd).map(sign))
}

/// The same with given signs of the motor speeds, 0 for a motor at rest.
#[must_use]
pub fn friction_with_signs(
    model: &Model,
    qd: &[f64],
    load_torque: &[f64; MAX_DOF],
    signs: &[f64; MAX_DOF],
) -> [f64; MAX_DOF] {
    let friction = &model.friction;
    let rates = motor_rates(model, qd);
    let loads = motor_torques(model, *load_torque);
    let mut tau = [0.0; MAX_DOF];
    for joint in 0..model.dof {
        let velocity = rates[joint];
        let s = signs[joint];
        let mut dry = friction.coulomb[joint];
        if let Some(law) = &friction.stribeck {
            dry += law.stiction[joint] * (-(velocity / law.velocity[joint]).powi(2)).exp();
        }
        if let Some(mu) = &friction.load_friction {
            dry += mu[joint] * loads[joint].abs();
        }
        tau[joint] = dry * s + friction.viscous[joint] * velocity;
        if let Some(asymmetry) = &friction.viscous_asymmetry {
            tau[joint] += asymmetry[joint] * velocity * s;
        }
        if let Some(asymmetry) = &friction.coulomb_asymmetry {
            tau[joint] += asymmetry[joint] * s * s;
        }
    }
    joint_torques(model, tau)
}

/// The sign of a velocity: 1, −1, or 0 at 0.
#[must_use]
pub fn sign(velocity: f64) -> f64 {
    if velocity == 0.0 { 0.0 } else { velocity.signum() }
}
