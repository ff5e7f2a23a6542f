//! An awaited signal in the course of a run: when it comes and when it falls.

use super::draw::Machine;
use super::law::{Memory, Moment};
use super::truth::LATER_S;

/// Shortest time for which a signal is 0 \[s\].
const LOW_S: f64 = 0.02;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Level {
    Low,
    /// 1 since the start.
    There,
    /// 1 since a time.
    Since(f64),
}

/// A signal as it is now. Times are those of the plant's clock \[s\].
#[derive(Clone, Debug)]
pub(super) struct Signal {
    memory: Memory,
    level: Level,
    /// Whether it falls when the robot goes on.
    falls_next: bool,
    fell: f64,
    /// The starting event that the machine has used.
    used: Option<f64>,
}

/// What a wait meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coming {
    /// When the signal came; `None` if it is there since the start.
    pub(super) came: Option<f64>,
    /// Whether this is a change of which no other wait has told.
    pub(super) changed: bool,
    /// How much later it would have come for a robot that comes [`LATER_S`] later.
    pub(super) later_s: f64,
}

impl Signal {
    pub(super) fn low() -> Signal {
        Signal {
            memory: Memory::default(),
            level: Level::Low,
            falls_next: true,
            fell: f64::NEG_INFINITY,
            used: None,
        }
    }

    /// When it falls, if it does, now that the robot goes on.
    pub(super) fn go_on(&mut self, now: f64, machine: &Machine) -> Option<f64> {
        if self.level == Level::Low || !self.falls_next {
            return None;
        }
        self.level = Level::Low;
        self.fell = now + machine.falls_s;
        self.memory.taken.push(self.fell);
        Some(self.fell)
    }

    /// Whether it keeps its level when the robot goes on.
    pub(super) fn keep(&mut self, stays: bool) {
        self.falls_next = !stays;
    }

    /// A robot comes to wait for it. `last` is when the event occurred that starts the machine.
    pub(super) fn visit(&mut self, machine: &Machine, last: Option<f64>, of: Moment) -> Coming {
        match self.level {
            Level::There => return Coming { came: None, changed: false, later_s: 0.0 },
            Level::Since(came) => {
                return Coming { came: Some(came), changed: false, later_s: 0.0 };
            }
            Level::Low => {}
        }
        // A machine that nothing has started again begins when the robot has gone.
        let fell = Some(self.fell).filter(|fell| fell.is_finite());
        let anchor = last.filter(|last| Some(*last) != self.used).or(fell);
        let moment = Moment { anchor, fell: self.fell, ..of };
        let later = Moment { arrived: moment.arrived + LATER_S, ..moment };
        let lowest = self.fell + LOW_S;
        let mut memory = self.memory.clone();
        let came = machine.law.comes(&moment, &mut self.memory).map(|t| t.max(lowest));
        let later = machine.law.comes(&later, &mut memory).map(|t| t.max(lowest));
        self.used = last;
        self.level = came.map_or(Level::There, Level::Since);
        let later_s = later.zip(came).map_or(0.0, |(later, came)| later - came);
        Coming { came, changed: came.is_some_and(|came| came >= 0.0), later_s }
    }
}
