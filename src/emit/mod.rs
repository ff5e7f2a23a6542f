//! From streams to RAPID text, by templates.
//!
//! New modules are rendered whole; the original gets insertions only, so that
//! every byte of it stays.

mod brake_note;
mod excitation;
mod generated;
mod layout;
pub mod names;
pub mod stream_module;

pub use brake_note::{BrakeDwell, brake_note};
pub use excitation::{Excitation, ExcitationModules, LoggedTorques, Points, excitation};
pub use generated::{
    EGM_STEP_S, GeneratedMove, GeneratedNames, egm_module, egm_rows, generated_module, jointtarget,
    main_module, stream_time,
};
pub use layout::Layout;
pub use names::{Names, missing_streams};
pub use stream_module::{EmitError, Emitted, EmittedStream, Site, can_guard, emit, end_of_line};
