//! The moving bodies: links between one moving joint and the next.
//!
//! An inertia that no body has, as in many published files, is replaced by the nearest one.

use nalgebra::{Isometry3, Vector3};

use super::chain::Chain;
use super::document::Document;
use super::elements::{Inertial, Kind, Link};
use crate::arm::robot::error::RobotError;
use crate::arm::robot::link;

/// The body that a joint moves.
pub(super) struct Body {
    pub(super) link: link::Link,
    /// For each link of the body with an inertia that no body has: what is wrong, and how much was
    /// changed.
    pub(super) changes: Vec<String>,
}

/// One body per joint of the chain; empty if no moving link states its inertia.
///
/// # Errors
/// A mass and an inertia in different units, or some moving bodies without inertia.
pub(super) fn merged(document: &Document, chain: &Chain<'_>) -> Result<Vec<Body>, RobotError> {
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
    let mut all = Vec::with_capacity(bodies.len());
    for (joint, body) in chain.joints.iter().zip(bodies) {
        let link = &joint.child;
        all.push(body.ok_or_else(|| {
            let message = format!(
                "link \"{link}\" has no <inertial> while others have; add it, or leave it out of \
                 every link"
            );
            document.error(document.link(link).map_or(1, |link| link.line), message)
        })?);
    }
    Ok(all)
}

/// The body of all links fixed to a link, in its frame; `None` if none states its inertia.
fn body(document: &Document, link: &str) -> Result<Option<Body>, RobotError> {
    let mut sum: Option<link::Link> = None;
    let mut changes = Vec::new();
    let mut open = vec![(link.to_owned(), Isometry3::identity())];
    while let Some((name, placed)) = open.pop() {
        let link = document.link(&name).map(|link| stated(document, link)).transpose()?;
        if let Some((own, change)) = link.flatten() {
            let own = own.placed(&placed);
            changes.extend(change);
            sum = Some(match sum {
                Some(sum) => sum.joined(&own),
                None => own,
            });
        }
        for joint in document.joints_of(&name).filter(|joint| joint.kind == Kind::Fixed) {
            open.push((joint.child.clone(), placed * joint.placement));
        }
    }
    Ok(sum.map(|link| Body { link, changes }))
}

/// The body of a link in the link frame, and what was changed to make it one.
fn stated(
    document: &Document,
    link: &Link,
) -> Result<Option<(link::Link, Option<String>)>, RobotError> {
    let Some(Inertial { placement, mass, inertia }) = &link.inertial else { return Ok(None) };
    let given = link::Link { mass: *mass, com: Vector3::zeros(), inertia: *inertia };
    let body = given.nearest();
    if let Some(why) = body.impossible() {
        let name = &link.name;
        let message = format!(
            "the inertia of link \"{name}\": {why}; correct it, or leave <inertial> out of every \
             link"
        );
        return Err(document.error(link.line, message));
    }
    Ok(Some((body.placed(placement), change(link, &given, &body))))
}

/// What is wrong with a link, and how much the nearest body differs.
fn change(link: &Link, given: &link::Link, body: &link::Link) -> Option<String> {
    let Link { name, line, .. } = link;
    if let Some(why) = given.impossible() {
        let by = (body.inertia - given.inertia).norm();
        let share = 100.0 * by / given.inertia.norm();
        return Some(format!(
            "the inertia of link \"{name}\" in line {line}: {why}; the nearest body is used, which \
             differs by {by:.3e} kg m2 ({share:.2} %)"
        ));
    }
    let without = match given.thin_axes() {
        _ if given.mass == 0.0 => return None,
        3 => "no inertia; a point mass is used",
        1 => "no inertia about one of its axes; a thin rod is used",
        _ => return None,
    };
    Some(format!("link \"{name}\" in line {line} has {} kg, but {without}", given.mass))
}
