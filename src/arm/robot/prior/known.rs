//! Known data of the robot body: the table of ABB robots and the robot file.

use nalgebra::{Matrix3, Vector3};

use serde::Deserialize;

use super::rules::{self, Size};
use crate::arm::robot::error::RobotError;
use crate::arm::robot::link::symmetric;
use crate::arm::robot::model::Model;
use crate::arm::robot::provenance::Provenance;

/// Numbers of joints of arms with a prior.
pub(super) const ARM: std::ops::RangeInclusive<usize> = 5..=7;

/// The tables, with sources.
const ROBOTS: &str = include_str!("robots.toml");

/// Standard deviation of the logarithm of the total mass by its source. A data sheet states whole
/// kilograms.
const MASS_SD: [(&str, f64); 4] =
    [("maker", 0.01), ("second hand", 0.02), ("memory", 0.05), ("guess", 0.08)];

/// Known data of the robot body; by default nothing.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    /// Total mass \[kg\], standard deviation of its logarithm, and source.
    pub(super) mass: Option<(f64, f64, String)>,
    /// kg.
    pub(super) payload: Option<f64>,
    /// m.
    pub(super) reach: Option<f64>,
    /// Mass of the fixed part \[kg\].
    pub(super) foot: Option<f64>,
    /// Links with their shares of the moving mass; empty without meshes.
    pub(super) links: Vec<Shape>,
    /// Whether the meshes are those of another variant.
    pub(super) sister: bool,
    /// Whether a spring or gas cylinder compensates a part of the gravity torque of axis 2.
    pub(super) balanced: bool,
    /// rad/s.
    pub(super) velocity: Option<(Vec<f64>, String)>,
}

/// A link without its mass, in the joint frame.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// Share of the moving mass.
    pub(super) share: f64,
    /// m.
    pub(super) com: Vector3<f64>,
    /// Moments about the centre of mass over the mass \[m²\].
    pub(super) gyration: Matrix3<f64>,
}

impl Known {
    /// The data of a robot by its type and its file.
    pub(super) fn from_model(model: &Model) -> Known {
        let text = table(type_name(model));
        let mut known = text.map_or_else(Known::default, Known::read);
        if let Some(mass) = model.mass {
            let origin = model.origin_of("", "mass");
            let sd = origin.and_then(|origin| origin.sd.as_ref()).map_or(0.01, |sd| sd[0] / mass);
            let source = origin.and_then(|origin| origin.source.clone());
            known.mass = Some((mass, sd, source.unwrap_or_else(|| "the robot's file".into())));
        }
        known.payload = model.payload.or(known.payload);
        known
    }

    fn read(text: &str) -> Known {
        let Ok(table) = toml::from_str::<Table>(text) else { return Known::default() };
        let sd = MASS_SD.iter().find(|(word, _)| *word == table.mass_trust);
        let shape = |[share, x, y, z, moments @ ..]: [f64; 10]| Shape {
            share,
            com: Vector3::new(x, y, z),
            gyration: symmetric(moments),
        };
        Known {
            mass: sd.map(|(_, sd)| (table.mass, *sd, table.mass_source)),
            payload: Some(table.payload),
            reach: Some(table.reach),
            foot: Some(table.foot),
            links: table.links.into_iter().map(shape).collect(),
            sister: table.sister,
            balanced: table.balanced,
            velocity: table.velocity.map(|velocity| (velocity, table.velocity_source)),
        }
    }

    /// The size of the robot; unknown parts are estimated from the known ones.
    pub(super) fn size(&self, model: &Model) -> Size {
        let reach = self.reach.unwrap_or_else(|| reach(model));
        let payload = self.payload;
        let mass = self.mass.as_ref().map(|(mass, ..)| *mass);
        let payload = payload.unwrap_or_else(|| rules::payload(mass, reach));
        Size { mass: mass.unwrap_or_else(|| rules::mass(reach, payload)), reach, payload }
    }
}

/// Accepted ratio of a stated mass to that of ABB robots of the same reach and payload, up or down;
/// the lightest commercial arms have a fifth.
const MAX_MASS_RATIO: f64 = 15.0;

/// Checks that the stated masses are possible for an arm of this reach; masses in a wrong unit are
/// not.
///
/// # Errors
/// A mass is out of range.
pub fn check_mass(model: &Model) -> Result<(), RobotError> {
    if !ARM.contains(&model.dof) {
        return Ok(());
    }
    let known = Known { mass: None, ..Known::from_model(model) };
    let Size { mass: usual, reach, .. } = known.size(model);
    let refused = |key: &str, value: f64, what: &str, [low, high]: [f64; 2]| RobotError::Value {
        place: model.file.clone().unwrap_or_else(|| model.name.clone()),
        key: key.into(),
        value: value.to_string(),
        must: format!(
            "{what} in kg, {low:.1} to {high:.0} for an arm of {reach:.2} m reach; leave it out if it is \
             not known"
        ),
    };
    let usual = [usual / MAX_MASS_RATIO, usual * MAX_MASS_RATIO];
    let [low, high] = usual;
    if let Some(mass) = model.mass.filter(|mass| !(low..=high).contains(mass)) {
        return Err(refused("mass", mass, "the mass of the whole robot", usual));
    }
    // The moving mass is a part of the total mass.
    let moving: f64 = model.links.iter().map(|link| link.mass).sum();
    let usual = [LEAST_MOVING * low, high];
    if !model.links.is_empty() && !(usual[0]..=usual[1]).contains(&moving) {
        return Err(refused("[[link]] mass", moving, "the mass of all links together", usual));
    }
    Ok(())
}

/// Smallest share of the moving mass in the total mass.
const LEAST_MOVING: f64 = 0.3;

/// The type of a robot: its name if the table contains it, otherwise the type in its file.
#[must_use]
pub fn type_name(model: &Model) -> &str {
    let stated = model.type_name.as_ref().filter(|_| table(&model.name).is_none());
    stated.unwrap_or(&model.name)
}

/// Whether the mass of the whole robot is known.
#[must_use]
pub fn is_mass_known(model: &Model) -> bool {
    let provenance = |i| model.provenance_of(&format!("link {i}"), "mass");
    let is_stated = |i| provenance(i) != Some(Provenance::Estimated);
    Known::from_model(model).mass.is_some() || (1..=model.links.len()).any(is_stated)
}

/// Distance from axis 1 to the wrist centre of the stretched arm \[m\].
fn reach(model: &Model) -> f64 {
    let joints = &model.kinematics.joints;
    let foot = joints.get(1).map_or(0.0, |joint| joint.translation.xy().norm());
    let wrist = joints.len() - 1;
    let arm: f64 = joints[2..wrist].iter().map(|joint| joint.translation.norm()).sum();
    foot + arm
}

/// The table of a robot in the file.
#[derive(Deserialize)]
struct Table {
    mass: f64,
    mass_trust: String,
    mass_source: String,
    payload: f64,
    reach: f64,
    foot: f64,
    #[serde(default)]
    sister: bool,
    #[serde(default)]
    balanced: bool,
    velocity: Option<Vec<f64>>,
    #[serde(default)]
    velocity_source: String,
    links: Vec<[f64; 10]>,
}

/// The text of the table of a robot without its header.
fn table(name: &str) -> Option<&'static str> {
    let (_, rest) = ROBOTS.split_once(&format!("\n[\"{name}\"]\n"))?;
    let end = rest.find("\n[\"").unwrap_or(rest.len());
    Some(&rest[..end])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::robot::{find, names};

    #[test]
    fn arms_of_the_catalogue_have_their_table() {
        for name in names().filter(|name| !name.starts_with("IRB14000")) {
            let known = Known::from_model(&find(name).expect("in the catalogue"));
            assert!(known.mass.is_some() && known.payload.is_some(), "{name}");
            let shares: f64 = known.links.iter().map(|link| link.share).sum();
            assert!((shares - 1.0).abs() < 1e-3, "{name}: {shares}");
        }
    }
}
