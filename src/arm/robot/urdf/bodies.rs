//! The moving bodies: links between one moving joint and the next.

use nalgebra::{Isometry3, Matrix3, SymmetricEigen, Vector3};

use super::chain::Chain;
use super::document::Document;
use super::elements::{Inertial, Kind, Link};
use crate::arm::robot::error::RobotError;
use crate::arm::robot::link;

/// One body per joint of the chain; empty if no moving link states its inertia.
///
/// # Errors
/// An impossible mass or inertia, or some moving bodies without one.
pub(super) fn merged(
    document: &Document,
    chain: &Chain<'_>,
) -> Result<Vec<link::Link>, RobotError> {
    for link in &document.links {
        stated(document, link)?;
    }
    let mut bodies = Vec::with_capacity(chain.joints.len());
    for joint in &chain.joints {
        bodies.push(body(document, &joint.child)?);
    }
    if bodies.iter().all(Option::is_none) {
        return Ok(Vec::new());
    }
    let mut links = Vec::with_capacity(bodies.len());
    for (joint, body) in chain.joints.iter().zip(bodies) {
        let link = &joint.child;
        links.push(body.ok_or_else(|| {
            let message = format!(
                "link \"{link}\" has no <inertial> while others have; add it, or leave it out of \
                 every link"
            );
            document.error(document.link(link).map_or(1, |link| link.line), message)
        })?);
    }
    Ok(links)
}

/// The body of all links fixed to a link, in its frame; `None` if none states its inertia.
fn body(document: &Document, link: &str) -> Result<Option<link::Link>, RobotError> {
    let mut sum: Option<link::Link> = None;
    let mut open = vec![(link.to_owned(), Isometry3::identity())];
    while let Some((name, placed)) = open.pop() {
        let link = document.link(&name).map(|link| stated(document, link)).transpose()?;
        if let Some(own) = link.flatten().map(|own| own.placed(&placed)) {
            sum = Some(match sum {
                Some(sum) => sum.joined(&own),
                None => own,
            });
        }
        for joint in document.joints_of(&name).filter(|joint| joint.kind == Kind::Fixed) {
            open.push((joint.child.clone(), placed * joint.placement));
        }
    }
    Ok(sum)
}

/// The stated body of a link, in the link frame.
fn stated(document: &Document, link: &Link) -> Result<Option<link::Link>, RobotError> {
    let Some(Inertial { placement, mass, inertia }) = &link.inertial else { return Ok(None) };
    let fail = |message: String| Err(document.error(link.line, message));
    let least = SymmetricEigen::new(*inertia).eigenvalues.min();
    // Zero inertia is accepted: a point mass for small parts.
    if *inertia != Matrix3::zeros() && least <= 0.0 {
        return fail(format!(
            "the inertia of link \"{}\" is not positive definite (a principal moment is {least:.3e} \
             kg m2); correct it",
            link.name
        ));
    }
    let at_com = link::Link { mass: *mass, com: Vector3::zeros(), inertia: *inertia };
    if let Some(why) = at_com.impossible() {
        return fail(format!(
            "the inertia of link \"{}\": {why}; correct it, or leave <inertial> out of every link",
            link.name
        ));
    }
    Ok(Some(at_com.placed(placement)))
}
