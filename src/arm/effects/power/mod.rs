//! Losses of motors and drives, power of the cabinet.

pub(super) mod base_load;
pub(super) mod brake_power;
pub(super) mod copper_loss;
pub(super) mod inverter_loss;
pub(super) mod iron_loss;
pub(super) mod no_regeneration;
