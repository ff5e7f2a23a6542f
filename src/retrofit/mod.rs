//! The main job: a program in, a verified program that takes less energy out.
//!
//! Parse, simulate, optimise, emit; then read the emitted text again, simulate
//! that, and compare. What does not hold keeps its original moves.

pub mod figures;
mod freed;
mod goals;
mod guided;
mod hazards;
mod notes;
mod outputs;
mod padding;
mod rests;
mod segments;
mod sharing;
mod signals;
mod speeds;
mod verify;
mod work;

pub use figures::{
    Figures, OutputFile, OutputKind, Padding, Retrofit, Segment, SegmentKind, Verification,
};
pub use freed::freed;
pub use outputs::read_again;
pub use signals::{SignalKind, SignalShift};
pub use work::{Budget, Form, Objective, RetrofitError, Settings, Source, read_program, retrofit};
