//! A URDF read twice: by `urdf-rs` for its content, and as XML for the lines, for what
//! is there at all, and for the transmissions, which `urdf-rs` leaves out.

use std::collections::BTreeMap;

use urdf_rs::{Joint, Link, Robot};

use super::values::{Wrong, check_joint, check_link, too_deep};
use crate::arm::robot::error::RobotError;

/// A URDF with the places of its elements.
pub(super) struct Document {
    pub(super) file: String,
    pub(super) robot: Robot,
    /// Gear ratio by the name of the joint.
    pub(super) reductions: BTreeMap<String, f64>,
    lines: BTreeMap<(String, String), usize>,
    with_inertial: Vec<String>,
}

impl Document {
    pub(super) fn read(file: &str, text: &str) -> Result<Document, RobotError> {
        let fail = |line: usize, message: String| RobotError::Urdf {
            place: format!("{file}:{line}"),
            message,
        };
        if let Some(at) = text.find("<xacro:") {
            let line = 1 + text[..at].matches('\n').count();
            let message = "it has xacro macros; expand them first: xacro FILE > robot.urdf";
            return Err(fail(line, message.into()));
        }
        if let Some(line) = too_deep(text) {
            return Err(fail(line, "not a URDF: elements are nested too deep".into()));
        }
        let xml = roxmltree::Document::parse(text).map_err(|error| {
            let line = match error {
                roxmltree::Error::UnexpectedEndOfStream => text.lines().count(),
                _ => error.pos().row as usize,
            };
            fail(line.max(1), format!("not valid XML: {error}; export it again"))
        })?;
        let line =
            |node: &roxmltree::Node<'_, '_>| xml.text_pos_at(node.range().start).row as usize;
        let root = xml.root_element();
        if root.tag_name().name() != "robot" {
            return Err(fail(line(&root), "not a URDF: the first element is not <robot>".into()));
        }
        if root.attribute("name").is_none_or(|name| name.trim().is_empty()) {
            return Err(fail(line(&root), "the <robot> has no name; give it one".into()));
        }
        if child(&root, "link").is_none() {
            return Err(fail(line(&root), "the robot has no <link>; export it again".into()));
        }
        let wrong = |(node, message): Wrong<'_, '_>| fail(line(&node), message);
        let mut lines = BTreeMap::new();
        let mut with_inertial = Vec::new();
        let mut reductions = BTreeMap::new();
        let mut transmissions = Vec::new();
        for node in root.children().filter(roxmltree::Node::is_element) {
            let tag = node.tag_name().name();
            let name = node.attribute("name").unwrap_or_default();
            let known = lines.insert((tag.to_owned(), name.to_owned()), line(&node));
            if let (Some(first), "link" | "joint") = (known, tag) {
                let message =
                    format!("a second {tag} \"{name}\", the first is in line {first}; rename one");
                return Err(fail(line(&node), message));
            }
            match tag {
                "link" => {
                    check_link(node).map_err(wrong)?;
                    if child(&node, "inertial").is_some() {
                        with_inertial.push(name.to_owned());
                    }
                }
                "joint" => check_joint(node).map_err(wrong)?,
                "transmission" => {
                    if let Some((joint, ratio)) = reduction(&node) {
                        let value: f64 = ratio.parse().unwrap_or(f64::NAN);
                        if !value.is_finite() || value <= 0.0 {
                            let message = format!(
                                "mechanicalReduction \"{ratio}\" of joint \"{joint}\": give a number \
                                 above 0; the sense belongs into the joint's axis"
                            );
                            return Err(fail(line(&node), message));
                        }
                        transmissions.push((joint, line(&node)));
                        reductions.insert(joint.to_owned(), value);
                    }
                }
                _ => {}
            }
        }
        let is_joint = |name: &str| lines.contains_key(&("joint".to_owned(), name.to_owned()));
        if let Some((joint, line)) = transmissions.iter().find(|(joint, _)| !is_joint(joint)) {
            let message = format!(
                "a transmission of the joint \"{joint}\", which is not there; correct its name or \
                 remove the transmission"
            );
            return Err(fail(*line, message));
        }
        let robot = urdf_rs::read_from_string(text).map_err(|error| {
            let message = format!("not a sound URDF: {error}; correct it or export it again");
            fail(line(&root), message)
        })?;
        Ok(Document { file: file.to_owned(), robot, reductions, lines, with_inertial })
    }

    /// An error at the element.
    pub(super) fn error(&self, tag: &str, name: &str, message: String) -> RobotError {
        let line = self.lines.get(&(tag.to_owned(), name.to_owned())).copied().unwrap_or(1);
        RobotError::Urdf { place: format!("{}:{line}", self.file), message }
    }

    /// Whether the link states its inertia.
    pub(super) fn has_inertial(&self, link: &str) -> bool {
        self.with_inertial.iter().any(|name| name == link)
    }

    pub(super) fn link(&self, name: &str) -> Option<&Link> {
        self.robot.links.iter().find(|link| link.name == name)
    }

    /// The joints that hang from a link.
    pub(super) fn joints_of<'a>(&'a self, link: &'a str) -> impl Iterator<Item = &'a Joint> {
        self.robot.joints.iter().filter(move |joint| joint.parent.link == link)
    }
}

fn child<'a, 'i>(node: &roxmltree::Node<'a, 'i>, tag: &str) -> Option<roxmltree::Node<'a, 'i>> {
    node.children().find(|child| child.tag_name().name() == tag)
}

/// Joint and ratio of a transmission: the ratio stands in the actuator, or in the joint.
fn reduction<'a>(node: &roxmltree::Node<'a, '_>) -> Option<(&'a str, &'a str)> {
    let joint = child(node, "joint")?;
    let reduces = |node: &roxmltree::Node<'_, '_>| {
        node.tag_name().name().eq_ignore_ascii_case("mechanicalReduction")
    };
    let ratio = node.descendants().find(reduces)?.text()?;
    Some((joint.attribute("name")?, ratio.trim()))
}
