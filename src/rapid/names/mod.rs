//! What the names of a program mean.
//!
//! [`Names`] is built from the parsed files of one task. It tells for each identifier what it
//! names ([`Meaning`]), for each [`Declaration`] where it is used, and which names are visible at a
//! place. It works on text with syntax errors: what the parser could not read has no names.
//!
//! Scopes, from the innermost: FOR counters, parameters and data of a routine, LOCAL names of a
//! module, global names of the task, predefined names. Components belong to the type of the value
//! before the dot, argument names to the called routine, labels to their routine. A procedure that
//! is called by a string (`%"proc"%`) is not resolved: the string may be any.

mod build;
mod collect;
mod declaration;
mod index;
mod keys;
mod predefined;
mod resolve;
mod uses;

pub use build::SourceText;
pub use declaration::{
    Access, Basic, Declaration, DeclarationId, Kind, Mode, Reach, RoutineKind, Storage, ValueType,
};
pub use index::Names;
pub use uses::{Meaning, Role, Use};
