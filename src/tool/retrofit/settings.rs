//! Settings of a retrofit.

use std::collections::BTreeSet;

use crate::arm::robot::Model;
use crate::rapid::text::Span;
use crate::retime::motion::{Options, Simulation};
use crate::retime::optimize::allowed::Loads;
use crate::retime::optimize::cost::Cost;
use crate::retime::optimize::freedom::Freedom;
use crate::retime::optimize::resting::IdleState;
use crate::tool::emit::Layout;

/// The quantity to minimise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Objective {
    /// Energy within the time budget.
    #[default]
    Energy,
    /// Cycle time.
    Time,
}

/// The time budget.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Budget {
    /// No run takes longer than in the original.
    #[default]
    AsBefore,
    /// Cycle time, s.
    Takt(f64),
    /// Duration of each run as a multiple of its original duration, at most 10.
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
    /// Positions for externally guided motion in separate files.
    Guided,
}

/// Settings of a retrofit.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The routine that starts the program.
    pub entry: String,
    /// Options of the simulations.
    pub options: Options,
    /// The quantity to minimise.
    pub objective: Objective,
    /// The time budget.
    pub budget: Budget,
    /// Idle states of the controller for the rest of the takt.
    pub idle: Vec<IdleState>,
    /// Minimum time between two points of a stream, s.
    pub spacing_s: f64,
    /// The same if the polygon of the points would otherwise be too far from the path, s.
    pub closest_s: f64,
    /// Which constraints of the movements a stream may leave.
    pub freedom: Freedom,
    /// The part of the text whose runs may become streams; `None`: all of it.
    pub only: Option<Span>,
    /// The form of the output.
    pub form: Form,
    /// Layout of the points of streams.
    pub layout: Layout,
    /// The cost that represents energy.
    pub cost: Cost,
    /// Maximum displacement of each joint to a waiting pose of lower power, rad; `None`: no
    /// relocation.
    pub dwell_pose: Option<f64>,
    /// Whether to use only the model's own numbers, without plausible robots.
    pub point_estimate: bool,
    /// Whether movements with inline targets may become streams: `ModPos` would change such a
    /// target only in the original branch of the guard.
    pub inline_targets: bool,
    /// Number of points of the energy-time curves of the cycle and of each segment; 0 for no curve and
    /// no table of spacings.
    pub pareto: usize,
    /// Lower-case names of `PERS` data that other tasks of the controller may write.
    pub written_elsewhere: BTreeSet<String>,
    /// Lower-case names of `PERS` data that other tasks of the controller may read. `None`: not
    /// known, so all that are global may be.
    pub read_elsewhere: Option<BTreeSet<String>>,
}

/// Time spacing of the points that a controller plans, s.
pub const SPACING_S: f64 = 0.05;
/// The same if the polygon of the points would otherwise be too far from the path, s.
pub const CLOSEST_S: f64 = 0.04;

impl Default for Settings {
    /// Minimum-energy streams from `main`, with no freedom.
    fn default() -> Settings {
        Settings {
            entry: "main".into(),
            options: Options::default(),
            objective: Objective::default(),
            budget: Budget::default(),
            idle: Vec::new(),
            spacing_s: SPACING_S,
            closest_s: CLOSEST_S,
            freedom: Freedom::default(),
            only: None,
            form: Form::default(),
            layout: Layout::default(),
            cost: Cost::default(),
            dwell_pose: None,
            point_estimate: false,
            inline_targets: false,
            pareto: 0,
            written_elsewhere: BTreeSet::new(),
            read_elsewhere: None,
        }
    }
}

impl Settings {
    /// The settings with the peak joint loads of the original as limits for streams.
    pub(super) fn with_shown_loads(&self, model: &Model, original: &Simulation) -> Settings {
        let loads = Some(Loads::shown(model, original));
        Settings { freedom: Freedom { loads, ..self.freedom.clone() }, ..self.clone() }
    }
}
