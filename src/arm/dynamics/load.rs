//! Load at the flange.

use nalgebra::{Isometry3, Matrix3, Vector3};

use crate::arm::robot::{Link, Model};

/// Tool and payload together, in the tool0 frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub com: Vector3<f64>,
    /// Inertia about the centre of mass in the tool0 axes \[kg m²\].
    pub inertia: Matrix3<f64>,
}

impl Load {
    /// No load.
    #[must_use]
    pub fn none() -> Load {
        Load { mass: 0.0, com: Vector3::zeros(), inertia: Matrix3::zeros() }
    }

    /// This load and another one, as one rigid body.
    #[must_use]
    pub fn with(&self, other: &Load) -> Load {
        let merged =
            merge(&self.as_link(&Isometry3::identity()), &other.as_link(&Isometry3::identity()));
        Load { mass: merged.mass, com: merged.com, inertia: merged.inertia }
    }

    /// The last link of the robot with this load, in the link frame; `None` if the robot has no
    /// dynamics.
    pub(super) fn on(&self, model: &Model) -> Option<Link> {
        let last = model.links.last()?;
        if self.mass == 0.0 && self.inertia == Matrix3::zeros() {
            return Some(last.clone());
        }
        Some(merge(last, &self.as_link(&model.kinematics.flange)))
    }

    fn as_link(&self, frame: &Isometry3<f64>) -> Link {
        let rotation = frame.rotation.to_rotation_matrix();
        Link {
            mass: self.mass,
            com: rotation * self.com + frame.translation.vector,
            inertia: rotation.matrix() * self.inertia * rotation.matrix().transpose(),
        }
    }
}

/// Two rigid bodies of one frame as one body.
fn merge(a: &Link, b: &Link) -> Link {
    let mass = a.mass + b.mass;
    if mass <= 0.0 {
        return Link { mass, com: a.com, inertia: a.inertia + b.inertia };
    }
    let apart = b.com - a.com;
    let spread = Matrix3::identity() * apart.norm_squared() - apart * apart.transpose();
    Link {
        mass,
        com: (a.com * a.mass + b.com * b.mass) / mass,
        inertia: a.inertia + b.inertia + spread * (a.mass * b.mass / mass),
    }
}
