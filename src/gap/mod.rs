//! Where model and measurement part, and which effect it is.
//!
//! `data` (records of logs) → `design` (rows, and all that may explain them) → `posterior` (how
//! probable a set of effects is) → `decision` (search, gates, verdict) → `model` (what is written) →
//! `grade` (held-out data).

mod data;
mod decision;
mod design;
mod diagnose;
mod diagnosis;
mod grade;
mod model;
mod motion;
mod phase;
mod posterior;
mod power;
mod rivals;
mod sign;
mod trust;
mod tunables;

pub use data::{Record, RecordKind, common_factor};
pub use decision::{Calibration, Entry, Estimated, Finding, Gate, Place, Remainder, Verdict};

#[cfg(feature = "internals")]
pub use diagnose::diagnose;
pub use diagnose::{Logs, Settings, diagnose_logs};
pub use diagnosis::Diagnosis;
pub use grade::{
    Attribution, Budget, Cell, Interval, JointGap, PARAMETERS, Profile, Quantity, Shape, Shrink,
    Torques, Trace, attribution, beside_no_jump, missed, predicted, profile, shapes, shrink, trace,
};
pub use model::{Fitted, Improved};
pub use motion::{Run, RunEffect, RunFound, diagnose_runs};
pub use phase::Phase;
pub use power::{PowerEffect, PowerFound, Powers, diagnose_power};
pub use rivals::{Rival, Rivals, Separation};
pub use trust::Trust;
pub use tunables::{Tunable, Tunables};
