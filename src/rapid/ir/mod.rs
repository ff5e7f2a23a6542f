//! From syntax to movements: modules, symbols, values, execution. Independent of the robot.

mod convert;
pub mod exec;
mod functions;
pub mod graph;
pub mod hir;
mod lower;
pub mod movement;
pub mod number;
pub mod predefined;
pub mod program;
pub mod reads;
pub mod signals;
pub mod upcoming;
mod user;
pub mod value;
pub mod walk;

pub use lower::lower;
