//! Friction of the joints, with exact signs.

use crate::robot::{MAX_DOF, Model};

/// Torque of each joint against its friction \[Nm\] at the velocities `qd`
/// \[rad/s\]: coulomb · sign(q̇) + viscous · q̇, with sign(0) = 0.
#[must_use]
pub fn friction(model: &Model, qd: &[f64]) -> [f64; MAX_DOF] {
    let mut tau = [0.0; MAX_DOF];
    let laws = model.friction.coulomb.iter().zip(&model.friction.viscous);
    for ((torque, (coulomb, viscous)), &velocity) in tau.iter_mut().zip(laws).zip(qd) {
        let sign = if velocity == 0.0 { 0.0 } else { velocity.signum() };
        *torque = coulomb * sign + viscous * velocity;
    }
    tau
}
