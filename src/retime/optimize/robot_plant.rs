//! Robot torques for stream optimisation with their derivatives, without Coulomb friction, which
//! jumps at a reversal.

use super::plant::direction;
use crate::arm::dynamics::{Data, JointMatrix, Load, friction, rnea_derivatives, torque};
use crate::arm::robot::Model;
use crate::retime::motion::stream::{DOF, Joints};

/// Step of the friction differences in the speed, directed away from the jump, rad/s.
const STEP: f64 = 1e-4;

/// Torques without Coulomb friction, Nm: rigid bodies, rotors and the other friction laws.
pub fn smooth_torque(model: &Model, load: &Load, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
    let torque = torque(model, &mut Data::new(), load, q, qd, qdd);
    std::array::from_fn(|j| torque.rigid[j] + torque.friction[j] - dry(model, qd, j))
}

/// Derivatives of [`smooth_torque`] by q, q̇ and q̈: `[kind][joint that changes][torque]`.
pub fn smooth_torque_derivatives(
    model: &Model,
    load: &Load,
    q: &Joints,
    qd: &Joints,
    qdd: &Joints,
) -> [[Joints; DOF]; 3] {
    let rigid = rnea_derivatives(model, &mut Data::new(), load, q, qd, qdd);
    let column =
        |matrix: &JointMatrix, i: usize| -> Joints { std::array::from_fn(|j| matrix[(j, i)]) };
    let other = |qd: &Joints| -> Joints {
        let friction = friction(model, qd, &rigid.tau);
        std::array::from_fn(|j| friction[j] - dry(model, qd, j))
    };
    let here = other(qd);
    std::array::from_fn(|kind| {
        std::array::from_fn(|i| match kind {
            0 => column(&rigid.dq, i),
            1 => {
                let step = if qd[i] < 0.0 { -STEP } else { STEP };
                let mut moved = *qd;
                moved[i] += step;
                let (next, by) = (other(&moved), column(&rigid.dqd, i));
                std::array::from_fn(|j| by[j] + (next[j] - here[j]) / step)
            }
            _ => column(&rigid.mass, i),
        })
    })
}

fn dry(model: &Model, qd: &Joints, joint: usize) -> f64 {
    model.friction.coulomb[joint] * direction(qd[joint])
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::*;
    use crate::arm::robot::{find, from_toml};

    /// Relative tolerance of second-order differences.
    const DIFFERENCES: f64 = 1e-6;

    #[test]
    fn derivatives_are_the_limits_of_differences() {
        let more = "extends = \"IRB1600-10/1.45\"\nname = \"more\"\n\
            [friction]\nviscous_asymmetry = { asymmetry = [3.0, 2.0, -1.0, 0.2, 0.1, 0.1] }\n";
        let robots = [find("IRB1600-10/1.45").unwrap(), from_toml("more.toml", more).unwrap()];
        let state: [Joints; 3] = [
            [0.2, 0.4, -0.3, 0.7, 0.9, -0.4],
            [0.8, -0.5, 1.1, 2.0, -1.4, 0.6],
            [3.0, 2.0, -4.0, 9.0, 5.0, -7.0],
        ];
        let load = Load::none();
        for model in robots {
            let at = |s: &[Joints; 3]| smooth_torque(&model, &load, &s[0], &s[1], &s[2]);
            let by = smooth_torque_derivatives(&model, &load, &state[0], &state[1], &state[2]);
            for kind in 0..3 {
                for i in 0..DOF {
                    let (mut lo, mut hi) = (state, state);
                    lo[kind][i] -= STEP;
                    hi[kind][i] += STEP;
                    let (lo, hi) = (at(&lo), at(&hi));
                    for j in 0..DOF {
                        let difference = (hi[j] - lo[j]) / (2.0 * STEP);
                        let scale = 1.0 + difference.abs();
                        let error = (by[kind][i][j] - difference).abs() / scale;
                        assert!(error < DIFFERENCES, "{kind} {i} {j}: {error}");
                    }
                }
            }
        }
    }
}
