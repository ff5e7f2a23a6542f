//! A URDF as links, joints and gear ratios with their lines.

use std::collections::BTreeMap;

use roxmltree::Node;

use super::elements::{Joint, Link, Wrong, child, line, read_joint, read_link};
use crate::arm::robot::error::RobotError;

/// Deepest nesting of elements; a URDF needs five.
const MAX_DEPTH: usize = 64;

/// The used parts of a URDF.
pub(super) struct Document {
    pub(super) file: String,
    pub(super) name: String,
    pub(super) links: Vec<Link>,
    pub(super) joints: Vec<Joint>,
    /// Gear ratio by joint name.
    pub(super) reductions: BTreeMap<String, f64>,
}

impl Document {
    pub(super) fn read(file: &str, text: &str) -> Result<Document, RobotError> {
        let fail = |line: usize, message: String| error(file, line, message);
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
        Document::read_robot(file, xml.root_element())
            .map_err(|(node, message)| fail(line(node), message))
    }

    fn read_robot<'a, 'i>(file: &str, root: Node<'a, 'i>) -> Result<Document, Wrong<'a, 'i>> {
        let name = root.attribute("name").unwrap_or_default();
        for (is_wrong, message) in [
            (root.tag_name().name() != "robot", "not a URDF: the first element is not <robot>"),
            (name.trim().is_empty(), "the <robot> has no name; give it one"),
            (child(root, "link").is_none(), "the robot has no <link>; export it again"),
        ] {
            if is_wrong {
                return Err((root, message.into()));
            }
        }
        let mut document = Document {
            file: file.to_owned(),
            name: name.to_owned(),
            links: Vec::new(),
            joints: Vec::new(),
            reductions: BTreeMap::new(),
        };
        let mut transmissions = Vec::new();
        for node in root.children().filter(Node::is_element) {
            let name = node.attribute("name").unwrap_or_default();
            match node.tag_name().name() {
                "link" => {
                    check_unique(node, document.link(name).map(|link| link.line))?;
                    document.links.push(read_link(node)?);
                }
                "joint" => {
                    check_unique(node, document.joint(name).map(|joint| joint.line))?;
                    document.joints.push(read_joint(node)?);
                }
                "transmission" => {
                    if let Some((joint, ratio)) = reduction(node)? {
                        transmissions.push((joint, node));
                        document.reductions.insert(joint.to_owned(), ratio);
                    }
                }
                _ => {}
            }
        }
        match transmissions.into_iter().find(|(joint, _)| document.joint(joint).is_none()) {
            Some((joint, node)) => {
                let message = format!(
                    "a transmission of the joint \"{joint}\", which is not there; correct its name \
                     or remove the transmission"
                );
                Err((node, message))
            }
            None => Ok(document),
        }
    }

    /// An error in a line.
    pub(super) fn error(&self, line: usize, message: String) -> RobotError {
        error(&self.file, line, message)
    }

    pub(super) fn link(&self, name: &str) -> Option<&Link> {
        self.links.iter().find(|link| link.name == name)
    }

    fn joint(&self, name: &str) -> Option<&Joint> {
        self.joints.iter().find(|joint| joint.name == name)
    }

    /// A link and all that hang from it, each after its parent.
    pub(super) fn links_from<'a>(&'a self, link: &'a str) -> Vec<&'a str> {
        let mut links = vec![link];
        let mut next = 0;
        while let Some(link) = links.get(next).copied() {
            links.extend(self.joints_of(link).map(|joint| joint.child.as_str()));
            next += 1;
        }
        links
    }

    /// The joints whose parent is the link.
    pub(super) fn joints_of<'a>(&'a self, link: &'a str) -> impl Iterator<Item = &'a Joint> {
        self.joints.iter().filter(move |joint| joint.parent == link)
    }
}

fn error(file: &str, line: usize, message: String) -> RobotError {
    RobotError::Urdf { place: format!("{file}:{line}"), message }
}

/// An error if a link or joint of that name was read before, in line `first`.
fn check_unique<'a, 'i>(node: Node<'a, 'i>, first: Option<usize>) -> Result<(), Wrong<'a, 'i>> {
    let Some(first) = first else { return Ok(()) };
    let (tag, name) = (node.tag_name().name(), node.attribute("name").unwrap_or_default());
    Err((node, format!("a second {tag} \"{name}\", the first is in line {first}; rename one")))
}

/// Joint and gear ratio of a transmission; the ratio is in the actuator or in the joint.
fn reduction<'a, 'i>(node: Node<'a, 'i>) -> Result<Option<(&'a str, f64)>, Wrong<'a, 'i>> {
    let reduces =
        |node: &Node<'_, '_>| node.tag_name().name().eq_ignore_ascii_case("mechanicalReduction");
    let joint = child(node, "joint").and_then(|joint| joint.attribute("name"));
    let text = node.descendants().find(reduces).and_then(|node| node.text());
    let (Some(joint), Some(text)) = (joint, text.map(str::trim)) else { return Ok(None) };
    match text.parse::<f64>() {
        Ok(ratio) if ratio.is_finite() && ratio > 0.0 => Ok(Some((joint, ratio))),
        _ => {
            let message = format!(
                "mechanicalReduction \"{text}\" of joint \"{joint}\": give a number above 0; the \
                 sense belongs into the joint's axis"
            );
            Err((node, message))
        }
    }
}

/// The line at which elements are nested too deep for the recursive XML parser.
fn too_deep(text: &str) -> Option<usize> {
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
