//! The chain of moving joints from the root to the flange.

use nalgebra::Isometry3;

use super::document::Document;
use super::elements::{Joint, Kind, Link};
use crate::arm::robot::error::RobotError;
use crate::arm::robot::geometry::MAX_DOF;

/// End links of the chain in order of preference.
const ENDS: [&str; 2] = ["tool0", "flange"];

/// The moving joints with the fixed transformations between them.
pub(super) struct Chain<'d> {
    /// Moving joints from the root on.
    pub(super) joints: Vec<&'d Joint>,
    /// Placement of each in the frame of the previous moving joint.
    pub(super) placements: Vec<Isometry3<f64>>,
    /// The end link in the frame of the last moving joint.
    pub(super) flange: Isometry3<f64>,
}

impl<'d> Chain<'d> {
    pub(super) fn find(document: &'d Document) -> Result<Chain<'d>, RobotError> {
        let root = root(document)?;
        let path = path(document, &root.name)?;
        let mut chain =
            Chain { joints: Vec::new(), placements: Vec::new(), flange: Isometry3::identity() };
        let mut fixed = Isometry3::identity();
        for joint in path {
            let placed = fixed * joint.placement;
            if joint.kind == Kind::Fixed {
                fixed = placed;
                continue;
            }
            check_modelled(document, joint)?;
            if chain.joints.len() == MAX_DOF {
                let message = format!(
                    "joint \"{}\" is the eighth moving one of the chain; at most {MAX_DOF} are \
                     modelled: make the others fixed, or name the end of the arm tool0",
                    joint.name
                );
                return Err(document.error(joint.line, message));
            }
            chain.placements.push(placed);
            chain.joints.push(joint);
            fixed = Isometry3::identity();
        }
        if chain.joints.is_empty() {
            let message = "the chain has no moving joint; name the end of the arm tool0".into();
            return Err(document.error(root.line, message));
        }
        chain.flange = fixed;
        for joint in &document.joints {
            check_outside_chain(document, &chain, joint)?;
        }
        Ok(chain)
    }
}

/// The only link without a parent joint; all others must have exactly one.
fn root(document: &Document) -> Result<&Link, RobotError> {
    for joint in &document.joints {
        for link in [&joint.parent, &joint.child] {
            if document.link(link).is_none() {
                let message = format!(
                    "joint \"{}\" names the link \"{link}\", which is not there; add it",
                    joint.name
                );
                return Err(document.error(joint.line, message));
            }
        }
        let first = document.joints.iter().find(|other| other.child == joint.child);
        if let Some(first) = first.filter(|first| first.name != joint.name) {
            let message = format!(
                "a loop: link \"{}\" hangs from joint \"{}\" and from joint \"{}\"; remove one, \
                 only trees are modelled",
                joint.child, first.name, joint.name
            );
            return Err(document.error(joint.line, message));
        }
    }
    let is_child = |link: &str| document.joints.iter().any(|joint| joint.child == link);
    let mut roots = document.links.iter().filter(|link| !is_child(&link.name));
    let Some(root) = roots.next() else {
        let line = document.joints.first().map_or(1, |joint| joint.line);
        let message =
            "a loop: every link hangs from a joint, so there is no base; remove one joint";
        return Err(document.error(line, message.into()));
    };
    if let Some(other) = roots.next() {
        let message = format!(
            "link \"{}\" does not hang from the base \"{}\"; add a joint to it",
            other.name, root.name
        );
        return Err(document.error(other.line, message));
    }
    // Each link has one parent and there is one root, so unreached links form a loop.
    let reached = document.links_from(&root.name);
    let lost = document.joints.iter().find(|joint| !reached.contains(&joint.child.as_str()));
    if let Some(joint) = lost {
        let message = format!(
            "a loop: link \"{}\" hangs from itself by joint \"{}\"; remove one joint of the loop",
            joint.child, joint.name
        );
        return Err(document.error(joint.line, message));
    }
    Ok(root)
}

/// The joints from the root to the end link.
fn path<'d>(document: &'d Document, root: &str) -> Result<Vec<&'d Joint>, RobotError> {
    let up = |link: &str| {
        let mut path = Vec::new();
        let mut link = link.to_owned();
        while let Some(joint) = document.joints.iter().find(|joint| joint.child == link) {
            path.push(joint);
            link.clone_from(&joint.parent);
        }
        path.reverse();
        path
    };
    if let Some(end) = ENDS.into_iter().find(|end| document.link(end).is_some()) {
        return Ok(up(end));
    }
    // The moving joint of largest depth.
    let moves = |joint: &&&Joint| joint.kind != Kind::Fixed;
    let depth = |joint: &Joint| up(&joint.child).iter().filter(moves).count();
    let moving: Vec<&Joint> = document.joints.iter().filter(|j| moves(&j)).collect();
    let most = moving.iter().map(|joint| depth(joint)).max().unwrap_or(0);
    let mut last = moving.iter().filter(|joint| depth(joint) == most);
    match (last.next(), last.next()) {
        (Some(a), Some(b)) => {
            let message = format!(
                "the arm may end in \"{}\" or in \"{}\"; name its end tool0",
                a.child, b.child
            );
            Err(document.error(b.line, message))
        }
        (Some(only), None) => {
            // Continue along fixed joints while the continuation is unique.
            let mut end = only.child.as_str();
            loop {
                let mut next = document.joints_of(end);
                match (next.next(), next.next()) {
                    (Some(joint), None) => end = &joint.child,
                    _ => return Ok(up(end)),
                }
            }
        }
        (None, _) => Ok(up(root)),
    }
}

fn check_modelled(document: &Document, joint: &Joint) -> Result<(), RobotError> {
    check_no_mimic(document, joint)?;
    if !matches!(joint.kind, Kind::Revolute | Kind::Continuous) {
        let message = format!(
            "joint \"{}\" is neither revolute nor continuous; only turning joints are modelled: \
             make it fixed",
            joint.name
        );
        return Err(document.error(joint.line, message));
    }
    Ok(())
}

fn check_no_mimic(document: &Document, joint: &Joint) -> Result<(), RobotError> {
    if !joint.is_mimic {
        return Ok(());
    }
    let message = format!(
        "joint \"{}\" mimics another; dependent joints are not modelled: make it fixed, or free \
         it of <mimic>",
        joint.name
    );
    Err(document.error(joint.line, message))
}

/// Checks that a joint outside the chain moves no mass.
fn check_outside_chain(
    document: &Document,
    chain: &Chain<'_>,
    joint: &Joint,
) -> Result<(), RobotError> {
    check_no_mimic(document, joint)?;
    let of_chain = chain.joints.iter().any(|own| own.name == joint.name);
    if of_chain || joint.kind == Kind::Fixed {
        return Ok(());
    }
    let has_mass = |link: &&str| document.link(link).is_some_and(|link| link.inertial.is_some());
    let Some(link) = document.links_from(&joint.child).into_iter().find(has_mass) else {
        return Ok(());
    };
    let message = format!(
        "joint \"{}\" moves the mass of link \"{link}\" beside the arm; make it fixed, or leave the \
         mass out",
        joint.name
    );
    Err(document.error(joint.line, message))
}
