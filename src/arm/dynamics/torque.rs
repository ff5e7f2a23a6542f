//! Joint torques: rigid bodies, rotors and friction.

use crate::arm::robot::{MAX_DOF, Model};

use super::data::Data;
use super::friction::{friction_with_signs, sign};
use super::laws::laws;
use super::load::Load;
use super::motor_side::{motor_rates, rotor_torques};
use super::rnea::{rigid_bodies, rigid_bodies_each};

/// Torques at the joints \[Nm\].
#[derive(Clone, Copy, Debug)]
pub struct Torque {
    /// Rigid bodies and rotors, as from [`rnea`](super::rnea), and laws between the links.
    pub rigid: [f64; MAX_DOF],
    /// Friction with exact signs.
    pub friction: [f64; MAX_DOF],
}

/// The torques of the motion `q` \[rad\], `qd` \[rad/s\], `qdd` \[rad/s²\] with `load` at the
/// flange. All zero except friction if the robot has no dynamics.
pub fn torque(
    model: &Model,
    data: &mut Data,
    load: &Load,
    q: &[f64],
    qd: &[f64],
    qdd: &[f64],
) -> Torque {
    through_gears(model, [q, qd, qdd], rigid_bodies(model, data, load, q, qd, qdd))
}

/// [`torque`] in several states \[q, q̇, q̈\], faster than one by one.
#[inline]
pub fn torque_each<const N: usize>(
    model: &Model,
    load: &Load,
    states: [[&[f64]; 3]; N],
) -> [Torque; N] {
    let rigid = rigid_bodies_each(model, load, states);
    std::array::from_fn(|k| through_gears(model, states[k], rigid[k]))
}

/// The torques from the rigid-body torques `rigid`.
fn through_gears(model: &Model, [q, qd, qdd]: [&[f64]; 3], mut rigid: [f64; MAX_DOF]) -> Torque {
    let signs = motor_rates(model, qd).map(sign);
    let mut friction = friction_with_signs(model, qd, &rigid, &signs);
    if !model.laws.is_empty() {
        let [between, rubbing] = laws(model, f64::INFINITY, [q, qd], &rigid, &signs);
        for joint in 0..model.dof {
            rigid[joint] += between[joint];
            friction[joint] += rubbing[joint];
        }
    }
    for (sum, rotor) in rigid.iter_mut().zip(rotor_torques(model, qdd)) {
        *sum += rotor;
    }
    Torque { rigid, friction }
}
