//! The rows of spectra that are compared, and everything that may explain them.
//!
//! A design has the rows of each joint: the difference between measured and predicted torque, and
//! the torques of one standard deviation of each nuisance. Rows are grouped into cells: one log, one
//! band of frequencies, one variance.

mod basis;
mod brought;
mod column;
mod everyday;
mod forms;
mod joint;
mod packed;
mod parameters;
mod piece;
mod planned;
mod problem;
mod set;

pub(in crate::gap) use brought::BroughtEffect;
pub(in crate::gap) use everyday::Group;
pub(in crate::gap) use joint::{Cell, JointDesign};
pub(in crate::gap) use packed::Packed;
pub(in crate::gap) use parameters::Parameters;
pub(in crate::gap) use piece::{PieceRows, Rise, Times, Whole, link_pieces, piece_at, piece_rows};
pub(in crate::gap) use problem::Design;
pub(in crate::gap) use set::Set;
