//! Exceptions.

use pyo3::create_exception;
use pyo3::exceptions::PyValueError;

create_exception!(joulepath, JoulepathError, PyValueError, "An input that joulepath cannot use.");
create_exception!(joulepath, RobotError, JoulepathError, "A robot that is unknown or unusable.");
