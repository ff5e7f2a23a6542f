//! Where work is done: next to it no rule proposes to leave out or to loosen a movement, and no rule
//! touches the speed of a process.

use std::collections::BTreeMap;

use super::context::Context;
use super::flow::{Class, Flow, Next, Place, Through};
use super::site::Site;
use crate::rapid::builtins::MoveKind;

/// Slower movements are taken for a process, m/s: welding, gluing, drilling and pressing are
/// programmed below it, and so are the last millimetres of a grip.
pub(super) const PROCESS_SPEED: f64 = 0.2;

/// Which movements are next to work. Work is an output, a wait, a change of the tool or the load,
/// and everything else that may need a robot that stands.
pub(super) struct Work {
    /// Whether work is done between the movement before and this one.
    behind: Vec<bool>,
    /// Whether work is done between this movement and the next one, or by this one.
    ahead: Vec<bool>,
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
            next.filter_map(|next| match next {
                Next::Move(place) => by_place.get(&place).copied(),
                _ => None,
            })
        };
        for (place, stmt, _) in flow.statements() {
            let class = flow.class(place.0, stmt);
            if matches!(class, Class::Output | Class::Wait | Class::Other) {
                next_moves(place).for_each(|next| behind[next] = true);
            }
        }
        for (index, site) in sites.iter().enumerate() {
            let next = flow.following(site.place, Through::NoEffect);
            ahead[index] |= next.iter().any(|it| !matches!(it, Next::Move(_) | Next::End));
            if !matches!(site.signature.kind, MoveKind::Plain | MoveKind::Transfer) {
                ahead[index] = true;
                before[index].iter().for_each(|before| ahead[*before] = true);
                next_moves(site.place).for_each(|next| behind[next] = true);
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

impl Context<'_> {
    /// Whether a movement is directly behind or before work.
    pub(super) fn is_next_to_work(&self, site: usize) -> bool {
        self.work.behind[site] || self.work.ahead[site]
    }

    /// Whether a movement could be left out without a change of the way into or out of work: neither
    /// it nor a movement behind it is next to work.
    pub(super) fn may_leave_out(&self, site: usize) -> bool {
        let behind = |next: &usize| self.before(*next).contains(&site);
        !self.is_next_to_work(site)
            && (0..self.sites.len()).filter(behind).all(|next| !self.work.ahead[next])
    }

    /// Whether a movement does work by its speed or by the outputs around it: a process is slow,
    /// of unknown speed, or has an output that is on for its path.
    pub(super) fn is_process(&self, site: usize) -> bool {
        let is_slow = self.sites[site].facts.speed.is_none_or(|it| it.tcp < PROCESS_SPEED);
        is_slow || self.is_in_process(site)
    }
}
