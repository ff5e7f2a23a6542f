//! The cell in which a motion runs, from options.

use anyhow::bail;
use nalgebra::{Point3, Vector3};

use super::args::ExperimentArgs;
use crate::arm::dynamics::Load;
use crate::arm::kinematics::{KeepOut, Obstacle, Plane};
use crate::arm::robot::Model;
use crate::tool::cli::common::{self, numbers};
use crate::tool::cli::load;

/// Upper limit of any number in an option: m, mm or degrees.
pub(super) const MAX_NUMBER: f64 = 1e6;

pub(super) fn plane(text: &str) -> anyhow::Result<Plane> {
    let help = "a normal and a distance in m, such as 1,0,0,-0.8";
    let [x, y, z, d] = numbers("--plane", text, MAX_NUMBER, help)?;
    let normal = Vector3::new(x, y, z);
    let length = normal.norm();
    if length < 1e-9 {
        bail!("--plane {text}: the normal is 0; give {help}");
    }
    Ok(Plane { normal: normal / length, distance: d / length })
}

pub(super) fn keep_out(text: &str) -> anyhow::Result<KeepOut> {
    let help = "two corners of a box in m, such as 0.8,-0.5,0,1.4,0.5,0.9";
    let [x, y, z, a, b, c] = numbers("--box", text, MAX_NUMBER, help)?;
    let keep_out = KeepOut::between(Point3::new(x, y, z), Point3::new(a, b, c));
    if keep_out.half.min() < 1e-9 {
        bail!("--box {text}: it has no volume; give {help}");
    }
    Ok(keep_out)
}

/// The cell in which a motion runs.
pub(in crate::tool::cli) struct Cell {
    pub(in crate::tool::cli) obstacles: Vec<Obstacle>,
    /// Tool centre point in tool0 \[m\].
    pub(in crate::tool::cli) tool: Vector3<f64>,
    pub(in crate::tool::cli) load: Load,
}

pub(in crate::tool::cli) fn cell(args: &ExperimentArgs, model: &Model) -> anyhow::Result<Cell> {
    let planes = args.planes.iter().map(|text| Ok(Obstacle::Plane(plane(text)?)));
    let boxes = args.boxes.iter().map(|text| Ok(Obstacle::KeepOut(keep_out(text)?)));
    let mut obstacles: Vec<Obstacle> = planes.chain(boxes).collect::<anyhow::Result<_>>()?;
    obstacles.extend(floor(model));
    let tool = match &args.tool {
        Some(text) => {
            let [x, y, z] = common::numbers(
                "--tool",
                text,
                MAX_NUMBER,
                "three lengths in mm, such as 0,0,250",
            )?;
            Vector3::new(x, y, z) * 1e-3
        }
        None => Vector3::zeros(),
    };
    Ok(Cell { obstacles, tool, load: load::from_option(args.load.as_deref())? })
}

/// The floor as an obstacle; `None` for a hanging or inclined robot.
pub(in crate::tool::cli) fn floor(model: &Model) -> Option<Obstacle> {
    let base = &model.kinematics.base;
    let distance = -base.translation.z;
    let stands = base.rotation.angle() < 1e-6;
    stands.then_some(Obstacle::Plane(Plane { normal: Vector3::z(), distance }))
}
