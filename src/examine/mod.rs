//! The examination of `gap`: robots with known faults.
//!
//! - [`blind`]: simulated robots, cases with sealed labels, and their grades;
//! - [`injected`]: logs of real robots with faults added;
//! - [`worlds`]: three further simulators, with cases of the same format.
//!
//! The examiner shares no formula with the examined: [`blind`] uses robot models alone,
//! [`injected`] also their rigid-body dynamics and their identification, [`worlds`] nothing.

pub mod blind;
pub mod injected;
pub mod worlds;
