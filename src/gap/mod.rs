//! Where model and measurement part, and which effect it is.
//!
//! [`Record`] is a log ready to be compared, [`Table`] all that may explain the difference,
//! [`Evidence`] how well some of it does.

mod asserted;
mod attribution;
mod bins;
mod calibration;
mod chance;
mod channel;
mod column;
mod coupled;
mod demoted;
mod diagnose;
mod diagnosis;
mod evidence;
mod excess;
mod forms;
mod gated;
mod generic;
mod heldout;
mod hypothesis;
mod improved;
mod interval;
mod judged;
mod late;
mod load;
mod logs;
mod nuisance;
mod phase;
mod pieces;
mod places;
mod polish;
mod possible;
mod power;
mod record;
mod ripples;
mod rows;
mod runs;
mod search;
mod sizes;
mod spectrum;
mod table;
mod traces;
mod units;

pub use attribution::{Attribution, Cell, PARAMETERS, attribution};
pub use bins::Quantity;
pub use column::{Column, Owner, Piece};
pub use diagnose::{Settings, diagnose, diagnose_telling};
pub use diagnosis::{Anything, Diagnosis, Estimated, Place, Said, Verdict};
pub use evidence::{Evidence, Given};
pub use heldout::{JointGap, Shrink, beside_no_jump, predicted, shrink};
pub use hypothesis::{Family, families};
pub use improved::Improved;
pub use interval::Interval;
pub use late::Late;
pub use logs::{Logs, diagnose_logs};
pub use nuisance::Trust;
pub use phase::Phase;
pub use polish::{Fitted, Polished};
pub use power::{PowerEffect, PowerFound, Powers, diagnose_power};
pub use record::{Record, RecordKind};
pub use runs::{Run, RunEffect, RunFound, diagnose_runs};
pub use search::{Chosen, Found, Search};
pub use table::{Placed, Table};
pub use traces::{Profile, Shape, Torques, Trace, missed, profile, shapes, trace};
pub use units::common_factor;
