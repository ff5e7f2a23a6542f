//! A program with the robot and the settings for which it is retrofitted.

use super::original::Original;
use super::settings::Settings;
use crate::arm::robot::Model;
use crate::retime::energy::plausible::Robots;

/// What all stages work on.
pub(super) struct Job<'a> {
    pub(super) original: Original<'a>,
    pub(super) model: &'a Model,
    pub(super) settings: Settings,
    /// Robots that are as plausible as the model; `None` for a point estimate.
    pub(super) robots: Option<Robots>,
    /// Their mean, where the limits of torque are estimated.
    pub(super) mean: Option<Model>,
}

impl Job<'_> {
    /// The robot whose energy is minimised.
    pub(super) fn aim(&self) -> &Model {
        self.mean.as_ref().unwrap_or(self.model)
    }
}
