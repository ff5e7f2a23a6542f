//! What is told of a program's execution, and who is asked for what the program does not tell.

use nalgebra::Isometry3;

use crate::rapid::ir::movement::{Movement, Output, Unresolved, Wait};

/// What execution asks of the robot and tells it.
pub trait Machine {
    /// A movement, or the reason why it can't be worked out.
    fn moves(&mut self, movement: Result<Movement, Unresolved>);
    /// A wait; how it ended.
    fn waits(&mut self, wait: Wait) -> Waited;
    /// A change of an output.
    fn sets(&mut self, output: Output);
    /// An endless loop begins: what comes from here on comes again and again.
    fn repeats(&mut self) {}
    /// The loop that seemed endless was left.
    fn leaves_loop(&mut self) {}
    /// Whether an input has come, if it is known when it does. Once it has, its time counts
    /// again from here.
    fn has_come(&mut self, _signal: &str) -> Option<bool> {
        None
    }
    /// When an input comes that the program waits for, if that is known, s.
    fn comes_at(&mut self, _signal: &str) -> Option<f64> {
        None
    }
    /// How often the loop that never ends is to run.
    fn passes(&self) -> u32 {
        1
    }
    /// The level of an input that the user states, by lower-case name.
    fn stated_level(&self, _signal: &str) -> Option<f64> {
        None
    }
    /// Axis positions in rad, if the robot stands and its position is known.
    fn joints(&mut self) -> Option<[f64; 6]>;
    /// The pose of the flange in the world at these joints (rad), if a robot is there.
    fn flange(&self, _q: &[f64; 6]) -> Option<Isometry3<f64>> {
        None
    }
    /// The speed override that the operator has set, %.
    fn override_percent(&self) -> f64 {
        100.0
    }
    /// What the controller calls its robot.
    fn robot(&self) -> Option<String> {
        None
    }
    /// True once the machine wants no more (limits of time or of length); it tells why itself.
    fn is_full(&self) -> bool;
}

/// How a wait ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Waited {
    /// What it waited for came, or its time was over.
    Ended,
    /// Its `\\MaxTime` was over before.
    TimedOut,
}
