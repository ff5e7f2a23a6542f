//! The attributes of links and joints: there, finite, and of a plausible size.

use roxmltree::Node;

/// Deepest nesting of elements; a URDF needs five.
const MAX_DEPTH: usize = 64;
/// No part of a robot lies farther from another \[m\]: beyond are millimetres.
const FARTHEST: f64 = 50.0;
/// No angle of a placement is larger \[rad\]: beyond are degrees.
const LARGEST_ANGLE: f64 = 13.0;
/// No joint turns farther \[rad\] unless it is endless: beyond are degrees.
const FARTHEST_TURN: f64 = 50.0;
/// Ranges beyond this stand for endless joints \[rad\].
const ENDLESS: f64 = 600.0;
/// No body weighs more \[kg\].
const HEAVIEST: f64 = 1e5;

/// A wrong attribute: the element, and what is wrong with it and the way out.
pub(super) type Wrong<'a, 'i> = (Node<'a, 'i>, String);

/// The line at which elements are nested too deep to be read.
pub(super) fn too_deep(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    for (i, byte) in bytes.iter().enumerate() {
        match (byte, bytes.get(i + 1)) {
            (b'<', Some(b'/')) | (b'/', Some(b'>')) => depth = depth.saturating_sub(1),
            (b'<', Some(next)) if next.is_ascii_alphabetic() => depth += 1,
            _ => {}
        }
        if depth > MAX_DEPTH {
            return Some(1 + text[..i].matches('\n').count());
        }
    }
    None
}

/// Checks a link's `<inertial>`.
pub(super) fn check_link<'a, 'i>(link: Node<'a, 'i>) -> Result<(), Wrong<'a, 'i>> {
    named(link)?;
    let is_nameless = |node: &Node<'_, '_>| {
        node.tag_name().name() == "mesh" && node.attribute("filename").is_none()
    };
    if let Some(mesh) = link.descendants().find(is_nameless) {
        let message =
            format!("a <mesh> of {} has no filename; add it, or remove it", describe(link));
        return Err((mesh, message));
    }
    let Some(inertial) = child(link, "inertial") else { return Ok(()) };
    let whose = describe(link);
    for part in ["mass", "inertia"] {
        if child(inertial, part).is_none() {
            let message = format!(
                "the <inertial> of {whose} has no <{part}>; add it, or leave <inertial> out of \
                 every link"
            );
            return Err((inertial, message));
        }
    }
    placement(link, inertial)?;
    if let Some(mass) = child(inertial, "mass") {
        let value = number(link, mass, "value", "kg")?;
        if !(0.0..=HEAVIEST).contains(&value) {
            let message = format!("{whose} has the mass {value:?} kg; give 0 to {HEAVIEST} kg");
            return Err((mass, message));
        }
    }
    if let Some(inertia) = child(inertial, "inertia") {
        for moment in ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"] {
            number(link, inertia, moment, "kg m2")?;
        }
    }
    Ok(())
}

/// Checks a joint's elements.
pub(super) fn check_joint<'a, 'i>(joint: Node<'a, 'i>) -> Result<(), Wrong<'a, 'i>> {
    named(joint)?;
    let whose = describe(joint);
    let kinds = ["revolute", "continuous", "fixed", "prismatic", "floating", "planar"];
    match joint.attribute("type") {
        Some(kind) if kinds.contains(&kind) => {}
        found => {
            let message = format!(
                "{whose} has the type \"{}\"; give revolute, continuous or fixed",
                found.unwrap_or_default()
            );
            return Err((joint, message));
        }
    }
    for end in ["parent", "child"] {
        if child(joint, end).is_none_or(|node| node.attribute("link").is_none()) {
            return Err((joint, format!("{whose} has no <{end} link=\"…\">; add it")));
        }
    }
    placement(joint, joint)?;
    if let Some(axis) = child(joint, "axis") {
        let of = vector(joint, axis, "xyz")?.unwrap_or([1.0, 0.0, 0.0]);
        let length = of.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let endless = joint.attribute("type") != Some("fixed");
        if endless && !(1e-9..=1e9).contains(&length) {
            return Err((axis, format!("the axis of {whose} is 0; give a direction")));
        }
    }
    if let Some(limit) = child(joint, "limit") {
        for (name, unit) in
            [("lower", "rad"), ("upper", "rad"), ("effort", "Nm"), ("velocity", "rad/s")]
        {
            if limit.attribute(name).is_none() {
                continue;
            }
            let value = optional_infinite(joint, limit, name, unit)?;
            if unit == "rad" && value.abs() > FARTHEST_TURN && value.abs() < ENDLESS {
                let message = format!(
                    "{whose} may turn to {value} rad; limits are in radians, at most \
                     {FARTHEST_TURN}: make it continuous, or turn degrees into radians"
                );
                return Err((limit, message));
            }
            if unit != "rad" && value < 0.0 {
                let message = format!("{whose} has the {name} {value} {unit}; give 0 or more");
                return Err((limit, message));
            }
        }
    }
    if let Some(dynamics) = child(joint, "dynamics") {
        for name in ["friction", "damping"] {
            if dynamics.attribute(name).is_some() {
                number(joint, dynamics, name, "Nm or Nm s/rad")?;
            }
        }
    }
    Ok(())
}

fn named<'a, 'i>(node: Node<'a, 'i>) -> Result<(), Wrong<'a, 'i>> {
    match node.attribute("name") {
        Some(name) if !name.trim().is_empty() => Ok(()),
        _ => Err((node, format!("a <{}> has no name; give it one", node.tag_name().name()))),
    }
}

/// The `<origin>` of an element.
fn placement<'a, 'i>(of: Node<'a, 'i>, within: Node<'a, 'i>) -> Result<(), Wrong<'a, 'i>> {
    let Some(origin) = child(within, "origin") else { return Ok(()) };
    for (name, most, unit) in [("xyz", FARTHEST, "metres"), ("rpy", LARGEST_ANGLE, "radians")] {
        let Some(value) = vector(of, origin, name)? else { continue };
        if value.iter().any(|x| x.abs() > most) {
            let message = format!(
                "the origin of {} has {name} = {value:?}; it is in {unit}, at most {most}",
                describe(of)
            );
            return Err((origin, message));
        }
    }
    Ok(())
}

/// Three finite numbers of an attribute, where it is there.
fn vector<'a, 'i>(
    of: Node<'a, 'i>,
    node: Node<'a, 'i>,
    name: &str,
) -> Result<Option<[f64; 3]>, Wrong<'a, 'i>> {
    let Some(text) = node.attribute(name) else { return Ok(None) };
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(finite).collect();
    if let Some(list) = numbers.and_then(|list| <[f64; 3]>::try_from(list).ok()) {
        return Ok(Some(list));
    }
    let (tag, whose) = (node.tag_name().name(), describe(of));
    Err((node, format!("<{tag} {name}=\"{text}\"> of {whose}: give three finite numbers")))
}

/// A finite number of an attribute.
fn number<'a, 'i>(
    of: Node<'a, 'i>,
    node: Node<'a, 'i>,
    name: &str,
    unit: &str,
) -> Result<f64, Wrong<'a, 'i>> {
    finite(node.attribute(name).unwrap_or_default())
        .ok_or_else(|| not_a_number(of, node, name, unit))
}

/// A number of an attribute that may be infinite: no limit.
fn optional_infinite<'a, 'i>(
    of: Node<'a, 'i>,
    node: Node<'a, 'i>,
    name: &str,
    unit: &str,
) -> Result<f64, Wrong<'a, 'i>> {
    let text = node.attribute(name).unwrap_or_default();
    let value = text.trim().parse().ok().filter(|value: &f64| !value.is_nan());
    value.ok_or_else(|| not_a_number(of, node, name, unit))
}

fn not_a_number<'a, 'i>(
    of: Node<'a, 'i>,
    node: Node<'a, 'i>,
    name: &str,
    unit: &str,
) -> Wrong<'a, 'i> {
    let (tag, whose) = (node.tag_name().name(), describe(of));
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

fn child<'a, 'i>(node: Node<'a, 'i>, tag: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.tag_name().name() == tag)
}
