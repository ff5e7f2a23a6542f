//! The pseudo-inertia of a rigid body: additive over bodies, and positive definite for a physically
//! consistent body.
//!
//! ```text
//! P = ⎡ Σ   h ⎤    Σ = ∫ r rᵀ dm = ½ tr(I) 1 − I,  h = m c
//!     ⎣ hᵀ  m ⎦
//! ```
//!
//! (P. Wensing, S. Kim, J.-J. Slotine, "Linear matrix inequalities for physically consistent
//! inertial parameter identification", RA-L 3, 2018). It transforms as T P Tᵀ.

use nalgebra::{Matrix3, Matrix4, Vector3};

use super::parameters::RIGID;
use crate::arm::robot::Link;

/// P from the ten parameters of a body in the order of [`link_parameters`](super::link_parameters),
/// about the frame origin; missing parameters are 0.
#[must_use]
pub fn pseudo_inertia(parameters: &[f64]) -> Matrix4<f64> {
    let [m, hx, hy, hz, ..] = ten(parameters);
    let about = about_origin(parameters);
    let spread = Matrix3::identity() * (0.5 * about.trace()) - about;
    let mut p = Matrix4::zeros();
    p.fixed_view_mut::<3, 3>(0, 0).copy_from(&spread);
    for (k, h) in [hx, hy, hz, m].into_iter().enumerate() {
        p[(k, 3)] = h;
        p[(3, k)] = h;
    }
    p
}

/// The ten parameters of the body with the pseudo-inertia `p`.
#[must_use]
pub fn body_parameters(p: &Matrix4<f64>) -> [f64; RIGID] {
    let [x, y, z] = [p[(0, 0)], p[(1, 1)], p[(2, 2)]];
    [
        p[(3, 3)],
        p[(0, 3)],
        p[(1, 3)],
        p[(2, 3)],
        y + z,
        x + z,
        x + y,
        -p[(0, 1)],
        -p[(0, 2)],
        -p[(1, 2)],
    ]
}

/// The link with these parameters, the inverse of [`link_parameters`](super::link_parameters).
/// Without mass its centre of mass is the origin.
#[must_use]
pub fn link_of(parameters: &[f64]) -> Link {
    let [m, hx, hy, hz, ..] = ten(parameters);
    let com = if m == 0.0 { Vector3::zeros() } else { Vector3::new(hx, hy, hz) / m };
    let steiner = (Matrix3::identity() * com.norm_squared() - com * com.transpose()) * m;
    Link { mass: m, com, inertia: about_origin(parameters) - steiner }
}

fn about_origin(parameters: &[f64]) -> Matrix3<f64> {
    let [.., xx, yy, zz, xy, xz, yz] = ten(parameters);
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

fn ten(parameters: &[f64]) -> [f64; RIGID] {
    std::array::from_fn(|k| parameters.get(k).copied().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::super::parameters::link_parameters;
    use super::*;

    #[test]
    fn a_link_becomes_a_pseudo_inertia_and_back() {
        let inertia = Matrix3::new(0.02, 1e-3, -2e-3, 1e-3, 0.03, 3e-3, -2e-3, 3e-3, 0.04);
        let link = Link { mass: 3.0, com: Vector3::new(0.1, -0.2, 0.3), inertia };
        let there = link_parameters(&link);
        let p = pseudo_inertia(&there);
        let back = link_of(&body_parameters(&p));
        assert!((back.com - link.com).norm() < 1e-14 && (back.mass - 3.0).abs() < 1e-14);
        assert!((back.inertia - link.inertia).norm() < 1e-14);
        // ∫ |r|² dm is half the trace of the inertia about the origin.
        let spread = p.fixed_view::<3, 3>(0, 0).trace();
        assert!((spread - 0.5 * (there[4] + there[5] + there[6])).abs() < 1e-14);
    }
}
