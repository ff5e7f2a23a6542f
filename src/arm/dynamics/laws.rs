//! Torques of the effect laws of a model.

use crate::arm::robot::{LawState, MAX_DOF, Model};

use super::motor_side::{joint_torques, motor_rates, motor_torques};

/// Torques \[Nm\] of the laws between the links and of the friction laws of a model, at the time
/// `t` \[s\] since the start of the motion. `gear` are the gear torques at the joints \[Nm\],
/// `signs` the signs of the motor speeds.
#[must_use]
pub fn laws(
    model: &Model,
    t: f64,
    [q, qd]: [&[f64]; 2],
    gear: &[f64; MAX_DOF],
    signs: &[f64; MAX_DOF],
) -> [[f64; MAX_DOF]; 2] {
    let [mut between, mut friction] = [[0.0; MAX_DOF]; 2];
    if model.laws.is_empty() {
        return [between, friction];
    }
    let rates = motor_rates(model, qd);
    let gear = motor_torques(model, *gear);
    for law in &model.laws {
        let joint = law.joint;
        let q = q.get(joint).copied().unwrap_or(0.0);
        let state = LawState { t, q, rate: rates[joint], sense: signs[joint], gear: gear[joint] };
        let to = if law.dissipates { &mut friction } else { &mut between };
        to[joint] += (law.torque)(&state, &law.values);
    }
    [between, joint_torques(model, friction)]
}
