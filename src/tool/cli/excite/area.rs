//! Parses planes and boxes of options.

use anyhow::bail;
use nalgebra::{Point3, Vector3};

use crate::arm::kinematics::{KeepOut, Plane};
use crate::tool::cli::common::numbers;

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
