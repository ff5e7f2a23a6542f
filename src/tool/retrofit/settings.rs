//! How a program is retrofitted.

use std::collections::BTreeSet;

use crate::arm::robot::Model;
use crate::retime::motion::{Options, Simulation};
use crate::retime::optimize::allowed::Loads;
use crate::retime::optimize::cost::Cost;
use crate::retime::optimize::freedom::Freedom;
use crate::tool::emit::Layout;

/// What is to be minimised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Objective {
    /// Energy in the time that there is.
    #[default]
    Energy,
    /// Time.
    Time,
}

/// The time that there is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Budget {
    /// No run takes longer than before.
    #[default]
    AsBefore,
    /// The cycle takes this long, s.
    Takt(f64),
    /// Each run takes this many times as long as before, at most
    /// [`SLOWEST`](crate::retime::optimize::retime::SLOWEST).
    Factor(f64),
}

/// What a retrofit writes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Streams of joint targets in place of movements.
    #[default]
    Streams,
    /// The movements with other speeds.
    Speeds,
    /// Positions for externally guided motion beside the program.
    Guided,
}

/// How a program is retrofitted.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The routine that starts the program.
    pub entry: String,
    /// For the simulations.
    pub options: Options,
    /// What is to be minimised.
    pub objective: Objective,
    /// The time that there is.
    pub budget: Budget,
    /// Least time between two points of a stream, s.
    pub spacing_s: f64,
    /// The same where the polygon of the points would be too far from the path otherwise, s.
    pub closest_s: f64,
    /// What streams may do that the movements did not.
    pub freedom: Freedom,
    /// What is written.
    pub form: Form,
    /// How the points of streams are written.
    pub layout: Layout,
    /// What stands for energy.
    pub cost: Cost,
    /// How far each joint may go to a pose at which waiting takes less, rad; `None` where the robot
    /// waits where it stands.
    pub dwell_pose: Option<f64>,
    /// Whether the model's numbers are taken as they are, without robots that are as plausible.
    pub point_estimate: bool,
    /// Whether movements may become streams whose targets stand in them: `ModPos` would change the
    /// text of such a movement, behind its guard.
    pub inline_targets: bool,
    /// Points of the curve of energy over time of each segment; 0 for none.
    pub pareto: usize,
    /// Lower-case names of `PERS` data that other tasks of the controller may write.
    pub written_elsewhere: BTreeSet<String>,
}

/// Spacing of the points that a controller plans in time, s.
pub const SPACING_S: f64 = 0.05;
/// The same where the polygon of the points would be too far from the path otherwise, s.
pub const CLOSEST_S: f64 = 0.04;

impl Default for Settings {
    /// Streams of least energy from `main`, with no freedom.
    fn default() -> Settings {
        Settings {
            entry: "main".into(),
            options: Options::default(),
            objective: Objective::default(),
            budget: Budget::default(),
            spacing_s: SPACING_S,
            closest_s: CLOSEST_S,
            freedom: Freedom::none(),
            form: Form::default(),
            layout: Layout::default(),
            cost: Cost::default(),
            dwell_pose: None,
            point_estimate: false,
            inline_targets: false,
            pareto: 0,
            written_elsewhere: BTreeSet::new(),
        }
    }
}

impl Settings {
    /// The settings with the loads that the joints of a robot bear in the original: streams ask no
    /// more of them.
    pub(super) fn with_shown_loads(&self, model: &Model, original: &Simulation) -> Settings {
        let loads = Some(Loads::shown(model, original));
        Settings { freedom: Freedom { loads, ..self.freedom.clone() }, ..self.clone() }
    }
}
