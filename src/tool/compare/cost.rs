//! What an edit of a statement costs, in tenths of a deletion.
//!
//! The costs decide which statements are taken to be the same one. Other values of the same
//! instruction with the same target cost less than a deletion and an insertion; another target alone
//! costs more than half of both, so that a moved statement is not taken for many changed ones.

use super::node::{Label, Node};
use super::parts::Part;
use crate::rapid::builtins;
use crate::rapid::ir::hir::{Callee, StmtKind};

/// Deleting a node.
pub(super) const DELETE: u32 = 10;
/// Inserting a node.
pub(super) const INSERT: u32 = 10;
/// Two nodes that never correspond.
pub(super) const NEVER: u32 = DELETE + INSERT + 1;
/// Another condition of a block, or another value of what there is once.
const CONDITION: u32 = 6;
/// Another target, signal, or other first argument.
const IDENTITY: u32 = 12;
/// Another value of a further argument.
const VALUE: u32 = 5;
/// Another instruction of the same kind.
const INSTRUCTION: u32 = 8;
/// Another value of the same variable.
const ASSIGNED: u32 = 9;
/// Another procedure, or another variable.
const OTHER: u32 = 16;
/// The most that two statements cost that correspond.
const MOST: u32 = DELETE + INSERT - 2;

/// The cost of making `new` of `old`.
pub(super) fn change(old: &Node<'_>, new: &Node<'_>) -> u32 {
    if old.own == new.own {
        return 0;
    }
    let (Label::Statement(before), Label::Statement(after)) = (old.label, new.label) else {
        let same = std::mem::discriminant(&old.label) == std::mem::discriminant(&new.label);
        return if same { CONDITION } else { NEVER };
    };
    match (&before.kind, &after.kind) {
        (StmtKind::If { .. }, StmtKind::If { .. })
        | (StmtKind::While { .. }, StmtKind::While { .. })
        | (StmtKind::For { .. }, StmtKind::For { .. })
        | (StmtKind::Test { .. }, StmtKind::Test { .. })
        | (StmtKind::Return(_), StmtKind::Return(_))
        | (StmtKind::Raise(_), StmtKind::Raise(_))
        | (StmtKind::Connect { .. }, StmtKind::Connect { .. }) => CONDITION,
        (StmtKind::Call(a), StmtKind::Call(b)) => {
            let (Callee::Name(a), Callee::Name(b)) = (&a.callee, &b.callee) else { return OTHER };
            let differing = differences(&old.parts, &new.parts);
            if a.key == b.key {
                return differing.min(MOST);
            }
            match (builtins::instruction(&a.key), builtins::instruction(&b.key)) {
                (Some(a), Some(b))
                    if a.is_movement() && b.is_movement()
                        || a.waits() && b.waits()
                        || a.sets_output() && b.sets_output() =>
                {
                    (INSTRUCTION + differing).min(MOST)
                }
                (None, None) => OTHER,
                _ => NEVER,
            }
        }
        (StmtKind::Assign { .. }, StmtKind::Assign { .. }) => {
            let target = |node: &Node<'_>| node.parts.first().map(|(_, text)| *text);
            if target(old) == target(new) { ASSIGNED } else { OTHER }
        }
        (StmtKind::Goto(_), StmtKind::Goto(_)) => IDENTITY,
        (StmtKind::Broken, StmtKind::Broken) => OTHER,
        _ => NEVER,
    }
}

fn differences(old: &[(Part<'_>, u32)], new: &[(Part<'_>, u32)]) -> u32 {
    let mut cost = 0;
    for (part, text) in old {
        let same = new.iter().find(|(other, _)| other.role == part.role);
        if same.is_none_or(|(_, other)| other != text) {
            cost += if part.role.is_identity() { IDENTITY } else { VALUE };
        }
    }
    let is_new = |part: &Part<'_>| old.iter().all(|(other, _)| other.role != part.role);
    cost + VALUE * new.iter().filter(|(part, _)| is_new(part)).count() as u32
}
