//! Timing and tracking by the motion controller.

pub(super) mod acceleration_limit;
pub(super) mod program_wait;
pub(super) mod speed_limit;
pub(super) mod tracking_lag;
pub(super) mod zone_blending;
