//! Measurements: logs, motions that tell parameters, and models from logs.
//!
//! It uses `arm` and `retime`.

pub mod calibrate;
pub mod excite;
pub mod identify;
pub mod log;
