//! The sealed examination of `gap`: simulated robots with known faults.
//!
//! It uses robot models alone: the examiner shares no formula with the examined.

pub mod blind;
