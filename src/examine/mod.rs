//! Sealed examination of `gap` with simulated robots and known faults. It uses robot models only:
//! simulator and diagnosis share no formula.

pub mod blind;
