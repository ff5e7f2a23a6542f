//! The retrofit: from a program to a verified program that takes less energy.
//!
//! It parses, simulates, optimises and emits, then reads the emitted text, simulates it and
//! compares. Pieces that fail the verification keep their original movements.

mod brakes;
mod candidate;
mod cell;
mod cycle_curve;
mod cycle_time;
mod elsewhere;
mod emission_context;
mod emitted_sites;
mod error;
mod figures;
mod files;
mod freed;
mod goals;
mod guard_cost;
mod guards;
mod guided;
mod hazards;
mod interrupts;
mod job;
mod joined;
mod lower_limits;
mod lowered;
mod notes;
mod order;
mod outputs;
mod padding;
mod pipeline;
mod planning;
mod read;
mod recorded;
mod relocated_waits;
mod results;
mod rewritten;
mod rounds;
mod segments;
mod settings;
mod sharing;
mod signals;
mod simulated;
mod spacing_table;
mod speed_arguments;
mod speed_search;
mod speed_slots;
mod speeds;
mod statements;
mod torque_demand;
mod uncertainty;
mod verify;
mod verify_speeds;
mod verify_streams;
mod whole_cycle;
mod without;

pub use brakes::BRAKE_NOTE;
pub use cell::Cell;
pub use elsewhere::{declared_in, written_in};
pub use error::RetrofitError;
pub(in crate::tool) use figures::INSTRUCTION_MS;
pub use figures::{
    Figures, LowerLimits, Retrofit, Segment, SegmentKind, SpacingSaving, Verification,
};
pub use files::{OutputFile, OutputKind, Source, read_again};
pub(in crate::tool) use files::{file_and_line, with_edits};
pub(in crate::tool) use freed::comments;
pub use freed::freed;
pub use padding::Padding;
pub use pipeline::retrofit;
pub use read::read_program;
pub use settings::{Budget, CLOSEST_S, Form, Objective, SPACING_S, Settings};
pub use signals::{SignalKind, SignalShift};
pub(in crate::tool) use simulated::Simulated;
pub use uncertainty::Uncertainty;
pub(in crate::tool) use verify::{parses, run_again};
pub(in crate::tool) use verify_speeds::largest_share;
pub use whole_cycle::{CyclePoint, Rest, TaktBasis, TaktEnergy, WholeCycle};
pub use without::{is_streams, prefix, without_streams};
