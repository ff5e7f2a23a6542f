//! What changed in meaning between two programs.
//!
//! Both programs are read to plain data, so that layout, comments, headers and the form of numbers
//! are gone. `matching` finds which modules, routines and data correspond, `align` which statements;
//! `values` tells how values differ, in millimetres and degrees. `cycle` simulates both.

mod align;
mod canonical;
mod change;
mod comparison;
mod context;
mod cost;
mod cycle;
mod data;
mod declared;
mod edit_distance;
mod exact;
mod matching;
mod names;
mod node;
mod number;
mod parts;
mod print;
mod program;
mod side;
mod state;
mod statement;
mod statements;
mod unread;
mod values;

pub use change::{Action, Change, Subject};
pub use comparison::{Comparison, Robot, compare};
pub use cycle::{Costs, Cycle, Procedure, Totals};
pub use print::meaning;
pub use side::{Group, Side};
pub use values::{Difference, DifferenceKind};
