//! Families: all pieces of one effect, of which a hypothesis takes one for each joint.

use super::column::Owner;
use super::table::Table;

/// The pieces of one effect or of functions of one thing.
#[derive(Clone)]
pub struct Family {
    /// Whose they are.
    pub owner: Owner,
    /// By joint (or of the robot), the numbers of its pieces.
    pub joints: Vec<(Option<usize>, Vec<usize>)>,
}

impl Family {
    /// Whether it is no law.
    #[must_use]
    pub fn is_generic(&self) -> bool {
        matches!(self.owner, Owner::Generic(_))
    }
}

/// The families of a table, in its order.
#[must_use]
pub fn families(table: &Table) -> Vec<Family> {
    let mut families: Vec<Family> = Vec::new();
    for (number, piece) in table.pieces.iter().enumerate() {
        let known = families.iter().position(|family| family.owner.id() == piece.owner.id());
        let at = known.unwrap_or_else(|| {
            families.push(Family { owner: piece.owner, joints: Vec::new() });
            families.len() - 1
        });
        let joints = &mut families[at].joints;
        match joints.iter_mut().find(|(joint, _)| *joint == piece.joint) {
            Some((_, pieces)) => pieces.push(number),
            None => joints.push((piece.joint, vec![number])),
        }
    }
    families
}
