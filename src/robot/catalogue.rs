//! The robots that come with the crate, one TOML file each.

use super::error::RobotError;
use super::load::resolve;
use super::model::Model;
use super::names::{Name, nearest};
use super::tree::{self, Node};

/// Full name and document of each robot, by name.
const ROBOTS: [(&str, &str); 2] = [
    ("IRB1600-10/1.45", include_str!("catalogue/irb1600_10_145.toml")),
    ("IRB6640-180/2.55", include_str!("catalogue/irb6640_180_255.toml")),
];

/// The full names of the catalogue, sorted.
pub fn names() -> impl Iterator<Item = &'static str> {
    ROBOTS.iter().map(|(name, _)| *name)
}

/// The robot of the catalogue that `name` means; see the crate's list in
/// [`names`]. Case, spaces and punctuation do not matter, `ROB1_1600_1.45_10` is
/// understood, and payload or reach may be left out where only one robot fits.
///
/// # Errors
/// No robot fits, or several do.
pub fn find(name: &str) -> Result<Model, RobotError> {
    Model::read(resolve(document(name)?, None, 0)?)
}

/// The document of that robot.
pub(super) fn document(name: &str) -> Result<Node, RobotError> {
    let asked = Name::parse(name);
    let fitting: Vec<_> =
        ROBOTS.iter().filter(|(full, _)| asked.means(&Name::parse(full))).collect();
    match fitting.as_slice() {
        [(full, text)] => tree::parse(full, text),
        [] => Err(RobotError::Unknown {
            name: name.to_owned(),
            suggestion: nearest(name, names()).map(str::to_owned),
            known: names().map(str::to_owned).collect(),
        }),
        several => Err(RobotError::Ambiguous {
            name: name.to_owned(),
            candidates: several.iter().map(|(full, _)| (*full).to_owned()).collect(),
        }),
    }
}
