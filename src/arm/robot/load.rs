//! Loads a model from a file or the catalogue.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::catalogue;
use super::error::RobotError;
use super::model::Model;
use super::tree::{self, Node, Value};
use super::urdf::import_urdf;

/// Largest depth of `extends`.
const MAX_EXTENDS: usize = 8;

/// The robot of the Robot TOML or URDF file `name_or_path`, otherwise the robot of the catalogue
/// with this name.
///
/// Names that end in `.toml` or `.urdf` and names of existing files are paths.
///
/// # Errors
/// The file is unreadable or wrong; the catalogue does not contain the robot.
pub fn load(name_or_path: &str) -> Result<Model, RobotError> {
    let path = Path::new(name_or_path);
    if kind(path).is_some() {
        let model = Model::read(resolve(read_file(path)?, path.parent(), 0)?)?;
        return Ok(Model { file: Some(name_or_path.to_owned()), ..model });
    }
    if path.is_file() {
        return Err(RobotError::Format { path: name_or_path.to_owned() });
    }
    find(name_or_path)
}

/// The robot of the catalogue with this name; [`names`](super::names) lists them. Case, spaces and
/// punctuation are ignored, `ROB1_1600_1.45_10` is accepted, and payload or reach may be omitted if
/// only one robot matches.
///
/// # Errors
/// No robot matches, or several do.
pub fn find(name: &str) -> Result<Model, RobotError> {
    Model::read(resolve(catalogue::document(name)?, None, 0)?)
}

/// The robot of a Robot TOML text; `file` is its name in messages. `extends` may only name robots
/// of the catalogue.
///
/// # Errors
/// The text is wrong.
pub fn from_toml(file: &str, text: &str) -> Result<Model, RobotError> {
    Model::read(resolve(tree::parse(file, text)?, None, 0)?)
}

/// Overlays the document on the robot that it `extends`, recursively.
///
/// `folder` is the folder of the document; `None` for the catalogue.
pub(super) fn resolve(node: Node, folder: Option<&Path>, depth: usize) -> Result<Node, RobotError> {
    let Value::Table(entries) = &node.value else { return Ok(node) };
    let Some(extends) = entries.get("extends") else { return Ok(node) };
    let place = extends.place.to_string();
    let Value::Text(name) = &extends.value else {
        return Err(RobotError::Type {
            place,
            key: "extends".into(),
            found: extends.value.kind(),
            expected: "a text".into(),
        });
    };
    if depth == MAX_EXTENDS {
        return Err(RobotError::Extends { place, limit: MAX_EXTENDS });
    }
    let beside: Option<PathBuf> = folder.map(|folder| folder.join(name));
    let (base, folder) = match &beside {
        Some(path) if kind(path).is_some() => (read_file(path), path.parent()),
        _ => (catalogue::document(name), None),
    };
    let base = base.map_err(|error| match error {
        RobotError::Io { .. }
        | RobotError::Unknown { .. }
        | RobotError::Unpublished { .. }
        | RobotError::Ambiguous { .. } => {
            let (name, reason) = (name.clone(), error.to_string());
            RobotError::Base { place, name, reason }
        }
        other => other,
    })?;
    let base = resolve(base, folder, depth + 1)?;
    Ok(tree::overlay(tree::with_type(base), node))
}

/// Kinds of robot files.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Toml,
    Urdf,
}

/// The kind by the file extension.
fn kind(path: &Path) -> Option<Kind> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    match extension.as_str() {
        "toml" => Some(Kind::Toml),
        "urdf" => Some(Kind::Urdf),
        _ => None,
    }
}

fn read_file(path: &Path) -> Result<Node, RobotError> {
    let shown = path.display().to_string();
    let text = fs::read_to_string(path).map_err(|error| {
        let reason = match error.kind() {
            ErrorKind::InvalidData => "it is not UTF-8 text, save it as that".to_owned(),
            _ => error.to_string(),
        };
        RobotError::Io { path: shown.clone(), reason }
    })?;
    let text = text.strip_prefix('\u{feff}').map_or(text.as_str(), |rest| rest).to_owned();
    match kind(path) {
        Some(Kind::Urdf) => tree::parse(&shown, &import_urdf(&shown, &text)?),
        _ => tree::parse(&shown, &text),
    }
}
