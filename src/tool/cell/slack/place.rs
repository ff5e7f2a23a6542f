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

/// Where the time of a machine counts from in a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start {
    /// Not from an event of the cycle.
    Outside,
    /// From the end of this event.
    EndOf(usize),
    /// The cycle lacks the event.
    Unknown,
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

    /// Where the time of a machine counts from: the last such event before the event `until`.
    pub(super) fn start(&self, after: &After, until: usize) -> Start {
        let (file, line) = (after.file.as_deref(), after.line);
        let at =
            |span: Span| file.zip(line).is_some_and(|(file, line)| self.is_at(span, file, line));
        let before = self.events[..until].iter().enumerate().rev();
        let found = |is: &dyn Fn(&What) -> bool| {
            before.clone().find(|(_, event)| is(&event.what)).map(|(index, _)| index)
        };
        let end_of = |is: &dyn Fn(&What) -> bool| found(is).map_or(Start::Unknown, Start::EndOf);
        match after.event {
            EventEntry::Cycle => Start::Outside,
            EventEntry::End => end_of(&|what| matches!(what, What::Wait(it) if at(it.wait.span))),
            EventEntry::Output => {
                end_of(&|what| matches!(what, What::Output(it, _) if at(it.span)))
            }
            EventEntry::Signal => {
                let Some(signal) = after.signal.as_deref() else { return Start::Unknown };
                let waits = |what: &What| {
                    matches!(what, What::Wait(it)
                        if it.wait.signal.as_ref().is_some_and(|own| own.eq_ignore_ascii_case(signal)))
                };
                // A signal for which the robot does not wait comes by itself.
                found(&waits).map_or(Start::Outside, Start::EndOf)
            }
            EventEntry::Start | EventEntry::Arrive => {
                let moves = |what: &What| {
                    matches!(what, What::Run(run)
                        if run.moves.iter().any(|record| at(record.movement.span)))
                };
                let Some(run) = found(&moves) else { return Start::Unknown };
                let begins = after.event == EventEntry::Start
                    && matches!(&self.events[run].what, What::Run(run)
                        if run.moves.first().is_some_and(|record| at(record.movement.span)));
                let from = if begins { run.checked_sub(1) } else { Some(run + 1) };
                from.map_or(Start::Outside, Start::EndOf)
            }
        }
    }

    /// The event from which the slack of the wait at `wait` may be used up. `None` if nothing in the
    /// cycle stands for it.
    pub(super) fn anchor(&self, after: &After, wait: usize) -> Option<Anchor> {
        // What happened in the cycle before, or outside, does not depend on this cycle's movements.
        if after.before {
            return Some(Anchor::Cycle);
        }
        match self.start(after, wait) {
            Start::Outside => Some(Anchor::Cycle),
            Start::EndOf(event) => self.standing(event, wait),
            Start::Unknown => None,
        }
    }

    /// The first wait or output at standstill from this event on, before the wait: what comes later
    /// leaves less time, never more.
    pub(super) fn standing(&self, from: usize, wait: usize) -> Option<Anchor> {
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
