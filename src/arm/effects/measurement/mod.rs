//! Errors of logged torques, currents and angles.

pub(super) mod apparent_torque;
pub(super) mod current_saturation;
pub(super) mod current_sign;
pub(super) mod encoder_offset;
pub(super) mod filter_lag;
pub(super) mod flux_weakening;
pub(super) mod time_delay;
pub(super) mod torque_constant;
pub(super) mod torque_offset;
