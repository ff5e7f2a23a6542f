//! Measurements: logs, excitation motions, and models from logs.
//!
//! It uses `arm` and `retime`.

pub mod calibrate;
pub mod excite;
pub mod identify;
pub mod log;
