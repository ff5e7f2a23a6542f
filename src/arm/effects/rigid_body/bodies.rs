//! Adds rigid bodies to links.

use nalgebra::{Isometry3, Matrix3, Vector3};

use crate::arm::dynamics::{RIGID, body_parameters, link_of, link_parameters, pseudo_inertia};
use crate::arm::robot::Link;

/// `link` with an added body: mass, first moments, moments (xx, yy, zz, xy, xz, yz) about the
/// origin of `frame`, in its axes. The body may have moments without mass.
#[must_use]
pub fn added(link: &Link, frame: &Isometry3<f64>, body: &[f64]) -> Link {
    if body.iter().all(|x| *x == 0.0) {
        return link.clone();
    }
    let to = frame.to_homogeneous();
    let own = pseudo_inertia(&link_parameters(link));
    let sum = link_of(&body_parameters(&(own + to * pseudo_inertia(body) * to.transpose())));
    if sum.mass == 0.0 { Link { com: link.com, ..sum } } else { sum }
}

/// Mass, centre of mass and moments about it, from moments about an origin.
pub(in crate::arm::effects) fn about_centre(x: &[f64]) -> Vec<f64> {
    let Link { mass, com: c, inertia: i } = link_of(x);
    vec![mass, c.x, c.y, c.z, i.m11, i.m22, i.m33, i.m12, i.m13, i.m23]
}

/// Mass, first moments and moments about the origin, from moments about the centre of mass.
pub(in crate::arm::effects) fn about_origin(x: &[f64]) -> Vec<f64> {
    let mut all = [0.0; RIGID];
    all.iter_mut().zip(x).for_each(|(to, from)| *to = *from);
    let [mass, x, y, z, xx, yy, zz, xy, xz, yz] = all;
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    link_parameters(&Link { mass, com: Vector3::new(x, y, z), inertia }).to_vec()
}
