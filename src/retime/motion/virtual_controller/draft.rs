//! Items that are not yet on the time line.

use crate::arm::dynamics::Load;
use crate::rapid::ir::movement::{Output, Unresolved, Wait};
use crate::retime::motion::run_plan::RunDraft;
use crate::retime::path::joint_path::Joints;

/// A wait at the joint angles q (rad).
pub(super) struct WaitDraft {
    pub(super) wait: Wait,
    pub(super) q: Joints,
    pub(super) load: Load,
}

/// An item that becomes an event.
pub(super) enum Draft {
    Run(Box<RunDraft>),
    Wait(Box<WaitDraft>),
    Output(Output, usize),
    Left(Unresolved),
}
