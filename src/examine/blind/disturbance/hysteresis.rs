//! Friction that depends on the distance since the last reversal.
//!
//! Dahl 1968; C. Canudas de Wit et al. 1995 (`LuGre`); F. Al-Bender, V. Lampaert, J. Swevers
//! 2005 (Maxwell slip).

use super::super::fault::Disturbance;
use super::super::random::Random;
use super::super::scale::Scale;

/// Maxwell elements: share of the friction, and relative distance at which each slips.
const ELEMENTS: [[f64; 2]; 4] = [[0.4, 0.4], [0.3, 0.9], [0.2, 1.6], [0.1, 3.0]];

pub(super) fn presliding(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let distance = random.log_between(1.5e-3, 30e-3);
    let (form, name) = random.form(["dahl", "lugre", "maxwell_slip", "stiff_then_soft"]);
    let mut z = [0.0_f64; ELEMENTS.len()];
    Disturbance::at_joint("presliding", name, joint).with("distance", distance).motor_torque(
        joint,
        move |m| {
            let v = m.rate[joint];
            let step = v * m.dt;
            let before = z[0];
            let bristles = match form {
                2 => {
                    for (z, [_, at]) in z.iter_mut().zip(ELEMENTS) {
                        *z = (*z + step / (at * distance)).clamp(-1.0, 1.0);
                    }
                    z.iter().zip(ELEMENTS).map(|(z, [share, _])| share * z).sum()
                }
                3 => {
                    // Distance since the reversal, with a curve that is not exponential.
                    z[1] = if z[2] * step < 0.0 { 0.0 } else { z[1] + step.abs() };
                    if step != 0.0 {
                        z[2] = step.signum();
                    }
                    let x = z[1] / distance;
                    z[2] * (2.0 * (x / (1.0 + x)) - 1.0).max(-1.0)
                }
                _ => {
                    let s = if v == 0.0 { z[0] } else { v.signum() };
                    z[0] = s + (z[0] - s) * (-step.abs() / distance).exp();
                    z[0]
                }
            };
            let damping = if form == 1 { 0.02 * (z[0] - before) / m.dt.max(1e-9) } else { 0.0 };
            m.coulomb[joint] * (bristles + damping.clamp(-0.2, 0.2) - m.sign[joint])
        },
    )
}
