//! RAPID: text, syntax and the effects of a program that follow from its text alone.
//! Independent of the robot and of the other wings.

pub mod builtins;
pub mod diagnostics;
pub mod ir;
pub mod syntax;
pub mod text;
