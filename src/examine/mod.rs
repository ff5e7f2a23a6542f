//! The examination of `gap`: robots with known faults.
//!
//! - [`blind`]: simulated robots, cases with sealed labels, and their grades;
//! - [`injected`]: logs of real robots with faults added.
//!
//! The examiner shares no formula with the examined: [`blind`] uses robot models alone,
//! [`injected`] also their rigid-body dynamics and their identification.

pub mod blind;
pub mod injected;
