//! The table of RAPID's built-ins: instructions, functions, data types and predefined data.
//!
//! All facts about built-in names are here. To add an instruction, add one line to the table of
//! its topic; if the executor has no code for its effect, add a variant to [`Effect`] and a
//! function in `ir/exec`. Names and arguments: RAPID reference of `RobotWare` 6; those of process
//! instructions: the application manuals.

mod communication;
mod data;
mod declarations;
mod function;
mod functions;
mod index;
mod instruction;
mod known;
mod movements;
mod parameter;
mod processes;
mod program;
mod settings;
mod signals;
#[cfg(test)]
mod tests;
mod types;

pub use data::{
    Cause, Literal, Predefined, error, is_controller_specific, predefined, speeds, zones,
};
pub use declarations::{DECLARATIONS, OTHERS};
pub use function::{Function, Source};
#[cfg(test)]
pub(in crate::rapid) use functions::FUNCTIONS;
pub use index::{function, instruction, is_movement, is_of_move_family, may_write, movement};
pub use instruction::{
    Count, Effect, Instruction, Level, MoveForm, MoveKind, MoveSignature, Setting, Wait,
};
pub use known::{is_known, is_listed, routine_names};
pub use parameter::ArgumentPlace;
pub use types::{DataType, SignalKind, data_type};
