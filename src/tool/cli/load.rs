//! Parses the load at the flange from an option.

use anyhow::{Context, bail};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::arm::dynamics::Load;

/// Valid forms of a load.
const HELP: &str = "give the mass, such as 5; mass and centre of mass in tool0, kg and mm, \
                        such as 5,0,0,120; or a loaddata of RAPID, such as \
                        [5,[0,0,120],[1,0,0,0],0.01,0.01,0.02]";

/// The load of the option `--load`; no load by default.
pub(super) fn from_option(text: Option<&str>) -> anyhow::Result<Load> {
    text.map_or_else(|| Ok(Load::none()), |text| parse("--load", text))
}

/// Parses a load in RAPID units: kg, mm, kg m².
///
/// # Errors
/// There are not 1, 4 or 11 numbers, or they are physically impossible.
pub(super) fn parse(option: &str, text: &str) -> anyhow::Result<Load> {
    let wrong = || format!("{option} {text}: {HELP}");
    let plain: String = text.chars().filter(|c| !"[] ".contains(*c)).collect();
    let numbers: Result<Vec<f64>, _> = plain.split(',').map(str::parse::<f64>).collect();
    let numbers = numbers.ok().filter(|x| x.iter().all(|x| x.is_finite())).with_context(wrong)?;
    let (mass, com, axes, moments) = match *numbers.as_slice() {
        [mass] => (mass, [0.0; 3], [1.0, 0.0, 0.0, 0.0], [0.0; 3]),
        [mass, x, y, z] => (mass, [x, y, z], [1.0, 0.0, 0.0, 0.0], [0.0; 3]),
        [mass, x, y, z, w, i, j, k, ix, iy, iz] => (mass, [x, y, z], [w, i, j, k], [ix, iy, iz]),
        _ => bail!(wrong()),
    };
    if mass < 0.0 || moments.iter().any(|moment| *moment < 0.0) {
        bail!("{option} {text}: mass and moments of inertia are 0 or more");
    }
    let [w, i, j, k] = axes;
    let turn = UnitQuaternion::try_new(Quaternion::new(w, i, j, k), 1e-3)
        .with_context(|| {
            format!("{option} {text}: the orientation of the axes is not a unit quaternion")
        })?
        .to_rotation_matrix();
    let inertia =
        turn.matrix() * Matrix3::from_diagonal(&Vector3::from(moments)) * turn.matrix().transpose();
    Ok(Load { mass, com: Vector3::from(com) * 1e-3, inertia })
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::*;

    #[test]
    fn numbers_are_those_of_rapid() {
        assert_eq!(parse("--load", "5").unwrap().mass, 5.0);
        let short = parse("--load", "5,0,0,120").unwrap();
        assert_eq!(short.com, Vector3::new(0.0, 0.0, 0.12));
        // Rotated by 90° about z: x and y swap.
        let full = "[5,[0,0,120],[0.70710678,0,0,0.70710678],0.01,0.02,0.03]";
        let full = parse("--load", full).unwrap();
        assert!((full.inertia.diagonal() - Vector3::new(0.02, 0.01, 0.03)).norm() < 1e-9);
        for text in ["", "five", "5,1", "-5", "nan", "5,0,0,1e400", "[5,[0,0,0],[0,0,0,0],1,1,1]"] {
            assert!(parse("--load", text).is_err(), "{text}");
        }
    }
}
