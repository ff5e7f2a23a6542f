//! Where work is done: next to it no rule proposes to leave out or to loosen a movement.

use std::collections::BTreeMap;

use super::flow::{Class, Flow, Next, Place, Through};
use super::site::Site;
use crate::rapid::builtins::MoveKind;

/// Which movements are next to work. Work is an output, a wait, a change of the tool or the load,
/// and everything else that may need a robot that stands.
pub(super) struct Work {
    /// Whether work is done between the movement before and this one.
    pub(super) behind: Vec<bool>,
    /// Whether work is done between this movement and the next one, or by this one.
    pub(super) ahead: Vec<bool>,
}

impl Work {
    pub(super) fn new(
        flow: &Flow<'_>,
        sites: &[Site<'_>],
        by_place: &BTreeMap<Place, usize>,
        before: &[Vec<usize>],
    ) -> Work {
        let mut behind = vec![false; sites.len()];
        let mut ahead = vec![false; sites.len()];
        let next_moves = |place: Place| {
            let next = flow.following(place, Through::NoEffect).into_iter();
            next.filter_map(move |next| match next {
                Next::Move(place) => by_place.get(&place).copied(),
                _ => None,
            })
        };
        for (place, stmt, _) in flow.statements() {
            let class = flow.class(place.0, stmt);
            if matches!(class, Class::Output | Class::Wait | Class::Other) {
                for next in next_moves(place) {
                    behind[next] = true;
                }
            }
        }
        for (index, site) in sites.iter().enumerate() {
            let next = flow.following(site.place, Through::NoEffect);
            ahead[index] |= next.iter().any(|it| !matches!(it, Next::Move(_) | Next::End));
            if !matches!(site.signature.kind, MoveKind::Plain | MoveKind::Transfer) {
                ahead[index] = true;
                for before in &before[index] {
                    ahead[*before] = true;
                }
                for next in next_moves(site.place) {
                    behind[next] = true;
                }
            }
            for other in &before[index] {
                if sites[*other].tool_key() != site.tool_key() {
                    (ahead[*other], behind[index]) = (true, true);
                }
            }
        }
        Work { behind, ahead }
    }
}
