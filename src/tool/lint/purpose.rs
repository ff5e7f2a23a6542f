//! Whether a movement does work or is next to it: no rule proposes to leave out or to loosen such a
//! movement, and none touches the speed of a process.

use super::context::Context;
use super::flow::Through;

/// Slower movements are taken for a process, m/s: welding, gluing, drilling and pressing are
/// programmed below it, and so are the last millimetres of a grip.
pub(super) const PROCESS_SPEED: f64 = 0.2;

impl Context<'_> {
    /// Whether a movement before or behind another one is slow: it then leads into or out of a process.
    pub(super) fn is_next_to_slow(&self, site: usize) -> bool {
        let is_slow = |site: &usize| self.is_slow(*site);
        let behind = self.next_moves(site, Through::All).unwrap_or_default();
        self.before(site).iter().chain(&behind).any(is_slow)
    }

    /// Whether a movement is as slow as a process, or of unknown speed.
    pub(super) fn is_slow(&self, site: usize) -> bool {
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
