//! The order of the rows of a session: one clock, one robot.

use super::error::EventsError;
use super::event::{Event, What};

/// A TRAP of the program may note out of order, s.
const INTERRUPT_S: f64 = 1.0;
/// An hour and a day, by which clocks of the day jump, and by how much such a jump may differ, s.
const HOUR_S: f64 = 3600.0;
const DAY_S: f64 = 86_400.0;
const NEAR_S: f64 = 120.0;

/// The events of a session in the order of their times, with the lines of their rows given.
pub(super) fn ordered(rows: Vec<(u64, Event)>) -> Result<Vec<Event>, EventsError> {
    let mut latest = f64::NEG_INFINITY;
    let mut current: Option<u64> = None;
    let mut before: Option<u64> = None;
    let mut waits = false;
    for (line, event) in &rows {
        let line = *line;
        // The recorder writes these behind the other rows, whatever their time.
        if matches!(event.what, What::Signal(_) | What::Flush(_) | What::Lost(_)) {
            continue;
        }
        if event.t < latest - INTERRUPT_S {
            let back_s = latest - event.t;
            return Err(EventsError::ClockBack { line, back_s, cause: cause_back(back_s) });
        }
        let forward_s = event.t - latest;
        let is_jump = (forward_s - HOUR_S).abs() < NEAR_S;
        if is_jump && !waits && current == Some(event.cycle) && event.what != What::Cycle {
            let cause = ", as clocks of the day do when summer time begins";
            return Err(EventsError::ClockForward { line, forward_s, cause });
        }
        latest = latest.max(event.t);
        match event.what {
            What::Wait => waits = true,
            What::End { .. } | What::Start | What::Arrive | What::Cycle => waits = false,
            _ => {}
        }
        match current {
            Some(now) if now != event.cycle => {
                if before == Some(event.cycle) && event.what != What::Cycle {
                    return Err(EventsError::TwoRobots { line, cycle: event.cycle, other: now });
                }
                before = Some(now);
                current = Some(event.cycle);
            }
            None => current = Some(event.cycle),
            _ => {}
        }
    }
    let mut events: Vec<Event> = rows.into_iter().map(|(_, event)| event).collect();
    events.sort_by(|a, b| a.t.total_cmp(&b.t));
    Ok(events)
}

/// What a jump back of this length usually is.
fn cause_back(back_s: f64) -> &'static str {
    if (back_s - HOUR_S).abs() < NEAR_S {
        ", as clocks of the day do when summer time ends"
    } else if (back_s - DAY_S).abs() < NEAR_S + HOUR_S {
        ", as clocks of the day do at midnight"
    } else {
        ""
    }
}
