//! From logs to a diagnosis of torques.

use super::data::{Record, RecordKind};
use super::decision::{
    Candidate, Decision, Finding, Found, Gate, Search, Searched, Tried, Verdict, decide,
    may_name_parameters, polished,
};
use super::design::{Design, PieceRows};
use super::diagnosis::Diagnosis;
use super::grade::{JointGap, Shrink, budget, places, places_missed, shrink};
use super::model::{Improved, written};
use super::phase::Phase;
use super::rivals::Rivals;
use super::sign::{Turned, is_opposite};
use super::trust::Trust;
use super::tunables::Tunables;
use crate::arm::dynamics::Load;
use crate::arm::effects::{Acts, Effect, Nature, Scope};
use crate::arm::robot::Model;
use crate::learn::identify::Samples;

/// Everyday error of held-out data, of the torque.
const EVERYDAY: f64 = 0.01;
/// Part of the gap by which other parameters alone may change it.
const NO_WORSE: f64 = 0.01;
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

/// Diagnoses what has changed since the baseline, or, without one, all that the model does not have;
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
#[cfg(feature = "internals")]
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
fn diagnose_telling(
    model: &Model,
    mut train: Vec<Record<'_>>,
    held: &[Record<'_>],
    settings: &Settings,
    tell: &dyn Fn(Phase),
) -> Diagnosis {
    tell(Phase::Design);
    // Parameters that are fitted to torques with the other sign are far off.
    let turned = if is_opposite(&train) { turned(&train, settings) } else { None };
    if let Some(turned) = &turned {
        turned.turn_back(&mut train);
    }
    let design = with_loads(&mut train, settings);
    tell(Phase::Search);
    let mut effects = nameable(&train, settings);
    effects.retain(|effect| !effect.coordinates.is_empty());
    let search = Search::new(&train, &design, &effects);
    let Some(none) = Search::none_of(&design) else { return Diagnosis::failed(model, held) };
    let Searched { none, best, tried, near } = search.best(none);
    let found = polished(&search, &none, best);
    tell(Phase::Decision);
    let (known, plain) = known_of(model, (&design, &train), &found, held);
    let refit = turned.as_ref().map_or_else(|| plain.clone(), |of| of.added_to(&plain));
    let models = Models { nominal: model, known, refit: &refit, turned: turned.as_ref() };
    let Graded { mut decision, mut best, shrink: mut graded } =
        graded(&search, [&none, &found], &tried, held, &models);
    if let Some(finding) = turned.as_ref().and_then(Turned::finding) {
        decision.add(finding);
        graded = shrink(held, [model, &plain.applied, &best.applied]);
    }
    let refit = plain;
    tell(Phase::Grading);
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
    let rivals = Rivals::new([model, &refit.applied], &search, (&none, near), settings.trust);
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
        before: found.in_baseline().map(known_finding).collect(),
        rivals: Some(rivals),
    }
}

/// Models that a decision is compared with.
struct Models<'a> {
    nominal: &'a Model,
    /// Effects that the baseline has, too.
    known: Vec<PieceRows>,
    /// With other parameters and these effects.
    refit: &'a Improved,
    /// Torques that are turned round.
    turned: Option<&'a Turned>,
}

/// A decision with the model that comes of it.
struct Graded {
    decision: Decision,
    best: Improved,
    shrink: Shrink,
}

/// Decides; effects that leave the gap in the held-out data as it is are not asserted.
fn graded(
    search: &Search<'_>,
    [none, found]: [&Found; 2],
    tried: &[Tried],
    held: &[Record<'_>],
    models: &Models<'_>,
) -> Graded {
    let mut found = found.clone();
    let mut trail = Vec::new();
    let mut withdrawn = Vec::new();
    // Parameters that the refitted model has as well explain the logs, but are not written once more.
    let mut in_refit: Vec<&str> = Vec::new();
    let refit = &models.refit.applied;
    let missed = shrink(held, [models.nominal, refit, refit]).joints;
    let missed: Vec<f64> = missed.iter().map(|of| of.refit).collect();
    loop {
        let mut decision = decide(search, none, &found, tried, &missed);
        decision.asserted.retain(|of| !in_refit.contains(&of.effect.id));
        decision.asserted = search.shaped_as_written(&decision.asserted);
        let of =
            |best: &Improved| shrink(held, [models.nominal, &models.refit.applied, &best.applied]);
        let mut best = models.with(search, &decision.asserted);
        let mut graded = of(&best);
        if decision.asserted.iter().any(|of| of.effect.acts == Acts::InWindow) {
            // What acted in windows of some logs need not come again in others.
            let once =
                models.with_those(search, &decision.asserted, |of| of.acts != Acts::InWindow);
            let of_once = of(&once);
            if of_once.total.value > graded.total.value {
                (best, graded) = (once, of_once);
            }
        }
        // One at a time: what is of no use beside it may be of use without it.
        let mut idle: Option<(f64, Finding, Vec<usize>)> = None;
        let is_written =
            |of: &&Finding| decision.asserted.iter().any(|a| a.effect.id == of.effect.id);
        for of in decision.effects.iter().chain(decision.candidates.iter().filter(is_written)) {
            let limit = left_at_most(of.effect, &search.design.tunables);
            let gaps = gaps_without(search, &decision, of.effect, held, models, &best);
            let value = left_by(of, &gaps);
            let entry = Gate::HeldOut.of(of.effect.id.to_owned(), value, limit);
            let over = value / limit;
            if !entry.passed && idle.as_ref().is_none_or(|(most, ..)| over > *most) {
                let fails = |joint: &usize| left(&[*joint], &gaps.joints) > limit;
                let joints: Vec<usize> = of.joints.iter().copied().filter(fails).collect();
                let all = of.effect.scope == Scope::Robot || joints.len() == of.joints.len();
                idle = Some((over, of.clone(), if all { Vec::new() } else { joints }));
            }
            trail.push(entry);
        }
        let less = idle.and_then(|(_, of, joints)| {
            if of.effect.nature == Nature::Parameters {
                in_refit.push(of.effect.id);
                return Some(found.clone());
            }
            let less = search.without_id(none, &found, (of.effect.id, &joints));
            if joints.is_empty() {
                withdrawn.push(of);
            }
            less
        });
        let Some(less) = less else {
            decision.trail.append(&mut trail);
            decision.candidates.append(&mut withdrawn);
            return Graded { decision, best, shrink: graded };
        };
        found = less;
    }
}

/// The gaps with all effects but one, and with all.
fn gaps_without(
    search: &Search<'_>,
    decision: &Decision,
    effect: &Effect,
    held: &[Record<'_>],
    models: &Models<'_>,
    best: &Improved,
) -> Shrink {
    let mut rest = decision.asserted.clone();
    rest.retain(|of| of.effect.id != effect.id);
    let without = models.with(search, &rest);
    shrink(held, [models.nominal, &without.applied, &best.applied])
}

impl Models<'_> {
    /// The model with some effects.
    fn with(&self, search: &Search<'_>, effects: &[Candidate]) -> Improved {
        self.with_those(search, effects, |_| true)
    }

    /// The same, with those effects alone that come again.
    fn with_those(
        &self,
        search: &Search<'_>,
        effects: &[Candidate],
        comes_again: impl Fn(&Effect) -> bool,
    ) -> Improved {
        if effects.is_empty() {
            return self.refit.clone();
        }
        let logs = (search.design, search.records);
        let pieces = self.known.iter().cloned().chain(pieces_of(effects)).collect();
        let best = written(self.nominal, logs, pieces, comes_again);
        self.turned.map_or_else(|| best.clone(), |of| of.added_to(&best))
    }
}

/// What an effect may leave of the gap in held-out data.
fn left_at_most(effect: &Effect, tunables: &Tunables) -> f64 {
    match (effect.nature, effect.acts) {
        (Nature::Law, Acts::Always | Acts::AfterReversals) => tunables.left_in_heldout,
        // Robots warm up differently each day; the refitted model has the parameters, too.
        (Nature::Law, Acts::OverTime) | (Nature::Parameter | Nature::Parameters, _) => 1.0,
        // A window that does not come again leaves other logs as they are.
        (Nature::Law, Acts::InWindow) => 1.0 + NO_WORSE,
    }
}

/// What is left of the gap with an effect. One that acts in windows may act in others here: what it
/// leaves in most blocks counts.
fn left_by(of: &Finding, gaps: &Shrink) -> f64 {
    if of.effect.acts != Acts::InWindow {
        return left(&of.joints, &gaps.joints);
    }
    let mut all: Vec<f64> = gaps.blocks.iter().map(|block| left(&of.joints, block)).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.0)
}

/// What is left of the gap at an effect's joints (all: none is listed), of what the refitted model leaves, or of an everyday
/// error where that is less: parameters may stand in for an effect \[1\].
fn left(joints: &[usize], gaps: &[JointGap]) -> f64 {
    let at = |joint: usize| joints.is_empty() || joints.contains(&joint);
    let used = gaps.iter().enumerate();
    let used = used.filter(|(joint, gap)| at(*joint) && gap.torque > 0.0);
    let (mut before, mut after) = (0.0, 0.0);
    for (_, gap) in used {
        before += (gap.refit / gap.torque).max(EVERYDAY).powi(2);
        after += (gap.refit_plus_effect / gap.torque).powi(2);
    }
    if before > 0.0 { f64::sqrt(after / before) } else { 0.0 }
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
    let is_far = |of: &&&JointGap| of.refit.min(of.refit_plus_effect) > HOPELESS * of.torque;
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

/// The design of records whose laws go by the torques and loads that the refitted model says: those of
/// a drawing may be off by a third.
fn with_loads(train: &mut [Record<'_>], settings: &Settings) -> Design {
    let design = Design::new(train, settings.trust, &settings.tunables);
    let Some(model) = train.first().map(|first| first.motion.model.clone()) else { return design };
    let refit = refitted(&model, (&design, train));
    for record in train.iter_mut() {
        record.motion.carry(&refit.applied);
        record.motion.torque = record.motion.torques_of(&refit.applied, &Load::none());
    }
    Design::new(train, settings.trust, &settings.tunables)
}

/// Effects that may be named: parameters only of a model that is trusted at all, and those that it
/// lacks only where a baseline has them, too.
fn nameable(train: &[Record<'_>], settings: &Settings) -> Vec<&'static Effect> {
    let has_baseline = train.iter().any(|record| record.kind == RecordKind::Before);
    let model = train.first().map(|record| record.motion.model);
    let lacks = |effect: &Effect| {
        let known = effect.parameters.iter().filter_map(|of| of.there);
        let says = |there: fn(&Model, usize) -> Option<f64>| model.and_then(|of| there(of, 0));
        known.clone().count() > 0 && known.filter_map(says).count() == 0
    };
    let may = |effect: &&'static Effect| {
        effect.nature != Nature::Parameter
            || may_name_parameters(settings.trust) && (has_baseline || !lacks(effect))
    };
    settings.effects.iter().copied().filter(may).collect()
}

fn pieces_of<'a>(
    effects: impl IntoIterator<Item = &'a Candidate>,
) -> impl Iterator<Item = PieceRows> {
    effects.into_iter().flat_map(|of| of.pieces.iter().cloned())
}

/// An effect that the baseline has, too.
fn known_finding(of: &Candidate) -> Finding {
    Finding::alone(of.effect, of.pieces.iter().filter_map(|piece| piece.joint).collect(), 0.0)
}

/// The effects of a robot that the baseline has, too, those alone with which the model predicts held-out data
/// better, and that model.
fn known_of(
    model: &Model,
    logs: (&Design, &[Record<'_>]),
    found: &Found,
    held: &[Record<'_>],
) -> (Vec<PieceRows>, Improved) {
    let (mut known, mut best) = (Vec::new(), refitted(model, logs));
    for of in found.in_baseline() {
        let mut more: Vec<PieceRows> = known.clone();
        more.extend(pieces_of([of]).map(PieceRows::without_tangents));
        let next = written(model, logs, more.clone(), |_| true);
        if shrink(held, [model, &best.applied, &next.applied]).by_effect.value > 0.0 {
            (known, best) = (more, next);
        }
    }
    (known, best)
}

/// The model with other parameters that predicts best.
fn refitted(model: &Model, logs: (&Design, &[Record<'_>])) -> Improved {
    written(model, logs, Vec::new(), |_| true)
}

/// Torques that are logged with the other sign.
fn turned(train: &[Record<'_>], settings: &Settings) -> Option<Turned> {
    let design = Design::new(train, settings.trust, &settings.tunables);
    let signs = settings.effects.iter().copied().filter(|of| of.coordinates.is_empty());
    let search = Search::new(train, &design, &signs.collect::<Vec<_>>());
    Turned::of(&search, Search::none_of(&design)?)
}

impl Decision {
    /// Adds what was found before.
    fn add(&mut self, finding: Finding) {
        self.effects.insert(0, finding);
        self.verdict = match self.verdict {
            Verdict::Unknown | Verdict::Partial => Verdict::Partial,
            _ => Verdict::Effect,
        };
    }

    /// Takes back what was asserted.
    fn withdraw(&mut self, verdict: Verdict) {
        self.candidates.append(&mut self.effects);
        self.verdict = verdict;
    }
}
