//! The interface between the execution of a program and the simulated robot.

use nalgebra::Isometry3;

use crate::rapid::ir::movement::{Movement, Output, Unresolved, Wait};

/// Receives the movements, waits and outputs of a program, and supplies inputs and positions.
pub trait Machine {
    /// A movement, or the reason why it is unknown.
    fn on_movement(&mut self, movement: Result<Movement, Unresolved>);
    /// A wait; returns how it ended.
    fn on_wait(&mut self, wait: Wait) -> WaitResult;
    /// A change of an output.
    fn on_output(&mut self, output: Output);
    /// An endless loop begins: the events from here on repeat.
    fn on_endless_loop(&mut self) {}
    /// The program left the loop that [`Machine::on_endless_loop`] announced.
    fn on_loop_left(&mut self) {}
    /// Whether an input has changed, if its time is known; if so, its next delay starts then.
    fn input_has_changed(&mut self, _signal: &str) -> Option<bool> {
        None
    }
    /// Time, from the start of the program, at which an input changes, if known, s.
    fn input_change_time(&mut self, _signal: &str) -> Option<f64> {
        None
    }
    /// Number of passes to simulate of an endless loop.
    fn endless_loop_passes(&self) -> u32 {
        1
    }
    /// The level that the user states for an input (name in lower case).
    fn stated_level(&self, _signal: &str) -> Option<f64> {
        None
    }
    /// Axis positions in rad, if the robot stands still at a known position.
    fn joints(&mut self) -> Option<[f64; 6]> {
        None
    }
    /// The pose of the flange in the world frame at these joint angles (rad), if there is a robot.
    fn flange(&self, _q: &[f64; 6]) -> Option<Isometry3<f64>> {
        None
    }
    /// The speed override that the operator has set, %.
    fn override_percent(&self) -> f64 {
        100.0
    }
    /// The robot type that the controller reports.
    fn robot_type(&self) -> Option<String> {
        None
    }
    /// True once a limit of time or length is reached; the machine itself reports the reason.
    fn is_at_limit(&self) -> bool {
        false
    }
}

/// How a wait ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaitResult {
    /// Its condition came true, or its stated time is over.
    Ended,
    /// Its `\\MaxTime` expired first.
    TimedOut,
}
