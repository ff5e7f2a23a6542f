//! The input of a retrofit: program, robot, settings.

use super::candidate::Candidate;
use super::files::Source;
use super::lowered::Lowered;
use super::settings::Settings;
use super::simulated::Simulated;
use crate::arm::robot::Model;
use crate::rapid::ir::program::{Program, RoutineId};
use crate::retime::energy::plausible::Robots;
use crate::retime::motion::timeline::{Run, What};
use crate::retime::optimize::site::Site;

/// The original program: text, simulated cycle, sites of possible changes.
pub(super) struct Original<'a> {
    pub(super) files: &'a [Source],
    pub(super) program: &'a Program,
    pub(super) entry: RoutineId,
    pub(super) cycle: Simulated,
    pub(super) sites: Vec<Site>,
    /// Its cycle under lower limits than assumed.
    pub(super) lowered: Vec<Lowered>,
}

impl Original<'_> {
    /// The events in which a candidate runs, as indices into `Simulation::events`.
    pub(super) fn events(&self, candidate: &Candidate) -> &[usize] {
        &self.sites[candidate.site].variants[candidate.variant].events
    }

    /// The first run of a candidate; all its runs are equal.
    pub(super) fn run(&self, candidate: &Candidate) -> Option<&Run> {
        match &self.cycle.simulation.events[*self.events(candidate).first()?].what {
            What::Run(run) => Some(run),
            _ => None,
        }
    }
}

/// The input of all stages.
pub(super) struct Job<'a> {
    pub(super) original: Original<'a>,
    pub(super) model: &'a Model,
    pub(super) settings: Settings,
    /// The plausible robots; `None` for a point estimate.
    pub(super) robots: Option<Robots>,
    /// Their mean, if the torque limits are estimated.
    pub(super) mean: Option<Model>,
}

impl Job<'_> {
    /// The robot whose energy is minimised.
    pub(super) fn aim(&self) -> &Model {
        self.mean.as_ref().unwrap_or(self.model)
    }
}
