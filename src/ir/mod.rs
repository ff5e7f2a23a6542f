//! From syntax to movements: modules, symbols, values, execution. Knows no robot.

pub mod hir;
mod instructions;
mod lower;

pub use instructions::is_movement;
pub use lower::lower;
