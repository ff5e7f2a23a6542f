//! Whether a movement does work or is next to it: no rule proposes to leave out or to loosen such a
//! movement, and none touches the speed of a process.

use std::collections::BTreeSet;

use super::context::Context;
use super::flow::Through;

/// Slower movements are taken for a process, m/s: welding, gluing, drilling and pressing are
/// programmed below it, and so are the last millimetres of a grip.
pub(super) const PROCESS_SPEED: f64 = 0.2;

/// Lines in a row that are many: with a part the robot goes up, over and down.
const MANY_LINES: usize = 4;

impl Context<'_> {
    /// Whether a line is one of many in a row, as on a contour or in a meander.
    pub(super) fn is_in_row_of_lines(&self, site: usize) -> bool {
        let mut row = BTreeSet::from([site]);
        let mut open = vec![site];
        while let Some(site) = open.pop().filter(|_| row.len() < MANY_LINES) {
            let behind = self.next_moves(site, Through::NoEffect).unwrap_or_default();
            let before = self.before(site).iter().copied();
            let before = before.filter(|it| self.next_moves(*it, Through::NoEffect).is_some());
            for other in behind.into_iter().chain(before) {
                if self.sites[other].is_linear() && row.insert(other) {
                    open.push(other);
                }
            }
        }
        row.len() >= MANY_LINES
    }

    /// Whether a movement before or behind another one is slow: it then leads into or out of a process.
    pub(super) fn is_next_to_slow(&self, site: usize) -> bool {
        let is_slow = |site: &usize| self.is_slow(*site);
        let behind = self.next_moves(site, Through::All).unwrap_or_default();
        self.before(site).iter().chain(&behind).any(is_slow)
    }

    fn is_slow(&self, site: usize) -> bool {
        self.sites[site].facts.speed.is_none_or(|it| it.tcp < PROCESS_SPEED)
    }

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
        self.is_slow(site) || self.is_in_process(site)
    }
}
