//! The log of events that a recorder writes (`docs/cell.md`), and its cycles.

mod cycles;
mod error;
mod event;
mod order;
mod read;
#[cfg(test)]
mod tests;

pub use cycles::{Cycle, Visit, cycles};
pub use error::EventsError;
pub use event::{Event, Place, What};
pub use read::{Recording, Session, is_event_log, read};
