//! Recorded places in a simulated cycle.

use crate::rapid::text::Span;
use crate::retime::motion::arrivals::Anchor;
use crate::retime::motion::timeline::{Event, What};
use crate::tool::cell::waits::file::{After, EventEntry};
use crate::tool::retrofit::Source;

/// A simulated cycle with the files of its program.
pub(super) struct Cycle<'a> {
    pub(super) files: &'a [Source],
    pub(super) events: &'a [Event],
}

impl Cycle<'_> {
    /// Whether a statement stands at a recorded place.
    pub(super) fn is_at(&self, span: Span, file: &str, line: u32) -> bool {
        let source = &self.files[span.file.0 as usize];
        source.file.position(span.start).line == line && source.relative == file
    }

    /// The event of the execution of a wait: its index and its number among all waits.
    pub(super) fn wait(&self, file: &str, line: u32, occurrence: usize) -> Option<(usize, usize)> {
        let waits = self.events.iter().enumerate().filter_map(|(index, event)| match &event.what {
            What::Wait(record) => Some((index, record.wait.span)),
            _ => None,
        });
        let numbered = waits.enumerate().map(|(number, (index, span))| (index, number, span));
        let mut own = numbered.filter(|(_, _, span)| self.is_at(*span, file, line));
        own.nth(occurrence).map(|(index, number, _)| (index, number))
    }

    /// The event from which the slack of the wait at `wait` may be used up. `None` if nothing in the
    /// cycle stands for it.
    pub(super) fn anchor(&self, after: &After, wait: usize) -> Option<Anchor> {
        // What happened in the cycle before, or outside, does not depend on this cycle's movements.
        if after.before || after.event == EventEntry::Cycle {
            return Some(Anchor::Cycle);
        }
        let (file, line) = (after.file.as_deref(), after.line);
        let at =
            |span: Span| file.zip(line).is_some_and(|(file, line)| self.is_at(span, file, line));
        let before = self.events[..wait].iter().enumerate().rev();
        let found = |is: &dyn Fn(&What) -> bool| {
            before.clone().find(|(_, event)| is(&event.what)).map(|(index, _)| index)
        };
        match after.event {
            EventEntry::Cycle => Some(Anchor::Cycle),
            EventEntry::End => self
                .standing(found(&|what| matches!(what, What::Wait(it) if at(it.wait.span)))?, wait),
            EventEntry::Output => self
                .standing(found(&|what| matches!(what, What::Output(it, _) if at(it.span)))?, wait),
            EventEntry::Signal => {
                let signal = after.signal.as_deref()?;
                let waits = |what: &What| {
                    matches!(what, What::Wait(it)
                        if it.wait.signal.as_ref().is_some_and(|own| own.eq_ignore_ascii_case(signal)))
                };
                // A signal for which the robot does not wait comes by itself.
                found(&waits).map_or(Some(Anchor::Cycle), |index| self.standing(index, wait))
            }
            EventEntry::Start | EventEntry::Arrive => {
                let moves = |what: &What| {
                    matches!(what, What::Run(run)
                        if run.moves.iter().any(|record| at(record.movement.span)))
                };
                let run = found(&moves)?;
                let begins = after.event == EventEntry::Start
                    && matches!(&self.events[run].what, What::Run(run)
                        if run.moves.first().is_some_and(|record| at(record.movement.span)));
                let from = if begins { run.checked_sub(1) } else { Some(run + 1) };
                from.map_or(Some(Anchor::Cycle), |from| self.standing(from, wait))
            }
        }
    }

    /// The first wait or output at standstill from this event on, before the wait: what comes later
    /// leaves less time, never more.
    fn standing(&self, from: usize, wait: usize) -> Option<Anchor> {
        let index = (from..wait).find(|index| {
            let event = &self.events[*index];
            matches!(event.what, What::Wait(_) | What::Output(..)) && !event.is_within_next_run()
        })?;
        let count = |is: fn(&What) -> bool| {
            self.events[..index].iter().filter(|event| is(&event.what)).count()
        };
        Some(match self.events[index].what {
            What::Wait(_) => Anchor::Wait(count(|what| matches!(what, What::Wait(_)))),
            _ => Anchor::Output(count(|what| matches!(what, What::Output(..)))),
        })
    }
}
