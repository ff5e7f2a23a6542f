//! The cycle as planned: what happens when, if every wait takes its expected time.

use super::script::{Step, Variant};
use super::truth::Event;

/// Starts of the steps of a cycle.
#[derive(Clone, Debug)]
pub(super) struct Timeline<'a> {
    steps: &'a [Step],
    starts: Vec<f64>,
    /// Duration of the cycle \[s\].
    pub(super) total_s: f64,
}

/// Shortest time from an event to a wait for which a machine can work meanwhile \[s\].
const SHORTEST_S: f64 = 1.5;

impl<'a> Timeline<'a> {
    /// The timeline in which the wait for a signal takes `expected` \[s\].
    pub(super) fn of(variant: &'a Variant, expected: impl Fn(&str) -> f64) -> Timeline<'a> {
        let mut total_s = 0.0;
        let mut starts = Vec::new();
        for step in &variant.steps {
            starts.push(total_s);
            total_s += match step {
                Step::Move { duration_s, .. } => *duration_s,
                Step::Pause { seconds, .. } => *seconds,
                Step::Wait { signal, .. } => expected(signal),
                Step::Output { .. } | Step::Load { .. } => 0.0,
            };
        }
        Timeline { steps: &variant.steps, starts, total_s }
    }

    /// The first wait for a signal.
    pub(super) fn wait(&self, signal: &str) -> Option<usize> {
        self.steps
            .iter()
            .position(|step| matches!(step, Step::Wait { signal: of, .. } if of == signal))
    }

    /// The event at a step: an output, or a departure from a stop point.
    fn event(&self, at: usize) -> Option<Event> {
        let count = self.steps.len();
        let mut before = (1..count).map(|back| &self.steps[(at + count - back) % count]);
        let stood = before.find_map(|step| match step {
            Step::Move { stops, .. } => Some(*stops),
            _ => None,
        });
        match &self.steps[at] {
            Step::Output { signal, level, .. } => Some(Event::Output {
                place: self.steps[at].place(),
                signal: signal.clone(),
                level: *level,
            }),
            Step::Move { .. } if stood.unwrap_or(true) => {
                Some(Event::Departure { place: self.steps[at].place() })
            }
            _ => None,
        }
    }

    /// Time from a step to the next wait at `wait` \[s\].
    fn lag(&self, from: usize, wait: usize) -> f64 {
        let lag = self.starts[wait] - self.starts[from];
        if from < wait { lag } else { lag + self.total_s }
    }

    /// The events that may start a machine for which the robot waits at `wait`, with the time from the
    /// last occurrence of each to the wait \[s\]; latest first.
    pub(super) fn starters(&self, wait: usize) -> Vec<(Event, f64)> {
        let count = self.steps.len();
        let mut found: Vec<(Event, f64)> = Vec::new();
        for back in 1..count {
            let at = (wait + count - back) % count;
            if let Some(event) = self.event(at)
                && !found.iter().any(|(known, _)| *known == event)
            {
                found.push((event, self.lag(at, wait)));
            }
        }
        found.retain(|(_, lag)| *lag >= SHORTEST_S);
        found
    }
}
