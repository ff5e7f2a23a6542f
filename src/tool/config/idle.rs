//! The tables `[idle.NAME]` of the configuration.

use serde::Deserialize;

/// An idle state of the controller, in which the robot may spend the rest of the takt.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Idle {
    /// Power of the robot from the grid, W.
    pub power_w: f64,
    /// Time until the robot can move again, s.
    pub wake_s: f64,
    /// Energy of waking up beyond that of standing, J.
    #[serde(default)]
    pub wake_j: f64,
}

impl Idle {
    /// What is wrong with its numbers.
    pub(super) fn fault(&self, name: &str) -> Option<String> {
        let numbers = [
            ("power_w", self.power_w, "W"),
            ("wake_s", self.wake_s, "s"),
            ("wake_j", self.wake_j, "J"),
        ];
        let wrong = numbers.into_iter().find(|(_, x, _)| !(x.is_finite() && *x >= 0.0));
        wrong.map(|(key, x, unit)| {
            format!("[idle.{name}]: {key} = {x}: give a number of {unit} that is 0 or more")
        })
    }
}
