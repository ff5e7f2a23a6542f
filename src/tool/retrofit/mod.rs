//! The main job: a program in, a verified program that takes less energy out.
//!
//! Parse, simulate, optimise, emit; then read the emitted text again, simulate
//! that, and compare. What does not hold keeps its original moves.

mod demand;
mod elsewhere;
pub mod figures;
mod freed;
mod goals;
mod guard_cost;
mod guards;
mod guided;
mod hazards;
mod lower_limits;
mod notes;
mod outputs;
mod padding;
mod recorded;
mod rests;
mod segments;
mod settings;
mod sharing;
mod signals;
mod speed_arguments;
mod speeds;
mod uncertainty;
mod verify;
mod without;
mod work;

pub use elsewhere::written_in;
pub use figures::{
    Figures, LowerLimits, OutputFile, OutputKind, Padding, Retrofit, Segment, SegmentKind,
    Verification,
};
pub use freed::freed;
pub use outputs::{BRAKE_NOTE, read_again};
pub use settings::{Budget, CLOSEST_S, Form, Objective, SPACING_S, Settings};
pub use signals::{SignalKind, SignalShift};
pub use uncertainty::Uncertainty;
pub use without::{is_streams, prefix, without_streams};
pub use work::{RetrofitError, Source, read_program, retrofit};
