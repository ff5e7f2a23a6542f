//! Sealed examination of a diagnosis: a simulator with its own formulas generates cases with known
//! faults, and the diagnoses are graded.
//!
//! No formula is shared with the examined code: inverse dynamics uses virtual work in the base
//! frame ([`torque`]), friction and gears obey differential equations or laws that differ from
//! textbook forms, noise is coloured, and healthy robots have model errors, too. `docs/blind.md`
//! describes the content of a case.

mod action;
mod bench;
mod case;
mod compliance;
mod conduct;
mod detect;
mod disturbance;
mod fault;
mod fourier;
mod grade;
mod label;
mod mechanics;
mod model_error;
mod motion;
mod noise;
mod pick_place;
mod plant;
mod profile;
mod program;
pub(in crate::examine) mod random;
mod robots;
mod scale;
mod seal;
mod simulate;
mod sizes;
mod trust;
#[cfg(feature = "internals")]
mod unlogged;
mod workspace;

pub use bench::Settings;
pub use case::{Case, case};
pub use grade::{
    Asked, Bin, DiagnosisError, FAMILY, Grades, Rate, Stated, Wrong, grade, is_of, stated,
};
pub use label::{HeldOut, Kind, Label, TrueParameter, Truth};
#[cfg(feature = "internals")]
pub use plant::torque;
pub use seal::{KEY, SEALS, SealError, Sealed, open, seal};
#[cfg(feature = "internals")]
pub use unlogged::{Unlogged, further, unlogged};
