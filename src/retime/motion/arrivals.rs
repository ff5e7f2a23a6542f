//! When what a wait is for comes, by the place of the wait in the cycle.
//!
//! A place counts executed waits and outputs, so that it is the same in a retrofitted program, whose
//! lines differ.

use super::timeline::{Event, What};

/// When what a wait is for comes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// The wait: its number in the cycle, from 0.
    pub wait: usize,
    /// The event from which its time counts.
    pub after: Anchor,
    /// s.
    pub delay_s: f64,
}

/// An event from which a time counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The start of the cycle; in an endless loop that of the pass.
    Cycle,
    /// The end of the wait with this number in the cycle, from 0.
    Wait(usize),
    /// The output with this number in the cycle, from 0.
    Output(usize),
    /// The moment at which the program comes to the wait: it keeps its length.
    Own,
}

/// The event of an anchor other than [`Anchor::Cycle`] and [`Anchor::Own`].
pub fn anchored(events: &[Event], anchor: Anchor) -> Option<usize> {
    let nth = |is: fn(&What) -> bool, number: usize| {
        let own = events.iter().enumerate().filter(|(_, event)| is(&event.what));
        own.map(|(index, _)| index).nth(number)
    };
    match anchor {
        Anchor::Wait(number) => nth(|what| matches!(what, What::Wait(_)), number),
        Anchor::Output(number) => nth(|what| matches!(what, What::Output(..)), number),
        Anchor::Cycle | Anchor::Own => None,
    }
}

/// The number of the next wait behind these events.
pub fn next_wait(events: &[Event]) -> usize {
    events.iter().filter(|event| matches!(event.what, What::Wait(_))).count()
}
