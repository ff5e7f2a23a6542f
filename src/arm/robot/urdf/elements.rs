//! The elements `<link>` and `<joint>`. Attributes must exist, be finite and have a plausible size.

use nalgebra::{Isometry3, Matrix3, Quaternion, UnitQuaternion, Vector3};
use roxmltree::Node;

use crate::arm::robot::fields::{MAX_BOUND, is_turn};
use crate::arm::robot::link::symmetric;

/// Largest distance between parts of a robot \[m\]; larger values are in millimetres.
const MAX_DISTANCE: f64 = 50.0;
/// Largest angle of a placement \[rad\]; larger values are in degrees.
const MAX_ANGLE: f64 = 13.0;
/// Largest mass of a body \[kg\].
const MAX_MASS: f64 = 1e5;
/// First URDF versions with quaternions, and with accelerations and other default limits.
const WITH_QUATERNIONS: (u32, u32) = (1, 1);
const WITH_ACCELERATIONS: (u32, u32) = (1, 2);

/// A wrong attribute: its element, and the error with a remedy.
pub(super) type Wrong<'a, 'i> = (Node<'a, 'i>, String);

/// A `<link>`.
pub(super) struct Link {
    pub(super) name: String,
    pub(super) line: usize,
    pub(super) inertial: Option<Inertial>,
}

/// An `<inertial>`: a body about its centre of mass.
pub(super) struct Inertial {
    /// Centre of mass and inertia axes in the link frame.
    pub(super) placement: Isometry3<f64>,
    /// kg.
    pub(super) mass: f64,
    /// kg m².
    pub(super) inertia: Matrix3<f64>,
}

/// Kinds of joints.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Revolute,
    Continuous,
    Fixed,
    /// Not modelled.
    Other,
}

/// A `<joint>`.
pub(super) struct Joint {
    pub(super) name: String,
    pub(super) line: usize,
    pub(super) kind: Kind,
    /// Names of the parent and child links.
    pub(super) parent: String,
    pub(super) child: String,
    /// The child frame in the parent frame at angle 0.
    pub(super) placement: Isometry3<f64>,
    pub(super) axis: [f64; 3],
    pub(super) limit: Limit,
    /// Coulomb \[Nm\] and viscous friction \[Nm s/rad\].
    pub(super) friction: Option<[f64; 2]>,
    /// Whether it follows another joint.
    pub(super) is_mimic: bool,
}

/// A `<limit>` \[rad, s, Nm\]; 0 or infinity means unknown.
pub(super) struct Limit {
    pub(super) range: [f64; 2],
    pub(super) effort: f64,
    pub(super) velocity: f64,
    pub(super) acceleration: f64,
    pub(super) jerk: f64,
}

/// The line of an element, from 1.
pub(super) fn line(node: Node<'_, '_>) -> usize {
    node.document().text_pos_at(node.range().start).row as usize
}

/// The first child with a tag.
pub(super) fn child<'a, 'i>(node: Node<'a, 'i>, tag: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.tag_name().name() == tag)
}

/// Reads a link without its shapes.
pub(super) fn read_link<'a, 'i>(link: Node<'a, 'i>) -> Result<Link, Wrong<'a, 'i>> {
    let name = name(link)?;
    let is_nameless = |node: &Node<'_, '_>| {
        node.tag_name().name() == "mesh" && node.attribute("filename").is_none()
    };
    if let Some(mesh) = link.descendants().find(is_nameless) {
        let message =
            format!("a <mesh> of {} has no filename; add it, or remove it", describe(link));
        return Err((mesh, message));
    }
    let inertial = child(link, "inertial").map(|inertial| read_inertial(link, inertial));
    Ok(Link { name, line: line(link), inertial: inertial.transpose()? })
}

fn read_inertial<'a, 'i>(
    link: Node<'a, 'i>,
    inertial: Node<'a, 'i>,
) -> Result<Inertial, Wrong<'a, 'i>> {
    let whose = describe(link);
    let part = |tag: &str| {
        child(inertial, tag).ok_or_else(|| {
            let message = format!(
                "the <inertial> of {whose} has no <{tag}>; add it, or leave <inertial> out of \
                 every link"
            );
            (inertial, message)
        })
    };
    let (mass, inertia) = (part("mass")?, part("inertia")?);
    let placement = placement(link, inertial)?;
    let kilograms = number(link, mass, "value", "kg")?;
    if !(0.0..=MAX_MASS).contains(&kilograms) {
        let message = format!("{whose} has the mass {kilograms:?} kg; give 0 to {MAX_MASS} kg");
        return Err((mass, message));
    }
    let mut moments = [0.0; 6];
    for (moment, key) in moments.iter_mut().zip(["ixx", "iyy", "izz", "ixy", "ixz", "iyz"]) {
        *moment = number(link, inertia, key, "kg m2")?;
    }
    Ok(Inertial { placement, mass: kilograms, inertia: symmetric(moments) })
}

/// Reads a joint.
pub(super) fn read_joint<'a, 'i>(joint: Node<'a, 'i>) -> Result<Joint, Wrong<'a, 'i>> {
    let name = name(joint)?;
    let whose = describe(joint);
    let kind = match joint.attribute("type") {
        Some("revolute") => Kind::Revolute,
        Some("continuous") => Kind::Continuous,
        Some("fixed") => Kind::Fixed,
        Some("prismatic" | "floating" | "planar") => Kind::Other,
        found => {
            let message = format!(
                "{whose} has the type \"{}\"; give revolute, continuous or fixed",
                found.unwrap_or_default()
            );
            return Err((joint, message));
        }
    };
    let end = |tag: &str| {
        let link = child(joint, tag).and_then(|node| node.attribute("link")).map(str::to_owned);
        link.ok_or_else(|| (joint, format!("{whose} has no <{tag} link=\"…\">; add it")))
    };
    let (parent, child_link) = (end("parent")?, end("child")?);
    let placement = placement(joint, joint)?;
    let mut axis = [1.0, 0.0, 0.0];
    if let Some(node) = child(joint, "axis") {
        axis = vector(joint, node, "xyz")?.unwrap_or(axis);
        let length = axis.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if kind != Kind::Fixed && !(1e-9..=1e9).contains(&length) {
            return Err((node, format!("the axis of {whose} is 0; give a direction")));
        }
    }
    let limit = read_limit(joint)?;
    let mut friction = None;
    if let Some(node) = child(joint, "dynamics") {
        let mut figures = [0.0; 2];
        for (figure, key) in figures.iter_mut().zip(["friction", "damping"]) {
            if node.attribute(key).is_some() {
                *figure = number(joint, node, key, "Nm or Nm s/rad")?;
            }
        }
        friction = Some(figures);
    }
    Ok(Joint {
        name,
        line: line(joint),
        kind,
        parent,
        child: child_link,
        placement,
        axis,
        limit,
        friction,
        is_mimic: child(joint, "mimic").is_some(),
    })
}

fn read_limit<'a, 'i>(joint: Node<'a, 'i>) -> Result<Limit, Wrong<'a, 'i>> {
    let mut limit = Limit {
        range: [0.0; 2],
        effort: 0.0,
        velocity: 0.0,
        acceleration: f64::INFINITY,
        jerk: f64::INFINITY,
    };
    let Some(node) = child(joint, "limit") else { return Ok(limit) };
    let whose = describe(joint);
    let is_unlimited = version(joint) >= WITH_ACCELERATIONS;
    let absent = if is_unlimited { f64::INFINITY } else { 0.0 };
    let figure = |name: &str, unit: &str, absent: f64| {
        let Some(text) = node.attribute(name) else { return Ok(absent) };
        let value = text.trim().parse().ok().filter(|value: &f64| !value.is_nan());
        let value = value.ok_or_else(|| not_a_number(joint, node, name, unit))?;
        if unit == "rad" && !is_turn(value) {
            let message = format!(
                "{whose} may turn to {value} rad; limits are in radians, at most \
                 {MAX_BOUND}: make it continuous, or turn degrees into radians"
            );
            return Err((node, message));
        }
        if unit != "rad" && value < 0.0 {
            let message = format!("{whose} has the {name} {value} {unit}; give 0 or more");
            return Err((node, message));
        }
        Ok(value)
    };
    limit.range = [figure("lower", "rad", 0.0 - absent)?, figure("upper", "rad", absent)?];
    limit.effort = figure("effort", "Nm", absent)?;
    if !is_unlimited && node.attribute("velocity").is_none() {
        return Err(not_a_number(joint, node, "velocity", "rad/s"));
    }
    limit.velocity = figure("velocity", "rad/s", absent)?;
    if is_unlimited {
        limit.acceleration = figure("acceleration", "rad/s2", absent)?;
        limit.jerk = figure("jerk", "rad/s3", absent)?;
    }
    Ok(limit)
}

/// The URDF version; default 1.0.
fn version(node: Node<'_, '_>) -> (u32, u32) {
    let text = node.document().root_element().attribute("version").unwrap_or_default();
    let parts = text.trim().split_once('.');
    parts.and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?))).unwrap_or((1, 0))
}

fn name<'a, 'i>(node: Node<'a, 'i>) -> Result<String, Wrong<'a, 'i>> {
    match node.attribute("name") {
        Some(name) if !name.trim().is_empty() => Ok(name.to_owned()),
        _ => Err((node, format!("a <{}> has no name; give it one", node.tag_name().name()))),
    }
}

/// The `<origin>` of the element `within`, a part of `whose`.
fn placement<'a, 'i>(
    whose: Node<'a, 'i>,
    within: Node<'a, 'i>,
) -> Result<Isometry3<f64>, Wrong<'a, 'i>> {
    let Some(origin) = child(within, "origin") else { return Ok(Isometry3::identity()) };
    let mut parts = [[0.0; 3]; 2];
    let bounds = [("xyz", MAX_DISTANCE, "metres"), ("rpy", MAX_ANGLE, "radians")];
    for (part, (name, most, unit)) in parts.iter_mut().zip(bounds) {
        let Some(value) = vector(whose, origin, name)? else { continue };
        if value.iter().any(|x| x.abs() > most) {
            let message = format!(
                "the origin of {} has {name} = {value:?}; it is in {unit}, at most {most}",
                describe(whose)
            );
            return Err((origin, message));
        }
        *part = value;
    }
    let [xyz, [roll, pitch, yaw]] = parts;
    let quaternion = if version(origin) < WITH_QUATERNIONS {
        None
    } else {
        vector::<4>(whose, origin, "quat_xyzw")?
    };
    let rotation = match quaternion {
        None => UnitQuaternion::from_euler_angles(roll, pitch, yaw),
        Some(_) if origin.attribute("rpy").is_some() => {
            let whose = describe(whose);
            return Err((
                origin,
                format!("the origin of {whose} has rpy and quat_xyzw; remove one"),
            ));
        }
        Some([x, y, z, w]) => {
            UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 0.0).unwrap_or_default()
        }
    };
    Ok(Isometry3::from_parts(Vector3::from(xyz).into(), rotation))
}

/// Finite numbers of an attribute, if present.
fn vector<'a, 'i, const N: usize>(
    whose: Node<'a, 'i>,
    node: Node<'a, 'i>,
    name: &str,
) -> Result<Option<[f64; N]>, Wrong<'a, 'i>> {
    let Some(text) = node.attribute(name) else { return Ok(None) };
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(finite).collect();
    if let Some(list) = numbers.and_then(|list| <[f64; N]>::try_from(list).ok()) {
        return Ok(Some(list));
    }
    let (tag, whose) = (node.tag_name().name(), describe(whose));
    let count = if N == 3 { "three" } else { "four" };
    Err((node, format!("<{tag} {name}=\"{text}\"> of {whose}: give {count} finite numbers")))
}

/// A finite number of an attribute.
fn number<'a, 'i>(
    whose: Node<'a, 'i>,
    node: Node<'a, 'i>,
    name: &str,
    unit: &str,
) -> Result<f64, Wrong<'a, 'i>> {
    finite(node.attribute(name).unwrap_or_default())
        .ok_or_else(|| not_a_number(whose, node, name, unit))
}

fn not_a_number<'a, 'i>(
    whose: Node<'a, 'i>,
    node: Node<'a, 'i>,
    name: &str,
    unit: &str,
) -> Wrong<'a, 'i> {
    let (tag, whose) = (node.tag_name().name(), describe(whose));
    let message = match node.attribute(name) {
        Some(text) => {
            format!("<{tag} {name}=\"{text}\"> of {whose}: give a finite number, in {unit}")
        }
        None => format!("<{tag}> of {whose} has no {name}; add it, in {unit}"),
    };
    (node, message)
}

fn finite(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|value: &f64| value.is_finite())
}

/// `joint "j1"`.
fn describe(node: Node<'_, '_>) -> String {
    format!("{} \"{}\"", node.tag_name().name(), node.attribute("name").unwrap_or_default())
}
