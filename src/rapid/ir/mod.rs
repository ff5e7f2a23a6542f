//! From syntax to movements: modules, symbols, values, execution. Knows no robot.

mod convert;
pub mod exec;
mod functions;
pub mod graph;
pub mod hir;
pub mod instructions;
pub mod layout;
mod lower;
pub mod movement;
pub mod number;
pub mod predefined;
mod processes;
pub mod program;
pub mod reads;
pub mod signals;
mod user;
pub mod value;

pub use instructions::{is_movement, is_of_move_family};
pub use lower::lower;
