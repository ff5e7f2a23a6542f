//! The keep-outs of the configuration.

use anyhow::bail;
use nalgebra::{Point3, Vector3};

use crate::arm::kinematics::{self, Obstacle, Plane};
use crate::tool::config::{Config, KeepOut};

/// The keep-outs of a cell, in the base frame of its robot.
pub(super) fn keep_outs(config: &Config) -> anyhow::Result<Vec<Obstacle>> {
    config.keep_out.iter().map(obstacle).collect()
}

fn obstacle(part: &KeepOut) -> anyhow::Result<Obstacle> {
    match part {
        KeepOut::Box([one, other]) => {
            if one.iter().chain(other).any(|x| !x.is_finite()) {
                bail!("keep_out: box {one:?}, {other:?}: give two corners in m");
            }
            let corners = [one, other].map(|corner| Point3::from(*corner));
            Ok(Obstacle::KeepOut(kinematics::KeepOut::between(corners[0], corners[1])))
        }
        KeepOut::Plane([x, y, z, distance]) => {
            let normal = Vector3::new(*x, *y, *z);
            let size = normal.norm();
            if !(size > 0.0 && size.is_finite() && distance.is_finite()) {
                bail!(
                    "keep_out: plane [{x}, {y}, {z}, {distance}]: give a normal and a distance, m"
                );
            }
            Ok(Obstacle::Plane(Plane { normal: normal / size, distance: distance / size }))
        }
    }
}
