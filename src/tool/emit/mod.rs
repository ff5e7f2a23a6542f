//! RAPID text of streams, from templates.
//!
//! New modules are rendered completely. The original only gets insertions, so all its bytes stay.

mod brake_note;
mod excitation;
mod generated;
mod guard;
mod layout;
mod literal;
pub mod names;
mod recorder;
mod site;
mod stream_module;
mod stream_test;

pub use brake_note::{BrakeDwell, brake_note};
pub use excitation::{Excitation, LoggedTorques, Points, excitation};
pub use generated::{
    EGM_STEP_S, GeneratedMove, GeneratedNames, egm_module, egm_rows, generated_module, jointtarget,
    main_module, stream_time,
};
pub use guard::{EDIT_REMARKS, end_of_line};
pub use layout::Layout;
pub use names::{Names, has_streams, missing_streams, redeclared_name};
pub use recorder::{
    MOST_NOTES, RecordedSignal, RecordedSite, Recorder, Sampling, log_name, recorder,
};
pub use site::{
    EmitError, Emitted, EmittedStream, MotionSettings, Now, Parameter, Pause, PutOff, Recorded,
    Robot, Site, Stop, Word,
};
pub use stream_module::{Emission, emit};
pub use stream_test::{TestStream, stream_test};
