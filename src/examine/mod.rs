//! The examination of `gap`: simulated robots with known faults.
//!
//! - [`blind`]: cases with sealed labels, and their grades.
//!
//! It uses robot models alone: the examiner shares no formula with the examined.

pub mod blind;
