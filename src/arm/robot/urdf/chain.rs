//! The chain of moving joints from the root to the flange.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use urdf_rs::{Joint, JointType, Pose};

use super::document::Document;
use crate::arm::robot::error::RobotError;
use crate::arm::robot::geometry::MAX_DOF;

/// Links that may be the end of the chain, the first that is there.
const ENDS: [&str; 2] = ["tool0", "flange"];

/// The moving joints with what is fixed between them.
pub(super) struct Chain<'d> {
    /// Moving joints from the root on.
    pub(super) joints: Vec<&'d Joint>,
    /// Placement of each in the frame of the moving joint before it.
    pub(super) placements: Vec<Isometry3<f64>>,
    /// The end in the last moving joint's frame.
    pub(super) flange: Isometry3<f64>,
}

impl<'d> Chain<'d> {
    pub(super) fn find(document: &'d Document) -> Result<Chain<'d>, RobotError> {
        let root = root(document)?;
        let path = path(document, root)?;
        let mut chain =
            Chain { joints: Vec::new(), placements: Vec::new(), flange: Isometry3::identity() };
        let mut fixed = Isometry3::identity();
        for joint in path {
            let placed = fixed * isometry(&joint.origin);
            if joint.joint_type == JointType::Fixed {
                fixed = placed;
                continue;
            }
            is_modelled(document, joint)?;
            if chain.joints.len() == MAX_DOF {
                let message = format!(
                    "joint \"{}\" is the eighth moving one of the chain; at most {MAX_DOF} are \
                     modelled: make the others fixed, or name the end of the arm tool0",
                    joint.name
                );
                return Err(document.error("joint", &joint.name, message));
            }
            chain.placements.push(placed);
            chain.joints.push(joint);
            fixed = Isometry3::identity();
        }
        if chain.joints.is_empty() {
            let message = "the chain has no moving joint; name the end of the arm tool0".into();
            return Err(document.error("link", root, message));
        }
        chain.flange = fixed;
        for joint in &document.robot.joints {
            beside(document, &chain, joint)?;
        }
        Ok(chain)
    }
}

/// The link that is no joint's child; every other one is exactly one's.
fn root(document: &Document) -> Result<&str, RobotError> {
    let robot = &document.robot;
    for joint in &robot.joints {
        for link in [&joint.parent.link, &joint.child.link] {
            if document.link(link).is_none() {
                let message = format!(
                    "joint \"{}\" names the link \"{link}\", which is not there; add it",
                    joint.name
                );
                return Err(document.error("joint", &joint.name, message));
            }
        }
        let first = robot.joints.iter().find(|other| other.child.link == joint.child.link);
        if let Some(first) = first.filter(|first| first.name != joint.name) {
            let message = format!(
                "a loop: link \"{}\" hangs from joint \"{}\" and from joint \"{}\"; remove one, \
                 only trees are modelled",
                joint.child.link, first.name, joint.name
            );
            return Err(document.error("joint", &joint.name, message));
        }
    }
    let is_child = |link: &str| robot.joints.iter().any(|joint| joint.child.link == link);
    let mut roots =
        robot.links.iter().map(|link| link.name.as_str()).filter(|link| !is_child(link));
    let Some(root) = roots.next() else {
        let name = robot.joints.first().map_or("", |joint| joint.name.as_str());
        let message =
            "a loop: every link hangs from a joint, so there is no base; remove one joint";
        return Err(document.error("joint", name, message.into()));
    };
    if let Some(other) = roots.next() {
        let message =
            format!("link \"{other}\" does not hang from the base \"{root}\"; add a joint to it");
        return Err(document.error("link", other, message));
    }
    // Every link has one parent and there is one root: links that cannot be reached form
    // a loop of their own.
    let mut reached = vec![root];
    let mut next = 0;
    while next < reached.len() {
        let link = reached[next];
        reached.extend(document.joints_of(link).map(|joint| joint.child.link.as_str()));
        next += 1;
    }
    let lost = robot.joints.iter().find(|joint| !reached.contains(&joint.child.link.as_str()));
    if let Some(joint) = lost {
        let message = format!(
            "a loop: link \"{}\" hangs from itself by joint \"{}\"; remove one joint of the loop",
            joint.child.link, joint.name
        );
        return Err(document.error("joint", &joint.name, message));
    }
    Ok(root)
}

/// The joints from the root to the end.
fn path<'d>(document: &'d Document, root: &str) -> Result<Vec<&'d Joint>, RobotError> {
    let up = |link: &str| {
        let mut path = Vec::new();
        let mut link = link.to_owned();
        while let Some(joint) = document.robot.joints.iter().find(|joint| joint.child.link == link)
        {
            path.push(joint);
            link.clone_from(&joint.parent.link);
        }
        path.reverse();
        path
    };
    if let Some(end) = ENDS.into_iter().find(|end| document.link(end).is_some()) {
        return Ok(up(end));
    }
    // The last moving joint that no other moves.
    let moves = |joint: &&&Joint| joint.joint_type != JointType::Fixed;
    let depth = |joint: &Joint| up(&joint.child.link).iter().filter(moves).count();
    let moving: Vec<&Joint> = document.robot.joints.iter().filter(|j| moves(&j)).collect();
    let most = moving.iter().map(|joint| depth(joint)).max().unwrap_or(0);
    let mut last = moving.iter().filter(|joint| depth(joint) == most);
    match (last.next(), last.next()) {
        (Some(a), Some(b)) => {
            let message = format!(
                "the arm may end in \"{}\" or in \"{}\"; name its end tool0",
                a.child.link, b.child.link
            );
            Err(document.error("joint", &b.name, message))
        }
        (Some(only), None) => {
            // Along what is fixed to it, as long as there is one way.
            let mut end = only.child.link.as_str();
            loop {
                let mut next = document.joints_of(end);
                match (next.next(), next.next()) {
                    (Some(joint), None) => end = &joint.child.link,
                    _ => return Ok(up(end)),
                }
            }
        }
        (None, _) => Ok(up(root)),
    }
}

fn is_modelled(document: &Document, joint: &Joint) -> Result<(), RobotError> {
    is_no_mimic(document, joint)?;
    if !matches!(joint.joint_type, JointType::Revolute | JointType::Continuous) {
        let message = format!(
            "joint \"{}\" is neither revolute nor continuous; only turning joints are modelled: \
             make it fixed",
            joint.name
        );
        return Err(document.error("joint", &joint.name, message));
    }
    Ok(())
}

fn is_no_mimic(document: &Document, joint: &Joint) -> Result<(), RobotError> {
    if joint.mimic.is_none() {
        return Ok(());
    }
    let message = format!(
        "joint \"{}\" mimics another; dependent joints are not modelled: make it fixed, or free \
         it of <mimic>",
        joint.name
    );
    Err(document.error("joint", &joint.name, message))
}

/// A joint that is not of the chain may not move any mass.
fn beside(document: &Document, chain: &Chain<'_>, joint: &Joint) -> Result<(), RobotError> {
    is_no_mimic(document, joint)?;
    let of_chain = chain.joints.iter().any(|own| own.name == joint.name);
    if of_chain || joint.joint_type == JointType::Fixed {
        return Ok(());
    }
    let mut links = vec![joint.child.link.as_str()];
    let mut next = 0;
    while next < links.len() {
        let link = links[next];
        if document.has_inertial(link) {
            let message = format!(
                "joint \"{}\" moves the mass of link \"{link}\" beside the arm; make it fixed, or \
                 leave the mass out",
                joint.name
            );
            return Err(document.error("joint", &joint.name, message));
        }
        links.extend(document.joints_of(link).map(|joint| joint.child.link.as_str()));
        next += 1;
    }
    Ok(())
}

/// A pose of a URDF.
pub(super) fn isometry(pose: &Pose) -> Isometry3<f64> {
    let [roll, pitch, yaw] = pose.rpy.0;
    Isometry3::from_parts(
        Translation3::from(Vector3::from(pose.xyz.0)),
        UnitQuaternion::from_euler_angles(roll, pitch, yaw),
    )
}
