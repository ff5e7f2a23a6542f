//! The planning tasks of the optimiser.

use super::candidate::{Candidate, pending};
use super::job::Job;
use super::settings::Settings;
use crate::arm::robot::Model;
use crate::retime::energy::{Account, EnergyParts, account};
use crate::retime::optimize::freedom::Freedom;
use crate::retime::optimize::retime::Task;

/// A job for the robot whose energy is minimised.
pub(super) struct Planning<'a> {
    pub(super) job: &'a Job<'a>,
    /// The robot whose energy is minimised.
    pub(super) model: &'a Model,
    /// The settings with that robot's loads.
    pub(super) settings: Settings,
    /// Energy of the original with that robot.
    account: Account,
}

impl<'a> Planning<'a> {
    pub(super) fn new(job: &'a Job<'a>) -> Planning<'a> {
        let (model, simulation) = (job.aim(), &job.original.cycle.simulation);
        let settings = job.settings.with_shown_loads(model, simulation);
        Planning { job, model, settings, account: account(model, simulation) }
    }

    /// The planning task of a candidate; `None` if it never runs.
    pub(super) fn task<'f>(
        &'f self,
        candidate: &Candidate,
        freedom: &'f Freedom,
    ) -> Option<Task<'f>> {
        let original = &self.job.original;
        let event = *original.events(candidate).first()?;
        let parts = self.account.events[event].iter();
        Some(Task {
            model: self.model,
            run: original.run(candidate)?,
            energy_before: parts.fold(EnergyParts::default(), |a, b| a + *b),
            spacing_s: self.settings.spacing_s,
            closest_s: self.settings.closest_s,
            freedom,
            cost: self.settings.cost,
        })
    }

    /// The tasks of the pending candidates, with their indices.
    pub(super) fn tasks(&self, candidates: &[Candidate]) -> Vec<(usize, Task<'_>)> {
        let task = |(i, c): (usize, &_)| Some((i, self.task(c, &self.settings.freedom)?));
        pending(candidates).filter_map(task).collect()
    }
}
