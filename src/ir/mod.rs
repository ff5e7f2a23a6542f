//! From syntax to movements: modules, symbols, values, execution. Knows no robot.

pub mod hir;
mod lower;

pub use lower::lower;
