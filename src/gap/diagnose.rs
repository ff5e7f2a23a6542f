//! From logs to a diagnosis of torques.

use nalgebra::DVector;

use super::data::{Record, RecordKind};
use super::decision::{Decision, Found, Search, Verdict, decide, may_name_parameters};
use super::design::{Design, Trust};
use super::diagnosis::Diagnosis;
use super::grade::{JointGap, Shrink, budget, places, places_missed, shrink};
use super::model::{Fitted, Improved};
use super::phase::Phase;
use super::posterior::{Hypothesis, fitted, usual};
use super::tunables::Tunables;
use crate::arm::effects::{Effect, Nature};
use crate::arm::robot::Model;
use crate::learn::identify::Samples;

/// Steps of the sizes of the fit that tells the loads of the gears.
const LOADS: usize = 8;
/// Share of a joint's torque that no model of this robot misses.
const HOPELESS: f64 = 0.4;
/// Range \[rad\] and share of the rows in which a joint has to move.
const FAR: f64 = 0.05;
const OFTEN: f64 = 0.1;
/// Share of the torques below which a model without a gap is right.
const RIGHT: f64 = 0.02;

/// How a diagnosis is made.
pub struct Settings {
    /// How much the nominal parameters are believed.
    pub trust: Trust,
    /// Effects that may be found.
    pub effects: Vec<&'static Effect>,
    /// The chosen numbers of the method.
    pub tunables: Tunables,
}

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
    let held = if logs.held.is_empty() { logs.train } else { logs.held };
    let mut train = all(model, logs.train);
    train.extend(logs.before.iter().flat_map(|log| Record::before(model, log)));
    diagnose_telling(model, train, &all(model, held), settings, tell)
}

fn all<'m>(model: &'m Model, logs: &[&Samples]) -> Vec<Record<'m>> {
    logs.iter().flat_map(|log| Record::all(model, log)).collect()
}

/// Diagnoses the records `train`, graded by `held`.
#[must_use]
pub fn diagnose(
    model: &Model,
    train: Vec<Record<'_>>,
    held: &[Record<'_>],
    settings: &Settings,
) -> Diagnosis {
    diagnose_telling(model, train, held, settings, &|_| {})
}

/// The same; `tell` is called with each phase that begins.
#[must_use]
pub fn diagnose_telling(
    model: &Model,
    mut train: Vec<Record<'_>>,
    held: &[Record<'_>],
    settings: &Settings,
    tell: &dyn Fn(Phase),
) -> Diagnosis {
    tell(Phase::Design);
    let design = with_loads(&mut train, settings);
    let effects = nameable(&train, settings);
    tell(Phase::Search);
    let search = Search::new(&train, &design, &effects);
    let Some(none) = search.none() else { return Diagnosis::failed(model, held) };
    let (none, found, tried) = search.best(none);
    tell(Phase::Decision);
    let mut decision = decide(&search, &none, found, &tried);
    tell(Phase::Grading);
    let refit = improved(model, &design, &none, &[]);
    let mut best = match decision.effects.is_empty() {
        true => refit.clone(),
        false => improved(model, &design, &decision.fit, &decision.fitted),
    };
    let mut graded = shrink(held, [model, &refit.applied, &best.applied]);
    let mut reasons = Vec::new();
    if let Some(why) = refusal(&train, &graded, settings) {
        decision.withdraw(why.verdict);
        reasons.push(why.reason.to_owned());
        best = refit.clone();
        graded = shrink(held, [model, &refit.applied, &best.applied]);
    }
    let used = graded.joints.iter().filter(|joint| joint.torque > 0.0);
    let most = used.map(|joint| joint.model / joint.torque).fold(0.0, f64::max);
    if decision.verdict == Verdict::ParametersOnly && most < RIGHT {
        decision.verdict = Verdict::NoGap;
    }
    let ids: Vec<&'static str> = decision.effects.iter().map(|of| of.effect.id).collect();
    let places = if ids.is_empty() && decision.verdict == Verdict::Unknown {
        places_missed(&train, &refit)
    } else {
        places(&train, model, [&refit, &best], &ids)
    };
    Diagnosis {
        verdict: decision.verdict,
        budget: budget(held, model, [&refit, &best], &ids),
        effects: decision.effects,
        candidates: decision.candidates,
        remainder: decision.remainder,
        trail: decision.trail,
        everyday: decision.everyday,
        places,
        shrink: graded,
        refit,
        improved: best,
        reasons,
        channels: Vec::new(),
    }
}

/// Why nothing can be said.
struct Refusal {
    verdict: Verdict,
    reason: &'static str,
}

fn refusal(train: &[Record<'_>], graded: &Shrink, settings: &Settings) -> Option<Refusal> {
    let dof = train.first().map_or(0, |record| record.motion.model.dof);
    if 2 * excited(train) < dof {
        return Some(Refusal {
            verdict: Verdict::NotExcited,
            reason: "most joints hardly move: log a motion of joulepath excite",
        });
    }
    (settings.trust != Trust::Unknown && is_hopeless(graded)).then_some(Refusal {
        verdict: Verdict::Unknown,
        reason: "the torques are hardly those of this robot: check --robot, the order of the \
                 joints and the units",
    })
}

/// Whether most joints' torques are little like the best model's.
fn is_hopeless(graded: &Shrink) -> bool {
    let used: Vec<&JointGap> = graded.joints.iter().filter(|of| of.torque > 0.0).collect();
    let is_far = |of: &&&JointGap| of.refit_plus_effect > HOPELESS * of.torque;
    !used.is_empty() && 2 * used.iter().filter(is_far).count() >= used.len()
}

/// Joints that move far and often enough to show something.
fn excited(records: &[Record<'_>]) -> usize {
    let means = || records.iter().filter(|record| record.kind == RecordKind::Mean);
    let dof = means().next().map_or(0, |record| record.motion.model.dof);
    let moves = |joint: &usize| {
        means().any(|record| {
            let q = &record.motion.q[*joint];
            let low = q.iter().copied().fold(f64::INFINITY, f64::min);
            let high = q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            record.used_share(*joint) > OFTEN && high - low > FAR
        })
    };
    (0..dof).filter(moves).count()
}

/// The design of records whose gears carry what the refitted model says: those of a drawing may be
/// off by a third.
fn with_loads(train: &mut [Record<'_>], settings: &Settings) -> Design {
    let design = Design::new(train, settings.trust, &settings.tunables);
    let fit = fitted(&design, Hypothesis::default(), usual(&design), LOADS, false);
    let (Some(fit), Some(first)) = (fit, train.first()) else { return design };
    let count = design.parameters.mixing.ncols();
    let model = first.motion.model.clone();
    let refit = Improved::new(
        &model,
        &design.parameters.mixing,
        &fit.mean.rows(0, count).into_owned(),
        &[],
    );
    for record in train.iter_mut() {
        record.motion.carry(&refit.applied);
    }
    Design::new(train, settings.trust, &settings.tunables)
}

/// Effects that may be named: parameters only of a model that is trusted at all, and those that it
/// lacks only where a baseline has them, too.
fn nameable(train: &[Record<'_>], settings: &Settings) -> Vec<&'static Effect> {
    let has_baseline = train.iter().any(|record| record.kind == RecordKind::Before);
    let model = train.first().map(|record| record.motion.model);
    let lacks = |effect: &Effect| {
        let there = |of: &fn(&Model, usize) -> f64| {
            model.is_some_and(|model| (0..model.dof).any(|joint| of(model, joint) > 0.0))
        };
        let known = || effect.parameters.iter().filter_map(|of| of.there.as_ref());
        known().count() > 0 && !known().any(there)
    };
    let may = |effect: &&'static Effect| {
        effect.nature != Nature::Parameter
            || may_name_parameters(settings.trust) && (has_baseline || !lacks(effect))
    };
    settings.effects.iter().copied().filter(may).collect()
}

/// The model with the parameters of a fit, and effects.
fn improved(model: &Model, design: &Design, of: &Found, effects: &[Fitted]) -> Improved {
    let count = design.parameters.mixing.ncols();
    let parameters: DVector<f64> = of.fit.mean.rows(0, count).into_owned();
    Improved::new(model, &design.parameters.mixing, &parameters, effects)
}

impl Decision {
    /// Takes back what was asserted.
    fn withdraw(&mut self, verdict: Verdict) {
        self.candidates.append(&mut self.effects);
        self.verdict = verdict;
    }
}
