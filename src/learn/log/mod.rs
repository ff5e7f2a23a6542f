//! Measured logs as columns of numbers: reading, repetitions, derivatives, synchronisation. This
//! module does not depend on a robot model.

mod arrays;
mod averaged;
mod bandwidth;
mod channel;
mod columns;
mod contradiction;
mod csv;
mod data;
mod differentiate;
mod error;
mod header;
mod low_pass;
mod marks;
mod motion;
mod notation;
#[cfg(feature = "parquet")]
mod parquet;
mod part;
#[cfg(test)]
mod periodic_motion;
mod periods;
mod read;
mod rows;
mod scan;
mod text_row;
mod three_phase;
mod time_order;
mod time_shift;
mod uniform;
mod utf16;

pub use averaged::{Averaged, averaged};
pub use bandwidth::bandwidth;
pub use channel::Channel;
pub use columns::ColumnMap;
pub use contradiction::{Jumps, spikes, stays};
pub use csv::read_csv;
pub use data::{Log, MIN_ROWS, Rejected};
pub use differentiate::derivatives;
pub use error::LogError;
pub use low_pass::LowPass;
pub use marks::{Aligned, aligned, are_halves};
pub use motion::Motion;
pub use periods::{Periods, find_periods};
pub use read::{read, read_from};
pub use scan::{Scan, scan};
pub use three_phase::{Signed, Vectors, coherence, signed, vectors};
pub use time_shift::{Shift, between_grid, downhill, golden_section, on_grid, vertex};
pub use uniform::{Section, interpolated, median_step, quantile, range, sections};
