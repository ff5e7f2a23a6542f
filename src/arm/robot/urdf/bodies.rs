//! The moving bodies: the links behind a moving joint, up to the next one.

use nalgebra::{Isometry3, Matrix3, SymmetricEigen, Vector3};
use urdf_rs::{JointType, Link};

use super::chain::{Chain, isometry};
use super::document::Document;
use crate::arm::robot::error::RobotError;
use crate::arm::robot::link;

/// One body for each joint of the chain; none where no moving link states its inertia.
///
/// # Errors
/// A mass or an inertia that no body has, or some moving bodies have none.
pub(super) fn merged(
    document: &Document,
    chain: &Chain<'_>,
) -> Result<Vec<link::Link>, RobotError> {
    for link in &document.robot.links {
        stated(document, link)?;
    }
    let mut bodies = Vec::with_capacity(chain.joints.len());
    for joint in &chain.joints {
        bodies.push(body(document, &joint.child.link)?);
    }
    if bodies.iter().all(Option::is_none) {
        return Ok(Vec::new());
    }
    let mut links = Vec::with_capacity(bodies.len());
    for (joint, body) in chain.joints.iter().zip(bodies) {
        let link = &joint.child.link;
        links.push(body.ok_or_else(|| {
            let message = format!(
                "link \"{link}\" has no <inertial> while others have; add it, or leave it out of \
                 every link"
            );
            document.error("link", link, message)
        })?);
    }
    Ok(links)
}

/// What is fixed to a link, in the link's frame; `None` where nothing of it states its
/// inertia.
fn body(document: &Document, link: &str) -> Result<Option<link::Link>, RobotError> {
    let mut sum: Option<link::Link> = None;
    let mut open = vec![(link.to_owned(), Isometry3::identity())];
    while let Some((name, placed)) = open.pop() {
        if let Some(link) = document.link(&name).filter(|link| document.has_inertial(&link.name)) {
            let own = stated(document, link)?.placed(&placed);
            sum = Some(match sum {
                Some(sum) => sum.joined(&own),
                None => own,
            });
        }
        for joint in document.joints_of(&name).filter(|j| j.joint_type == JointType::Fixed) {
            open.push((joint.child.link.clone(), placed * isometry(&joint.origin)));
        }
    }
    Ok(sum)
}

/// The inertia that a link states, in its own frame.
fn stated(document: &Document, link: &Link) -> Result<link::Link, RobotError> {
    let mass = link.inertial.mass.value;
    let fail = |message: String| Err(document.error("link", &link.name, message));
    if !(mass >= 0.0 && mass.is_finite()) {
        return fail(format!("link \"{}\" has the mass {mass} kg; give 0 or more", link.name));
    }
    let i = &link.inertial.inertia;
    let inertia = Matrix3::new(i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz);
    if !inertia.iter().all(|entry| entry.is_finite()) {
        return fail(format!("link \"{}\" has an inertia that is not finite", link.name));
    }
    let least = SymmetricEigen::new(inertia).eigenvalues.min();
    // All zero is a point: what small parts are given.
    if inertia != Matrix3::zeros() && least <= 0.0 {
        return fail(format!(
            "the inertia of link \"{}\" is not positive definite (a principal moment is {least:.3e} \
             kg m2); correct it",
            link.name
        ));
    }
    let at_com = link::Link { mass, com: Vector3::zeros(), inertia };
    if let Some(why) = at_com.impossible() {
        return fail(format!(
            "the inertia of link \"{}\": {why}; correct it, or leave <inertial> out of every link",
            link.name
        ));
    }
    Ok(at_com.placed(&isometry(&link.inertial.origin)))
}
