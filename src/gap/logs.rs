//! From logs, and those of a baseline, to a verdict.

use crate::arm::robot::Model;
use crate::learn::identify::Samples;

use super::diagnose::{Settings, diagnose, diagnose_telling};
use super::diagnosis::Diagnosis;
use super::phase::Phase;
use super::record::Record;

/// What differs from start to start: no part of the robot.
const OF_THE_DAY: &str = "warm_up";

/// Logs of a robot.
#[derive(Clone, Copy)]
pub struct Logs<'a> {
    /// Those that show it as it is now.
    pub train: &'a [&'a Samples],
    /// Those that only grade; without them, the same.
    pub held: &'a [&'a Samples],
    /// Those from when the model was believed true.
    pub before: &'a [&'a Samples],
}

/// Diagnoses what has changed since the baseline, or, without one, all that the model has not;
/// `tell` is called with each phase that begins.
#[must_use]
pub fn diagnose_logs(
    model: &Model,
    logs: Logs<'_>,
    settings: &Settings,
    tell: &dyn Fn(Phase),
) -> Diagnosis {
    // Repetitions tell their noise; a log without them cannot be weighed against one with them.
    let repeats = |log: &Samples| log.repetitions.is_some();
    let comparable = |log: &Samples| logs.train.iter().all(|of| repeats(of) == repeats(log));
    let before: Vec<&Samples> = logs.before.iter().copied().filter(|log| comparable(log)).collect();
    let known = (!before.is_empty()).then(|| {
        tell(Phase::Baseline);
        robot_of(model, &before, settings)
    });
    let believed = known.as_ref().map_or(model, |known| &known.improved.applied);
    let held = if logs.held.is_empty() { logs.train } else { logs.held };
    let mut train = all(believed, logs.train);
    train.extend(before.iter().flat_map(|log| Record::before(believed, log)));
    let found = diagnose_telling(model, train, &all(believed, held), settings, tell);
    Diagnosis { before: known.map(|known| known.effects), ..found }
}

/// What a baseline shows of the robot.
fn robot_of(model: &Model, before: &[&Samples], settings: &Settings) -> Diagnosis {
    let of_robot = settings.effects.iter().filter(|effect| effect.id != OF_THE_DAY);
    let settings = Settings { trust: settings.trust, effects: of_robot.copied().collect() };
    diagnose(model, all(model, before), &all(model, before), &settings)
}

fn all<'m>(model: &'m Model, logs: &[&Samples]) -> Vec<Record<'m>> {
    logs.iter().flat_map(|log| Record::all(model, log)).collect()
}
