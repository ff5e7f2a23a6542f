//! From records to a verdict.

use nalgebra::DVector;

use crate::arm::effects::Effect;
use crate::arm::robot::Model;

use super::calibration::calibrate;
use super::chosen::{Chosen, Found};
use super::column::{Owner, pieces};
use super::diagnosis::Diagnosis;
use super::effect_ids::{OF_TIME, OF_TURNS};
use super::findings::{Anything, Said, Verdict};
use super::gated::gated;
use super::generic::OF_DRIFT;
use super::heldout::{JointGap, Shrink, predicted, shrink};
use super::improved::Improved;
use super::judged::{CLASS, FLIP, Judged, LEAST_NATS, judged};
use super::nuisance::Trust;
use super::phase::Phase;
use super::places::{places, places_missed};
use super::record::{Record, RecordKind};
use super::search::Search;
use super::table::{Table, nuisances};

/// Errors of the model that are tried.
const ERRORS: [f64; 4] = [0.0015, 0.005, 0.015, 0.045];
/// Share of a joint's torque below which functions of no law are the model's own error.
const SMALL: f64 = 0.005;
/// Share of the torques below which a model without a gap is right.
const RIGHT: f64 = 0.02;
/// What effects may leave of the logs that they were fitted to, to be there whatever they take off
/// of other logs.
const EXPLAINS: f64 = 0.35;
/// Correlation of a torque with the model's below which its sign may be the other one.
const OPPOSITE: f64 = -0.3;

/// Share of a joint's torque that no model of this robot misses.
const HOPELESS: f64 = 0.4;
/// Correlation with the best model's below which torques are hardly those of this robot.
const ALIKE: f64 = 0.5;
/// Range \[rad\] and share of the rows in which a joint has to move.
const FAR: f64 = 0.05;
const OFTEN: f64 = 0.1;

/// How a diagnosis is made.
pub struct Settings {
    /// How much the nominal parameters are believed.
    pub trust: Trust,
    /// Effects that may be found.
    pub effects: Vec<&'static Effect>,
}

/// Diagnoses the records `train`, graded by `held`, where `model` is compared, too.
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
    tell(Phase::Channel);
    // With a baseline the robot was more than the model has.
    let believed = train.first().map_or(model, |record| record.motion.model);
    let flipped = flip(&mut train, settings);
    carry(&mut train, settings, believed);
    let mut searched = search(&train, settings, believed, tell);
    let coupling = searched.search.rounded_coupling(&searched.found);
    // What is there at turns can't be told without them.
    let is_of_moving = |effect: &&'static Effect| !OF_TURNS.contains(&effect.id);
    let effects = settings.effects.iter().copied().filter(is_of_moving).collect();
    let (of_moving, mut settings) = (Settings { effects, ..*settings }, settings);
    if let Some(coupling) = coupling {
        drop(searched);
        for record in &mut train {
            record.leave_out_turns(coupling);
        }
        settings = &of_moving;
        searched = search(&train, settings, believed, tell);
    }
    if let Some(loaded) = searched.search.loaded(&searched.found, believed) {
        drop(searched);
        for record in train.iter_mut().filter(|record| record.kind != RecordKind::Before) {
            record.motion.go_by(&loaded);
        }
        searched = search(&train, settings, believed, tell);
    }
    let Searched { mut search, mut found, chance, refit } = searched;
    let errors = errors(&search);
    let of_time = joints_of_time(&search, &found);
    if !of_time.is_empty() {
        tell(Phase::Windows);
        let more = gated(&settings.effects, &train, &of_time);
        let table = Table::new(&train, &settings.effects, settings.trust, more);
        let (error, channels, late) = (search.error, search.channels.clone(), search.late);
        search = Search::new(&train, table, settings.trust, error);
        search.late = late;
        search.set_channels(&channels);
        search.match_excess(&[]);
        // With windows less may be the model's error.
        if !search.is_open() {
            search.choose_error(errors);
        }
        // First what has a window, then what that leaves.
        let banned = search.banned.clone();
        search.banned.extend(OF_TIME);
        found = search.run_gated(errors);
        search.banned = banned;
        found = search.run_from(found);
        if search.lower_error(&mut found, errors) {
            found = search.run_from(found);
        }
    }
    tell(Phase::Shapes);
    found = search.name_functions(found);
    search.simplify(&mut found, CLASS);
    // What a law is worth shows where nothing else follows its form.
    let mut laws = search.without_forms(&found);
    let mut polished = search.polish(&laws);
    if let Some(of) = &polished
        && search.strike(&mut found, of, &[])
    {
        // Another law may have its place.
        let next = search.run_from(found);
        found = search.name_functions(next);
        search.simplify(&mut found, CLASS);
        laws = search.without_forms(&found);
        polished = search.polish(&laws);
    }
    let mut judged = judged(&search, &found, polished.as_ref(), chance);
    if let Some(late) = search.late.filter(|late| late.nats > LEAST_NATS) {
        judged.assert_late(&late);
    }
    for joint in &flipped {
        judged.assert_flipped(*joint);
    }
    let of_parameters = search.with_parameters(believed, &found, &judged);
    let asserted = search.with_asserted(believed, &found, &judged, &flipped);
    tell(Phase::Grading);
    // What a robot can have may be far from what was fitted: nothing is written that misses more
    // than before of what it was fitted to.
    let none = better(&train, Improved::same(believed), refit);
    let with_parameters = |changed: Option<Improved>| match changed {
        Some(changed) if flipped.is_empty() => better(&train, none.clone(), changed),
        _ => none.clone(),
    };
    let mut refit = with_parameters(of_parameters);
    // Flipped torques were turned round for the fit: they are no measure of a model that flips.
    let of_asserted = |asserted: Option<Improved>, refit: &Improved| match asserted {
        Some(improved) if flipped.is_empty() => better(&train, refit.clone(), improved),
        Some(improved) => improved,
        None => refit.clone(),
    };
    let graded_with =
        |of: &Improved, refit: &Improved| shrink(held, [model, &refit.applied, &of.applied]);
    let mut improved = of_asserted(asserted, &refit);
    if improved.written == refit.written {
        judged.doubt_late_joint();
    }
    let mut graded = graded_with(&improved, &refit);
    let is_foreign =
        || is_hopeless(&graded) || is_unlike(&train, &improved) || is_other_body(&graded, &judged);
    if settings.trust != Trust::Unknown && is_foreign() {
        judged.withdraw(
            Verdict::Unknown,
            "the torques are hardly those of this robot: check --robot, the order of the joints \
             and the units",
        );
        improved = refit.clone();
        graded = graded_with(&improved, &refit);
    } else if let Some(less) = judged.without_idle(&graded) {
        let of_less = with_parameters(search.with_parameters(believed, &found, &less));
        let asserted = search.with_asserted(believed, &found, &less, &flipped);
        let plainer = of_asserted(asserted, &of_less);
        // What explains most of the logs is there, however far its form holds beyond them, unless it
        // is doubtful anyway.
        let is_doubtful =
            judged.leaves_far_more(&graded) || !judged.effects.iter().all(Said::is_likely);
        if is_doubtful || missed(&train, &improved) > EXPLAINS * missed(&train, &plainer) {
            (judged, improved, refit) = (less, plainer, of_less);
            graded = graded_with(&improved, &refit);
        }
    }
    if judged.is_refuted(&graded) {
        judged.withdraw(
            Verdict::Unknown,
            "data that took no part is missed more with what was found than without it",
        );
        improved = refit.clone();
        graded = graded_with(&improved, &refit);
    }
    if judged.effects.is_empty() && 2 * excited(&train) < model.dof {
        judged.withdraw(
            Verdict::NotExcited,
            "most joints hardly move: log a motion of joulepath excite",
        );
    }
    let mut verdict = judged.verdict;
    let used = graded.joints.iter().filter(|joint| joint.torque > 0.0);
    let most = used.map(|joint| joint.model / joint.torque).fold(0.0, f64::max);
    if verdict == Verdict::ParametersOnly && judged.candidates.is_empty() && most < RIGHT {
        verdict = Verdict::NoGap;
    }
    // No model is right to the last digit.
    let drifts = judged.anything.iter().any(|of| OF_DRIFT.contains(&of.id));
    if verdict == Verdict::Unknown && !judged.anything.is_empty() && !drifts {
        let left = shrink(&train, [believed, &refit.applied, &refit.applied]).joints;
        let is_small = |of: &JointGap| of.refit < SMALL * of.torque;
        let is_small = |of: &Anything| of.joint.is_some_and(|joint| is_small(&left[joint]));
        if judged.anything.iter().all(is_small) {
            verdict = Verdict::ParametersOnly;
        }
    }
    calibrate(&mut judged.effects, &mut judged.candidates);
    let asserted: Vec<&'static str> = judged.effects.iter().map(|said| said.effect.id).collect();
    let places = if asserted.is_empty() && verdict == Verdict::Unknown {
        places_missed(&train, &refit)
    } else {
        places(&train, believed, [&refit, &improved], &asserted)
    };
    Diagnosis {
        verdict,
        places,
        effects: judged.effects,
        candidates: judged.candidates,
        anything: judged.anything,
        shrink: graded,
        error: search.error,
        chance,
        refit,
        improved,
        reasons: judged.reasons,
        channels: Vec::new(),
        before: None,
    }
}

/// Whether most joints' torques are little like the best model's.
fn is_hopeless(graded: &Shrink) -> bool {
    let used = graded.joints.iter().filter(|joint| joint.torque > 0.0);
    let hopeless =
        used.clone().filter(|joint| joint.refit_plus_effect > HOPELESS * joint.torque).count();
    let used = used.count();
    used > 0 && 2 * hopeless >= used
}

/// Whether most joints' torques are far from the nominal model's, and other bodies explain more than
/// the effects do.
fn is_other_body(graded: &Shrink, judged: &Judged) -> bool {
    let used = graded.joints.iter().filter(|joint| joint.torque > 0.0);
    let far = used.clone().filter(|joint| joint.model > HOPELESS * joint.torque).count();
    let bodies = judged.candidates.iter().filter(|said| said.effect.id == "link_parameters");
    let bodies = bodies.map(|said| said.nats).fold(0.0, f64::max);
    let lesser = judged.effects.iter().any(|said| said.nats < bodies);
    lesser && 3 * far >= 2 * used.count()
}

/// Whether most joints' torques have little to do with those of the best model.
fn is_unlike(records: &[Record<'_>], best: &Improved) -> bool {
    let alike = correlations(records, |record| predicted(record, &best.applied));
    // Torques that are flipped were turned round.
    let foreign = alike.iter().filter(|of| of.abs() < ALIKE).count();
    !alike.is_empty() && 2 * foreign >= alike.len()
}

/// Joints that move far and often enough to show something.
fn excited(records: &[Record<'_>]) -> usize {
    let means = || records.iter().filter(|record| record.kind == RecordKind::Mean);
    let dof = means().next().map_or(0, |record| record.motion.model.dof);
    let moves = |joint: &usize| {
        means().any(|record| {
            let (window, q) = (&record.window[*joint], &record.motion.q[*joint]);
            let low = q.iter().copied().fold(f64::INFINITY, f64::min);
            let high = q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let used = window.iter().sum::<f64>() / window.len().max(1) as f64;
            used > OFTEN && high - low > FAR
        })
    };
    (0..dof).filter(moves).count()
}

/// The second model where it misses no more of the records than the first one.
fn better(records: &[Record<'_>], first: Improved, second: Improved) -> Improved {
    // A sum that is no number is no better.
    if missed(records, &second) <= missed(records, &first) { second } else { first }
}

/// Squares that a model misses of the means, of what was measured, summed over the joints.
fn missed(records: &[Record<'_>], of: &Improved) -> f64 {
    let means = records.iter().filter(|record| record.kind == RecordKind::Mean);
    let of_joints = means.flat_map(|record| {
        let predicted = predicted(record, &of.applied);
        let relative = |joint: usize| {
            let measured = &record.measured[joint];
            let all = measured.iter().map(|x| x * x).sum::<f64>().max(1e-12);
            let both = measured.iter().zip(&predicted[joint]);
            both.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / all
        };
        (0..predicted.len()).map(relative).collect::<Vec<_>>()
    });
    of_joints.sum()
}

/// What a first search found.
struct Searched<'r> {
    search: Search<'r, 'r>,
    found: Found,
    /// Nats that chance reaches.
    chance: f64,
    /// The model without effects.
    refit: Improved,
}

/// The best set of effects and functions.
fn search<'r>(
    train: &'r [Record<'r>],
    settings: &Settings,
    believed: &Model,
    tell: &dyn Fn(Phase),
) -> Searched<'r> {
    let table = Table::new(train, &settings.effects, settings.trust, Vec::new());
    let mut search = Search::new(train, table, settings.trust, ERRORS[0]);
    let may = |id: &str| settings.effects.iter().any(|effect| effect.id == id);
    if settings.effects.is_empty() {
        // Nothing is to be found, not even a function of anything.
        search.banned = search.families.iter().map(|family| family.owner.id()).collect();
    }
    // What a log that does not repeat misses is matched, not chosen.
    search.match_excess(&[]);
    let errors = errors(&search);
    search.choose_channel(errors, &may);
    search.match_excess(&[]);
    let none = search.evidence.parameters(&[], &DVector::zeros(0));
    let refit = Improved::new(believed, &search.table.mixing, &none, &[]);
    tell(Phase::Search);
    let chance = search.reached_by_chance();
    let mut found = search.run_late_or_not(errors);
    if search.lower_error(&mut found, errors) {
        found = search.run_from(found);
    }
    Searched { search, found, chance, refit }
}

/// Errors that are tried.
fn errors(search: &Search<'_, '_>) -> &'static [f64] {
    if search.is_open() { &ERRORS[..1] } else { &ERRORS }
}

/// Takes torques with the other sign where they are far more probable so: joints.
fn flip(train: &mut [Record<'_>], settings: &Settings) -> Vec<usize> {
    let may = settings.effects.iter().any(|effect| effect.id == "current_sign");
    let dof = train.first().map_or(0, |record| record.motion.model.dof);
    let mut flipped = Vec::new();
    if !may {
        return flipped;
    }
    let nuisances = nuisances(train, settings.trust);
    // A load that weighs more than a small wrist turns its torques round, too.
    let load = settings.effects.iter().find(|effect| effect.id == "payload");
    let load = load.map_or_else(Vec::new, |load| pieces(load, train, dof.saturating_sub(1)));
    let mut table = Table::of(train, load, &nuisances);
    let error = ERRORS[ERRORS.len() - 1];
    let weighed = |table: &Table| {
        let evidence = table.evidence(error);
        let all: Vec<usize> = (0..table.means.len()).collect();
        evidence.null + evidence.gain(&all)
    };
    let mut null = weighed(&table);
    let alike = correlations(train, |record| record.motion.torque.clone());
    for joint in (0..dof).filter(|joint| alike[*joint] < OPPOSITE) {
        table.flip(joint);
        let other = weighed(&table);
        if other > null + FLIP {
            null = other;
            flipped.push(joint);
        } else {
            table.flip(joint);
        }
    }
    for record in train.iter_mut().filter(|record| record.kind != RecordKind::Before) {
        for joint in &flipped {
            record.measured[*joint].iter_mut().for_each(|x| *x = -*x);
        }
    }
    flipped
}

/// Lets the gears carry what the refitted model says: laws of the load go by what is there.
fn carry(train: &mut [Record<'_>], settings: &Settings, believed: &Model) {
    let table = Table::of(train, Vec::new(), &nuisances(train, settings.trust));
    let evidence = table.evidence(ERRORS[ERRORS.len() - 1]);
    let none = evidence.parameters(&[], &DVector::zeros(0));
    let refit = Improved::new(believed, &table.mixing, &none, &[]);
    for record in train.iter_mut() {
        record.motion.carry(&refit.applied);
    }
}

/// Correlations of the joints' measured torques with those that a model says.
fn correlations(records: &[Record<'_>], says: impl Fn(&Record<'_>) -> Vec<Vec<f64>>) -> Vec<f64> {
    let dof = records.first().map_or(0, |record| record.motion.model.dof);
    let mut sums = vec![[0.0; 3]; dof];
    for record in records.iter().filter(|record| record.kind == RecordKind::Mean) {
        for (sums, (measured, said)) in
            sums.iter_mut().zip(record.measured.iter().zip(says(record)))
        {
            for (x, y) in measured.iter().zip(said) {
                sums[0] += x * y;
                sums[1] += x * x;
                sums[2] += y * y;
            }
        }
    }
    sums.iter().map(|[product, x, y]| product / (x * y).sqrt().max(1e-12)).collect()
}

/// Joints of functions of time that were found.
fn joints_of_time(search: &Search<'_, '_>, found: &Found) -> Vec<usize> {
    let of_time = |of: &&Chosen| match search.families[of.family].owner {
        Owner::Generic(id) => OF_TIME.contains(&id),
        Owner::Effect(_) => false,
    };
    let pieces = found.chosen.iter().filter(of_time).flat_map(|of| &of.pieces);
    let mut joints: Vec<usize> =
        pieces.filter_map(|piece| search.table.pieces[*piece].joint).collect();
    joints.sort_unstable();
    joints.dedup();
    joints
}

#[cfg(test)]
mod tests {
    use crate::arm::effects::find;

    use super::*;

    /// Whether joints are another body's of which `far` of six are missed by half, an effect bringing
    /// 100 nats.
    fn is_other(far: usize, bodies: f64) -> bool {
        let joint = |k| JointGap {
            torque: 10.0,
            model: if k < far { 5.0 } else { 1.0 },
            ..JointGap::default()
        };
        let graded = Shrink { joints: (0..6).map(joint).collect(), ..Shrink::default() };
        let said = |id: &str, nats| find(id).map(|effect| Said::alone(effect, vec![0], nats));
        let effects = said("stribeck", 100.0).into_iter().collect();
        let candidates = said("link_parameters", bodies).into_iter().collect();
        is_other_body(&graded, &Judged::of(effects, candidates))
    }

    #[test]
    fn effects_beside_another_body_are_none() {
        assert!(is_other(4, 200.0));
        assert!(!is_other(3, 200.0) && !is_other(4, 50.0));
    }
}
