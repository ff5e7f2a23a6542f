//! Measurements: from logs to models of robots.
//!
//! - [`log`]: measured logs as columns in SI units;
//! - [`excite`]: motions that determine the parameters of a robot;
//! - [`identify`]: a dynamic model with standard errors from logs of torques or currents;
//! - [`calibrate`]: an estimated robot, narrowed by a log of its power.
//!
//! It uses `arm`; `excite` and `calibrate` also use the motions and energies of `retime`.

pub mod calibrate;
pub mod excite;
pub mod identify;
pub mod log;
