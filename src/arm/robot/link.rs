//! Mass, centre of mass and inertia of a link.

use nalgebra::{Isometry3, Matrix3, SymmetricEigen, Vector3};

use super::error::RobotError;
use super::fields::{Accepts, Fields, LENGTH};

/// Tolerance of consistency relative to the largest principal moment: rounding of printed numbers.
const ROUNDING: f64 = 1e-9;

/// Largest radius of gyration of a part of a robot \[m\].
const MAX_GYRATION_RADIUS: f64 = 5.0;

/// Masses \[kg\].
pub(super) const MASS: Accepts = Accepts::Between(0.0, 1e5, "0 or more and at most 100000, in kg");

/// The rigid body moved by one joint, in the joint frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub com: Vector3<f64>,
    /// Inertia about the centre of mass, in the joint frame axes \[kg m²\].
    pub inertia: Matrix3<f64>,
}

impl Link {
    /// Whether a distribution of positive mass can have this inertia: no principal moment is
    /// negative or exceeds the sum of the other two.
    #[must_use]
    pub fn is_consistent(&self) -> bool {
        let moments = principal_moments(&self.inertia);
        let slack = ROUNDING * moments[2];
        self.mass >= 0.0 && moments[0] >= -slack && moments[2] <= moments[0] + moments[1] + slack
    }

    /// Reason why no body can have this mass and inertia, if so, with the moments.
    #[must_use]
    pub fn impossible(&self) -> Option<String> {
        let [a, b, c] = principal_moments(&self.inertia);
        if !self.is_consistent() {
            return Some(format!(
                "no body has the principal moments {a:.3e}, {b:.3e} and {c:.3e} kg m2 (none is \
                 negative or exceeds the sum of the other two)"
            ));
        }
        let radius = (c / self.mass).sqrt();
        (self.mass > 0.0 && radius > MAX_GYRATION_RADIUS).then(|| {
            format!(
                "a moment of {c:.3e} kg m2 puts the {} kg at {radius:.1} m from the axis (kg mm2 \
                 would be a million times more)",
                self.mass
            )
        })
    }

    /// Number of principal moments that are 0: one of a thin rod, three of a point mass.
    pub(super) fn thin_axes(&self) -> usize {
        let moments = principal_moments(&self.inertia);
        moments.iter().filter(|moment| **moment <= ROUNDING * moments[2]).count()
    }

    /// The body with the nearest inertia that a distribution of positive mass can have; nearest in
    /// the Frobenius norm.
    pub(super) fn nearest(&self) -> Link {
        if self.is_consistent() {
            return self.clone();
        }
        let SymmetricEigen { eigenvectors: axes, eigenvalues: moments } =
            SymmetricEigen::new(self.inertia);
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| moments[*a].total_cmp(&moments[*b]));
        let mut nearest = Vector3::zeros();
        for (axis, moment) in order.into_iter().zip(nearest_moments(order.map(|k| moments[k]))) {
            nearest[axis] = moment;
        }
        let inertia = axes * Matrix3::from_diagonal(&nearest) * axes.transpose();
        Link { inertia, ..self.clone() }
    }

    /// The body in the parent frame of its frame.
    pub(super) fn placed(&self, placed: &Isometry3<f64>) -> Link {
        let r = placed.rotation.to_rotation_matrix();
        Link {
            mass: self.mass,
            com: placed.transform_point(&self.com.into()).coords,
            inertia: r.matrix() * self.inertia * r.matrix().transpose(),
        }
    }

    /// Both bodies as one.
    pub(super) fn joined(&self, other: &Link) -> Link {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return Link { inertia: self.inertia + other.inertia, ..self.clone() };
        }
        let com = (self.com * self.mass + other.com * other.mass) / mass;
        let about = |body: &Link| {
            let d = body.com - com;
            let steiner = Matrix3::identity() * d.norm_squared() - d * d.transpose();
            body.inertia + steiner * body.mass
        };
        Link { mass, com, inertia: about(self) + about(other) }
    }

    pub(super) fn read(fields: &mut Fields) -> Result<Link, RobotError> {
        let mass = fields.must("mass", |f, key| f.number(key, MASS))?;
        let com: [f64; 3] = fields.must("com", |f, key| f.array(key, LENGTH))?;
        let moments = fields.must("inertia", |f, key| f.array(key, Accepts::Finite))?;
        let inertia = symmetric(moments);
        let principal = principal_moments(&inertia);
        if principal[0] < -ROUNDING * principal[2].abs() {
            return Err(RobotError::Value {
                place: fields.place(),
                key: fields.path("inertia"),
                value: format!("{moments:?}"),
                must: format!(
                    "positive semidefinite (a principal moment is {:.3} kg m2); \
                     the order is xx, yy, zz, xy, xz, yz",
                    principal[0]
                ),
            });
        }
        Ok(Link { mass, com: Vector3::from(com), inertia })
    }
}

/// A part mounted on a link, such as a valve block on the upper arm, in a table of the robot: the
/// joint that moves it, from 0, and the body in the frame of that joint.
pub(super) fn arm_load(
    robot: &mut Fields,
    table: Fields,
    dof: usize,
) -> Result<(usize, Link), RobotError> {
    let (place, key) = (table.place_of("inertia"), table.path("inertia"));
    let read = |fields: &mut Fields| Ok((fields.joint("joint", dof)?, Link::read(fields)?));
    let (joint, body) = robot.read_whole(table, read)?;
    match body.impossible() {
        None => Ok((joint, body)),
        Some(why) => Err(RobotError::Value {
            place,
            key,
            value: "[…]".into(),
            must: format!("that of a body: {why}"),
        }),
    }
}

/// The matrix of `[xx, yy, zz, xy, xz, yz]`; the last three are the entries, not negated.
pub(super) fn symmetric([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// The principal moments of a body nearest to three ascending numbers, one of which is negative or
/// exceeds the sum of the other two.
fn nearest_moments([a, b, c]: [f64; 3]) -> [f64; 3] {
    // On the plane a + b = c are the bodies without extent along the third axis.
    let excess = (c - a - b) / 3.0;
    if a + excess >= 0.0 {
        return [a + excess, b + excess, c - excess];
    }
    // A rod has no moment about its own axis.
    let across = f64::midpoint(b, c).max(0.0);
    [0.0, across, across]
}

fn principal_moments(inertia: &Matrix3<f64>) -> [f64; 3] {
    let mut moments: [f64; 3] = SymmetricEigen::new(*inertia).eigenvalues.into();
    moments.sort_by(f64::total_cmp);
    moments
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The conditions of the nearest point of a cone: it is in the cone, and the rest is orthogonal
    /// to it and not towards any edge.
    #[test]
    fn the_nearest_body_is_the_nearest() {
        for moments in [
            [0.02, 0.02, 0.05],
            [-0.01, 0.02, 0.02],
            [-0.05, 0.01, 0.02],
            [0.0, 0.0, 0.3],
            [-0.3, -0.2, -0.1],
            [-0.3, -0.2, 0.1],
            [-0.2, 0.1, 0.12],
        ] {
            let given = Vector3::from(moments);
            let nearest = Vector3::from(nearest_moments(moments));
            let [a, b, c] = nearest.into();
            assert!(a >= 0.0 && a <= b && b <= c && c <= a + b + 1e-15, "{nearest}");
            let rest = given - nearest;
            assert!(rest.dot(&nearest).abs() < 1e-15, "{moments:?}");
            for edge in [[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]] {
                assert!(rest.dot(&Vector3::from(edge)) < 1e-15, "{moments:?}");
            }
        }
    }
}
