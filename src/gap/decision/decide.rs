//! From the most probable set of effects to what is asserted: a list of gates.

use rayon::prelude::*;

use super::between::beyond_spread;
use super::finding::{Estimated, Finding, Remainder, Verdict};
use super::found::{Candidate, Found, Tried};
use super::held::{Held, held};
use super::search::{BEYOND, Search};
use super::since::since_baseline;
use super::trail::{Entry, Gate};
use crate::arm::effects::{Acts, Effect, Nature, Scope};
use crate::gap::data::{Record, RecordKind};
use crate::gap::model::Fitted;
use crate::gap::posterior::{Gains, MOST_OF_FRICTION};
use crate::gap::trust::Trust;

/// Ids of effects that a class has at most: more are unknown.
const LARGEST_CLASS: usize = 3;
/// Deviations of a law from 0: what only changes with its shape is no law.
const SIGNIFICANT: f64 = 3.0;
/// Joints that are named of an effect of the robot at most.
const FEW: usize = 2;
/// Correlation from which on a law takes back another one: it is a form of that.
const TAKES_BACK: f64 = -0.5;

/// What the logs that were fitted say.
pub(in crate::gap) struct Decision {
    /// What is found.
    pub verdict: Verdict,
    /// What is asserted, by decreasing evidence.
    pub effects: Vec<Finding>,
    /// What was considered.
    pub candidates: Vec<Finding>,
    /// What no known law explains.
    pub remainder: Vec<Remainder>,
    /// The answers of all gates.
    pub trail: Vec<Entry>,
    /// What the model gets: asserted effects, and other values of parameters.
    pub asserted: Vec<Candidate>,
    /// Everyday error by joint, of its torque.
    pub everyday: Vec<f64>,
}

/// An effect that was found, with what the gates ask about it.
struct Weighed {
    effect: &'static Effect,
    pieces: Vec<WeighedPiece>,
    /// The largest share of a joint's torque.
    size: f64,
    /// Evidence \[nats\].
    nats: f64,
    /// Joints that an effect of the robot reaches, where it reaches but few.
    few: Vec<usize>,
    class: Vec<&'static str>,
    inclusion: f64,
}

/// An effect at a joint.
struct WeighedPiece {
    /// Its number among all pieces.
    member: usize,
    fitted: Fitted,
    /// The joint that it changes most.
    most: usize,
    /// Share of that joint's torque.
    share: f64,
    /// Evidence \[nats\].
    nats: f64,
    /// Deviations by how much it differs from log to log, where logs show that.
    beyond_spread: Option<f64>,
}

/// What is asserted, and what is not.
#[derive(Default)]
struct Decided {
    effects: Vec<Finding>,
    candidates: Vec<Finding>,
}

/// Decides on what a search found. `missed` is what the refitted model misses in held-out data, by joint
/// \[Nm\].
#[must_use]
pub(in crate::gap) fn decide(
    search: &Search<'_>,
    none: &Found,
    found: &Found,
    tried: &[Tried],
    missed: &[f64],
) -> Decision {
    let tunables = &search.design.tunables;
    let has_baseline = search.has_baseline();
    let n = search.design.joints.len();
    let mut trail = Vec::new();
    let noisy = noisy_joints(search, &mut trail);
    let effects = || (0..found.effects.len()).into_par_iter();
    let new = || effects().filter(|k| !found.effects[*k].in_baseline());
    let weighed: Vec<Weighed> = new().map(|k| weigh(search, none, found, k, tried)).collect();
    let since: Vec<Option<f64>> = new().map(|k| since_baseline(search, none, found, k)).collect();
    let everyday: Vec<f64> = (0..n).map(|j| found.fit.everyday(search.design, j)).collect();
    let mut kept: Vec<Candidate> = Vec::new();
    let mut decision = Decided::default();
    let candidates = found.effects.iter().filter(|of| !of.in_baseline());
    for (number, (of, candidate)) in weighed.iter().zip(candidates).enumerate() {
        let mut ask = |gate: Gate, at: String, value: f64, limit: f64| {
            let entry = gate.of(at, value, limit);
            let passed = entry.passed;
            trail.push(entry);
            passed
        };
        let id = of.effect.id;
        let mut passed = ask(Gate::Evidence, id.to_owned(), of.nats, tunables.least_nats);
        let limit = LARGEST_CLASS as f64;
        passed &= ask(Gate::Class, id.to_owned(), of.class.len() as f64, limit);
        if let Some(nats) = since[number] {
            passed &= ask(Gate::Since, id.to_owned(), nats, 0.0);
        }
        let mut places = Vec::new();
        for (k, piece) in of.pieces.iter().enumerate() {
            let joint = piece.fitted.joint;
            let at = joint.map_or(id.to_owned(), |joint| format!("{id} of joint {}", joint + 1));
            let place = joint.unwrap_or(piece.most);
            let least = least_size(search, piece, search.left(&found.fit, place), missed[place]);
            let confused = beside_confused(search, found, &weighed, [number, k]);
            let is_quiet = !noisy.contains(&place);
            let mut there = is_quiet
                & ask(Gate::Size, at.clone(), piece.share, least)
                & ask(Gate::Bounds, at.clone(), piece.fitted.beyond_bounds(), BEYOND);
            if let Some(value) = piece.fitted.significance {
                there &= ask(Gate::Significance, at.clone(), value, SIGNIFICANT);
            }
            if let Some(value) = piece.beyond_spread {
                there &= ask(Gate::Logs, at.clone(), value, SIGNIFICANT);
            }
            if let Some(ratio) = confused {
                there &= ask(Gate::Form, at.clone(), ratio, tunables.of_confused);
            }
            if let Some(value) = piece.fitted.over_everyday() {
                let limit = search.design.least_everyday();
                there &= ask(Gate::Everyday, at.clone(), value, limit);
            }
            if of.pieces.len() > 1 {
                there &= ask(Gate::JointEvidence, at, piece.nats, tunables.joint_nats);
            }
            if there {
                places.push(k);
            }
        }
        passed &= !places.is_empty();
        let all = of.pieces.iter().enumerate();
        let told = all.filter(|(k, _)| !passed || places.contains(k)).map(|(_, of)| &of.fitted);
        let finding = of.finding(&told.collect::<Vec<_>>());
        if passed {
            let mut candidate = candidate.clone();
            candidate.pieces = places.iter().map(|k| candidate.pieces[*k].clone()).collect();
            kept.push(candidate);
        }
        // Other values of parameters are no effect, whatever their size.
        let is_effect = passed && of.effect.nature != Nature::Parameters;
        let list = if is_effect { &mut decision.effects } else { &mut decision.candidates };
        list.push(finding);
    }
    let has_parameters = kept.iter().any(|of| of.effect.nature == Nature::Parameters);
    // What is everyday is not unexplained.
    let mut explained = kept.clone();
    let is_kept = |of: &Candidate| {
        !of.in_baseline() && kept.iter().any(|kept| kept.effect.id == of.effect.id)
    };
    let all = found.effects.iter();
    explained.extend(all.filter(|of| of.is_everyday && !is_kept(of)).cloned());
    let fit = match explained.len() {
        0 => None,
        _ => search.with(none, explained),
    };
    let fit =
        fit.unwrap_or_else(|| Found { effects: Vec::new(), score: 0.0, fit: none.fit.clone() });
    let mut remainder = Vec::new();
    for joint in 0..n {
        let share = search.left(&fit.fit, joint);
        let at = format!("joint {}", joint + 1);
        let entry = Gate::Unexplained.of(at, share, tunables.usual_error);
        if !entry.passed || noisy.contains(&joint) {
            let variable = fit.fit.largest_variable(search.design, joint);
            let id = variable.map_or("other", |of| of.name());
            remainder.push(Remainder { id, joint, share });
        }
        trail.push(entry);
    }
    let is_before: Vec<bool> =
        search.records.iter().map(|record| record.kind == RecordKind::Before).collect();
    let has_other_friction = (0..n).any(|joint| {
        fit.fit.change_of_friction(search.design, joint, &is_before) > MOST_OF_FRICTION
    });
    let Decided { effects, candidates } = decision;
    let verdict = match (effects.is_empty(), remainder.is_empty()) {
        (true, true) if has_baseline && !has_parameters && !has_other_friction => Verdict::NoGap,
        (true, true) => Verdict::ParametersOnly,
        (true, false) => Verdict::Unknown,
        (false, true) => Verdict::Effect,
        (false, false) => Verdict::Partial,
    };
    Decision { verdict, effects, candidates, remainder, trail, asserted: kept, everyday }
}

impl Weighed {
    fn finding(&self, fitted: &[&Fitted]) -> Finding {
        let joints: Vec<usize> = fitted.iter().filter_map(|of| of.joint).collect();
        Finding {
            effect: self.effect,
            joints: if joints.is_empty() { self.few.clone() } else { joints },
            class: self.class.clone(),
            inclusion: self.inclusion,
            parameters: parameters(fitted),
            nats: self.nats,
            size: self.size,
        }
    }
}

/// Size of a piece beside the largest one at its joint with which it may be confused; negative where it
/// takes that back; `None` without such a piece.
fn beside_confused(
    search: &Search<'_>,
    found: &Found,
    weighed: &[Weighed],
    [number, k]: [usize; 2],
) -> Option<f64> {
    let (own, piece) = (&weighed[number], &weighed[number].pieces[k]);
    let is_confused = |other: &Weighed| {
        let (a, b) = (own.effect, other.effect);
        a.id != b.id && (a.confused.contains(&b.id) || b.confused.contains(&a.id))
    };
    let there = weighed.iter().filter(|other| is_confused(other)).flat_map(|other| &other.pieces);
    let there = there.filter(|other| {
        let (a, b) = (piece.fitted.joint, other.fitted.joint);
        a.is_none() || b.is_none() || a == b
    });
    let largest = there.max_by(|a, b| a.share.total_cmp(&b.share))?;
    let ratio = piece.share / largest.share.max(f64::MIN_POSITIVE);
    let members = [piece.member, largest.member].map(|member| member..member + 1);
    let joint = piece.fitted.joint.or(largest.fitted.joint);
    let joints = joint.map_or(0..search.design.joints.len(), |joint| joint..joint + 1);
    let least = joints
        .map(|joint| found.fit.correlation(search.design, members.clone(), joint))
        .fold(0.0, f64::min);
    Some(if least < TAKES_BACK && ratio < 1.0 { -ratio } else { ratio })
}

/// Least share of a joint's torque that is no everyday error, where one of a share `left` is left, and
/// held-out data is `missed` \[Nm\].
fn least_size(search: &Search<'_>, piece: &WeighedPiece, left: f64, missed: f64) -> f64 {
    let tunables = &search.design.tunables;
    // The more any error is beyond a usual one, the less it leaves to judge by.
    let over =
        (left / tunables.usual_error).clamp(tunables.over_everyday, tunables.over_unexplained);
    let least = search.design.least_share().max(over * left);
    // What acts once has to stand out while it acts: no other log can confirm it, and some error is large
    // somewhere.
    match (piece.fitted.effect.acts, piece.fitted.coordinates[..].last_chunk()) {
        (Acts::InWindow, Some([start, end, 0.0])) => {
            let all: f64 = search.records.iter().map(Record::duration).sum();
            let torque = search.design.joints[piece.most].torque;
            least.max(SIGNIFICANT * missed / torque * ((end - start) / all).sqrt())
        }
        _ => least,
    }
}

/// Parameters of an effect at its joints; with several joints their names end with the joint.
fn parameters(fitted: &[&Fitted]) -> Vec<Estimated> {
    let mut all = Vec::new();
    for of in fitted {
        let values = of.parameters.iter().zip(&of.deviations);
        for (parameter, (value, sd)) in of.effect.parameters.iter().zip(values) {
            let name = match of.joint {
                Some(joint) if fitted.len() > 1 => format!("{}_j{}", parameter.name, joint + 1),
                _ => parameter.name.to_owned(),
            };
            all.push(Estimated { name, value: *value, sd: *sd, unit: parameter.unit });
        }
    }
    all
}

/// What the gates ask about an effect of a set.
fn weigh(
    search: &Search<'_>,
    none: &Found,
    found: &Found,
    number: usize,
    tried: &[Tried],
) -> Weighed {
    let effect = found.effects[number].effect;
    let first: usize = found.effects[..number].iter().map(|of| of.pieces.len()).sum();
    let count = found.effects[number].pieces.len();
    let score = |less: Option<Found>| less.map_or(0.0, |less| less.score);
    let without =
        if found.effects.len() > 1 { score(search.without(none, found, number)) } else { 0.0 };
    let all = Fitted::of_fit(&found.fit);
    let gains = Gains::new(search.design, &found.fit);
    let n = search.design.joints.len();
    let share = |members: std::ops::Range<usize>, joint: usize| {
        found.fit.share(search.design, members, joint)
    };
    let largest = |members: std::ops::Range<usize>| {
        (0..n).map(|joint| share(members.clone(), joint)).fold(0.0, f64::max)
    };
    let pieces = (0..count).into_par_iter().map(|k| {
        let logs = (search.design, search.records);
        let held = held(logs, (&found.fit, &gains), first + k);
        let widened = |of: Fitted, held: Held| of.widened(held.coordinate, held.sd);
        let fitted = held.into_iter().fold(all[first + k].clone(), widened);
        let members = first + k..first + k + 1;
        let size = |joint: &usize| share(members.clone(), *joint);
        let by_size = |a: &usize, b: &usize| size(a).total_cmp(&size(b));
        let most = fitted.joint.or_else(|| (0..n).max_by(by_size)).unwrap_or(0);
        let nats = match count {
            1 => found.score - without,
            _ => found.score - score(search.without_joint(none, found, number, k)),
        };
        let beyond_spread = beyond_spread(search, (&found.fit, &gains), first + k);
        let member = first + k;
        WeighedPiece { member, fitted, most, share: size(&most), nats, beyond_spread }
    });
    let piece = &found.effects[number].pieces[0];
    let is_of_few = effect.scope == Scope::Robot && piece.rows.len() <= FEW;
    let few =
        if is_of_few { piece.rows.iter().map(|(joint, _)| *joint).collect() } else { Vec::new() };
    let class = class(search, found, number, tried);
    Weighed {
        effect,
        size: largest(first..first + count),
        nats: found.score - without,
        few,
        inclusion: inclusion(effect.id, tried),
        class,
        pieces: pieces.collect(),
    }
}

/// Effects that explain the logs as well in the place of one of a set.
fn class(search: &Search<'_>, found: &Found, number: usize, tried: &[Tried]) -> Vec<&'static str> {
    let ids = found.tried().ids;
    let own = found.effects[number].effect.id;
    let mut class = vec![own];
    for of in tried {
        let is_rest = |id: &&str| *id == own || of.ids.contains(id);
        let others: Vec<&'static str> =
            of.ids.iter().copied().filter(|id| !ids.contains(id)).collect();
        let near = of.score > found.score - search.design.tunables.class_nats;
        if let [other] = others[..]
            && of.ids.len() == ids.len()
            && ids.iter().all(is_rest)
            && near
            && !class.contains(&other)
        {
            class.push(other);
        }
    }
    class
}

/// Posterior probability that an effect is in the set, over all sets that were fitted.
fn inclusion(id: &str, tried: &[Tried]) -> f64 {
    let most = tried.iter().map(|of| of.score).fold(f64::NEG_INFINITY, f64::max);
    let (mut with, mut all) = (0.0, 0.0);
    for of in tried {
        let weight = (of.score - most).exp();
        all += weight;
        with += if of.ids.contains(&id) { weight } else { 0.0 };
    }
    with / f64::max(all, f64::MIN_POSITIVE)
}

/// Joints whose noise has grown since the baseline: the least of a log of today is compared with the
/// largest of one of the baseline.
fn noisy_joints(search: &Search<'_>, trail: &mut Vec<Entry>) -> Vec<usize> {
    let tunables = &search.design.tunables;
    let mut noisy = Vec::new();
    for of in &search.design.joints {
        let share = |record: usize| {
            let cells = of.cells.iter().filter(|cell| cell.record == record);
            let (noise, power) = cells.fold((0.0, 0.0), |(noise, power), cell| {
                let count = cell.rows.len() as f64;
                (noise + cell.noise * count, power + cell.power * count)
            });
            f64::sqrt(noise / f64::max(power, f64::MIN_POSITIVE))
        };
        let of_kind = |kind: RecordKind| {
            let all = search.records.iter().enumerate().filter(move |(_, of)| of.kind == kind);
            all.map(|(record, _)| share(record)).filter(|share| *share > 0.0)
        };
        let now = of_kind(RecordKind::Mean).fold(f64::INFINITY, f64::min);
        let before = of_kind(RecordKind::Before).fold(0.0, f64::max);
        if before > 0.0 && now.is_finite() && now > tunables.least_share {
            let at = format!("joint {}", of.joint + 1);
            let entry = Gate::Noise.of(at, now / before, tunables.noise_ratio);
            if !entry.passed {
                noisy.push(of.joint);
            }
            trail.push(entry);
        }
    }
    noisy
}

/// Whether a parameter may be named at all under a trust.
#[must_use]
pub(in crate::gap) fn may_name_parameters(trust: Trust) -> bool {
    trust != Trust::Unknown
}
