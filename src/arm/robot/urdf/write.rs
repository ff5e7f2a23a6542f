//! The chain as Robot TOML.

use std::f64::consts::TAU;
use std::fmt::Write;

use super::bodies::Body;
use super::chain::Chain;
use super::document::Document;
use super::elements::{Joint, Kind, Limit};
use crate::arm::robot::error::RobotError;
use crate::arm::robot::toml_text::{list, pose, quoted};

/// Range of a joint without limits \[rad\]: 100 turns to either side.
const CONTINUOUS: f64 = 100.0 * TAU;

pub(super) fn toml(
    document: &Document,
    chain: &Chain<'_>,
    bodies: &[Body],
) -> Result<String, RobotError> {
    let source = quoted(&document.file);
    let mut text =
        format!("name = {}\n\n[kinematics]\nsource = {source}\n", quoted(&document.name));
    let _ = write!(text, "\n[kinematics.flange]\n{}", pose(&chain.flange));
    for (joint, placement) in chain.joints.iter().zip(&chain.placements) {
        let _ =
            write!(text, "\n[[joint]] # {}\nsource = {source}\n", joint.name.replace('\n', " "));
        let _ = writeln!(text, "{}axis = {}", pose(placement), list(&joint.axis));
    }
    limits(document, chain, &mut text)?;
    for Body { link, changes } in bodies {
        let i = &link.inertia;
        let moments = [i.m11, i.m22, i.m33, i.m12, i.m13, i.m23];
        let _ = write!(
            text,
            "\n[[link]]\nsource = {source}\nmass = {:?}\ncom = {}\ninertia = {}\n",
            link.mass,
            list(link.com.as_slice()),
            list(&moments)
        );
        if !changes.is_empty() {
            let source = quoted(&format!("{}: {}", document.file, changes.join("; ")));
            let _ = writeln!(text, "inertia_source = {source}\ninertia_provenance = \"assumed\"");
        }
    }
    friction(document, chain, &mut text)?;
    motors(document, chain, &mut text)?;
    Ok(text)
}

fn limits(document: &Document, chain: &Chain<'_>, text: &mut String) -> Result<(), RobotError> {
    let _ = write!(text, "\n[limits]\nsource = {}\nposition = [\n", quoted(&document.file));
    for joint in &chain.joints {
        let [low, high] = match joint.kind {
            Kind::Continuous => [-CONTINUOUS, CONTINUOUS],
            _ => joint.limit.range,
        };
        let (low, high) = (low.max(-CONTINUOUS), high.min(CONTINUOUS));
        if low >= high {
            let message = format!(
                "joint \"{}\" has the range {low} to {high} rad; give <limit lower=\"…\" \
                 upper=\"…\"> with lower < upper",
                joint.name
            );
            return Err(document.error(joint.line, message));
        }
        let _ = writeln!(text, "  {},", list(&[low, high]));
    }
    text.push_str("]\n");
    let figures = |figure: fn(&Limit) -> f64| -> Vec<f64> {
        chain.joints.iter().map(|joint| figure(&joint.limit)).collect()
    };
    // 0 or no limit means unknown.
    for (key, values) in [
        ("velocity", figures(|limit| limit.velocity)),
        ("acceleration", figures(|limit| limit.acceleration)),
        ("jerk", figures(|limit| limit.jerk)),
        ("torque", figures(|limit| limit.effort)),
    ] {
        if values.iter().all(|value| value.is_finite() && *value > 0.0) {
            let _ = writeln!(text, "{key} = {}", list(&values));
        }
    }
    Ok(())
}

fn friction(document: &Document, chain: &Chain<'_>, text: &mut String) -> Result<(), RobotError> {
    if chain.joints.iter().all(|joint| joint.friction.is_none()) {
        return Ok(());
    }
    let mut coulomb = Vec::new();
    let mut viscous = Vec::new();
    for joint in &chain.joints {
        let [friction, damping] = joint.friction.unwrap_or_default();
        if friction < 0.0 || damping < 0.0 {
            let message = format!(
                "joint \"{}\" has the friction {friction} and the damping {damping}; give 0 or more",
                joint.name
            );
            return Err(document.error(joint.line, message));
        }
        coulomb.push(friction);
        viscous.push(damping);
    }
    let _ = write!(
        text,
        "\n[friction]\nsource = {}\ncoulomb = {}\nviscous = {}\n",
        quoted(&document.file),
        list(&coulomb),
        list(&viscous)
    );
    Ok(())
}

fn motors(document: &Document, chain: &Chain<'_>, text: &mut String) -> Result<(), RobotError> {
    let ratio = |joint: &&Joint| document.reductions.get(&joint.name).copied();
    if chain.joints.iter().all(|joint| ratio(joint).is_none()) {
        return Ok(());
    }
    let mut ratios = Vec::new();
    for joint in &chain.joints {
        ratios.push(ratio(joint).ok_or_else(|| {
            let message = format!(
                "joint \"{}\" has no <mechanicalReduction> while others have; add its transmission",
                joint.name
            );
            document.error(joint.line, message)
        })?);
    }
    let _ = write!(
        text,
        "\n[motors]\nsource = {}\nratio = {}\n",
        quoted(&document.file),
        list(&ratios)
    );
    Ok(())
}
