//! joulepath for Python: arrays in and out, without the global lock while it computes.

mod arrays;
mod error;
mod robot;

use pyo3::pymodule;

/// The compiled part of the package `joulepath`.
#[pymodule]
mod _joulepath {
    #[pymodule_export]
    use super::error::{JoulepathError, RobotError};
    #[pymodule_export]
    use super::robot::{Load, Robot, robots};
}
