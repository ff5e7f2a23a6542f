//! Parses planes, boxes and number lists of options.

use anyhow::{Context, bail};
use nalgebra::{Point3, Vector3};

use crate::arm::kinematics::{KeepOut, Plane};

/// Upper limit of any length, in m or mm.
const BEYOND: f64 = 1e6;

pub(super) fn plane(text: &str) -> anyhow::Result<Plane> {
    let help = "a normal and a distance in m, such as 1,0,0,-0.8";
    let [x, y, z, d] = numbers("--plane", text, help)?;
    let normal = Vector3::new(x, y, z);
    let length = normal.norm();
    if length < 1e-9 {
        bail!("--plane {text}: the normal is 0; give {help}");
    }
    Ok(Plane { normal: normal / length, distance: d / length })
}

pub(super) fn keep_out(text: &str) -> anyhow::Result<KeepOut> {
    let help = "two corners of a box in m, such as 0.8,-0.5,0,1.4,0.5,0.9";
    let [x, y, z, a, b, c] = numbers("--box", text, help)?;
    let keep_out = KeepOut::between(Point3::new(x, y, z), Point3::new(a, b, c));
    if keep_out.half.min() < 1e-9 {
        bail!("--box {text}: it has no volume; give {help}");
    }
    Ok(keep_out)
}

pub(super) fn numbers<const N: usize>(
    option: &str,
    text: &str,
    help: &str,
) -> anyhow::Result<[f64; N]> {
    let wrong = || format!("{option} {text}: give {help}");
    let values: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let values = values.ok().filter(|x| x.iter().all(|x: &f64| x.abs() < BEYOND));
    values.and_then(|x| <[f64; N]>::try_from(x).ok()).with_context(wrong)
}
