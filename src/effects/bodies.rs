//! Rigid bodies that are added to others.

use nalgebra::{Isometry3, Matrix3, Matrix4, Vector3};

use crate::robot::Link;

/// `link` with a body: mass, first moments, moments (xx, yy, zz, xy, xz, yz) about the origin of
/// `frame`, in its axes. The body may have a moment without a mass.
#[must_use]
pub fn added(link: &Link, frame: &Isometry3<f64>, body: &[f64]) -> Link {
    let to = frame.to_homogeneous();
    let sum = pseudo_inertia(&about_origin_of(link)) + to * pseudo_inertia(body) * to.transpose();
    let mass = sum[(3, 3)];
    let moment = Vector3::new(sum[(0, 3)], sum[(1, 3)], sum[(2, 3)]);
    let spread: Matrix3<f64> = sum.fixed_view::<3, 3>(0, 0).into_owned();
    let inertia = Matrix3::identity() * spread.trace() - spread;
    if mass == 0.0 {
        return Link { mass, com: link.com, inertia };
    }
    let com = moment / mass;
    Link { mass, com, inertia: inertia - steiner(&com) * mass }
}

/// Mass, centre, moments about it, of a body about an origin.
pub(super) fn about_centre(x: &[f64]) -> Vec<f64> {
    let [mass, rest @ ..] = padded(x);
    let moment = Vector3::new(rest[0], rest[1], rest[2]);
    let com = if mass == 0.0 { Vector3::zeros() } else { moment / mass };
    let inertia = symmetric(&rest[3..]) - steiner(&com) * mass;
    list(mass, com, &inertia)
}

/// Mass, first moments, moments about the origin, of a body about its centre.
pub(super) fn about_origin(x: &[f64]) -> Vec<f64> {
    let [mass, rest @ ..] = padded(x);
    let com = Vector3::new(rest[0], rest[1], rest[2]);
    let inertia = symmetric(&rest[3..]) + steiner(&com) * mass;
    list(mass, com * mass, &inertia)
}

fn about_origin_of(link: &Link) -> Vec<f64> {
    list(link.mass, link.com * link.mass, &(link.inertia + steiner(&link.com) * link.mass))
}

fn padded(x: &[f64]) -> [f64; 10] {
    let mut all = [0.0; 10];
    all.iter_mut().zip(x).for_each(|(to, from)| *to = *from);
    all
}

fn list(mass: f64, v: Vector3<f64>, i: &Matrix3<f64>) -> Vec<f64> {
    vec![mass, v.x, v.y, v.z, i.m11, i.m22, i.m33, i.m12, i.m13, i.m23]
}

fn symmetric(m: &[f64]) -> Matrix3<f64> {
    Matrix3::new(m[0], m[3], m[4], m[3], m[1], m[5], m[4], m[5], m[2])
}

fn steiner(d: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * d.norm_squared() - d * d.transpose()
}

/// [∫ r rᵀ dm, ∫ r dm; ·, m]: it moves with its frame as T J Tᵀ.
fn pseudo_inertia(x: &[f64]) -> Matrix4<f64> {
    let x = padded(x);
    let inertia = symmetric(&x[4..]);
    let spread = Matrix3::identity() * (0.5 * inertia.trace()) - inertia;
    let mut j = Matrix4::zeros();
    j.fixed_view_mut::<3, 3>(0, 0).copy_from(&spread);
    for k in 0..3 {
        j[(k, 3)] = x[1 + k];
        j[(3, k)] = x[1 + k];
    }
    j[(3, 3)] = x[0];
    j
}
