//! The thin binary.

use std::process::ExitCode;

fn main() -> ExitCode {
    joulepath::command_line()
}
