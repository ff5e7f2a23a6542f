//! Distances of the arm from its singularities.

use crate::arm::robot::Model;

use super::conf::Shape;

/// Distances from the three singularities of an arm with a spherical wrist; 0 in the singularity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Singularity {
    /// |sin q5|: axes 4 and 6 collinear.
    pub wrist: f64,
    /// |sin| of the elbow angle: upper arm, elbow and wrist centre collinear.
    pub elbow: f64,
    /// Distance of the wrist centre from the plane through axis 1 parallel to axis 2 \[m\].
    pub shoulder: f64,
}

/// The measures at the joint angles `q` \[rad\]; `None` without OPW kinematics.
#[must_use]
pub fn singularity(model: &Model, q: &[f64; 6]) -> Option<Singularity> {
    let opw = model.kinematics.opw.as_ref()?;
    let shape = Shape::at(model, q);
    Some(Singularity {
        wrist: (opw.signs[4] * q[4] - opw.offsets[4]).sin().abs(),
        elbow: shape.elbow.sin().abs(),
        shoulder: shape.reach.abs(),
    })
}
