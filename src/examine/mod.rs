//! The examination of `gap`: robots with known faults.
//!
//! - [`blind`]: simulated robots, cases with sealed labels, and their grades;
//! - [`injected`]: logs of real robots with faults added;
//! - [`worlds`]: three further simulators, with cases of the same format.
//!
//! `plant` simulates a cell with machines and people, for the methods that read a cell's logs.
//!
//! The examiner shares no formula with the examined: [`blind`] uses robot models alone,
//! [`injected`] also their rigid-body dynamics and their identification, [`worlds`] and `plant` nothing.

pub mod blind;
pub mod injected;
#[cfg(feature = "internals")]
pub mod plant;
pub mod worlds;
