//! Ids of effects and functions that need a treatment of their own.

/// Effects of the log, which robot files keep as numbers of their own.
pub(super) const OF_LOG: [&str; 4] =
    ["apparent_torque", "encoder_offset", "torque_offset", "torque_constant"];

/// An effect that is a body.
pub(super) const LOAD: &str = "payload";

/// An effect whose shape is a coupling.
pub(super) const COUPLING: &str = "wrist_coupling";
/// Joints that it couples.
pub(super) const OF_WRIST: [usize; 2] = [4, 5];

/// Laws of what is there where a joint turns back.
pub(super) const OF_TURNS: [&str; 2] = ["stribeck", "presliding"];

/// Functions of time that were found, whose windows may be gated effects.
pub(super) const OF_TIME: [&str; 2] = ["time", "time_and_sense"];

/// Ids of lateness.
pub(super) const OF_CLOCKS: [&str; 2] = ["time_delay", "filter_lag"];

/// Effects with windows.
pub(super) const GATED: [&str; 2] = ["brake_drag", "contact"];

/// Its friction at breakaway is bounded by the friction at speed.
pub(super) const STRIBECK: &str = "stribeck";
