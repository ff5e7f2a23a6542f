//! From records to a verdict.

use nalgebra::DVector;

use crate::effects::{Effect, find};
use crate::robot::{MAX_DOF, Model};

use super::channel::Late;
use super::column::Owner;
use super::diagnosis::{Anything, Diagnosis, Estimated, Place, Said, Verdict};
use super::gated::{GATED, OF_TIME, gated};
use super::generic::OF_DRIFT;
use super::heldout::{predicted, shrink};
use super::improved::Improved;
use super::nuisance::Trust;
use super::polish::{Fitted, Polished};
use super::record::{Record, RecordKind};
use super::search::{Chosen, Found, Search};
use super::table::{Table, nuisances};

/// Errors of the model that are tried.
const ERRORS: [f64; 4] = [0.0015, 0.005, 0.015, 0.045];
/// Odds below which two explanations cannot be told apart: 1 to 100.
const CLASS: f64 = 4.6;
/// Most ids that say anything.
const LARGEST_CLASS: usize = 5;
/// Deviations that the largest coordinate of an effect has to have.
const SIGNIFICANT: f64 = 3.0;
/// A change of parameters within so many deviations is no effect.
const BEYOND: f64 = 3.0;
/// Share of the torques below which a model without a gap is right.
const RIGHT: f64 = 0.02;
/// Changes of parameters, which a model has whether they are asserted or not.
const OF_PARAMETERS: [&str; 4] = ["link_parameters", "friction_level", "rotor_inertia", "payload"];
/// What another sign has to bring.
const FLIP: f64 = 50.0;
/// What a function of time may still bring beside a gated effect, of what that does.
const LEFT: f64 = 0.3;
/// What an effect has to bring, of what the strongest does.
const OF_STRONGEST: f64 = 0.005;
/// What an effect has to bring.
const LEAST_NATS: f64 = 8.0;
/// Share of its joint's torque that an effect has to have, and where it brings as many nats.
const RELEVANT: f64 = 0.005;
const CLEARLY: f64 = 0.002;
const CLEAR: f64 = 30.0;
/// Ripple that any motor may have, of the noise.
const BELOW_NOISE: f64 = 0.25;

/// How a diagnosis is made.
pub struct Settings {
    /// How much the nominal parameters are believed.
    pub trust: Trust,
    /// Effects that may be found.
    pub effects: Vec<&'static Effect>,
}

/// Diagnoses the records `train`, graded by `held`.
#[must_use]
pub fn diagnose(
    model: &Model,
    mut train: Vec<Record<'_>>,
    held: &[Record<'_>],
    settings: &Settings,
) -> Diagnosis {
    let flipped = flip(&mut train, settings);
    let table = Table::new(&train, &settings.effects, settings.trust, Vec::new());
    let mut search = Search::new(&train, table, settings.trust, ERRORS[0]);
    let may = |id: &str| settings.effects.iter().any(|effect| effect.id == id);
    if settings.effects.is_empty() {
        // Nothing is to be found, not even a function of anything.
        search.banned = search.families.iter().map(|family| family.owner.id()).collect();
    }
    search.choose_channel(&ERRORS, &may);
    let none = search.evidence.parameters(&[], &DVector::zeros(0));
    let refit = Improved::new(model, &search.table.mixing, &none, &[]);
    let mut found = search.run();
    let of_time = joints_of_time(&search, &found);
    if !of_time.is_empty() {
        let more = gated(&settings.effects, &train, &of_time);
        let table = Table::new(&train, &settings.effects, settings.trust, more);
        let (error, channels, late) = (search.error, search.channels.clone(), search.late);
        search = Search::new(&train, table, settings.trust, error);
        search.late = late;
        search.set_channels(&channels);
        // First what has a window, then what that leaves.
        search.banned = OF_TIME.to_vec();
        found = search.run();
        search.banned.clear();
        found = search.run_from(found);
    }
    search.simplify(&mut found, CLASS);
    let polished = search.polish(&found.chosen);
    let mut judged = judged(&search, &found, polished.as_ref());
    // What is not asserted is not in the model, so that its parameters are those without it.
    let kept: Vec<Chosen> = found
        .chosen
        .iter()
        .filter(|of| {
            let id = search.families[of.family].owner.id();
            OF_PARAMETERS.contains(&id) || judged.effects.iter().any(|said| said.effect.id == id)
        })
        .map(|of| {
            let id = search.families[of.family].owner.id();
            let said = judged.effects.iter().find(|said| said.effect.id == id);
            let is_told = |piece: &usize| match (search.table.pieces[*piece].joint, said) {
                (Some(joint), Some(said)) => said.joints.contains(&joint),
                _ => true,
            };
            Chosen {
                family: of.family,
                pieces: of.pieces.iter().copied().filter(is_told).collect(),
            }
        })
        .collect();
    let mut polished = search.polish(&kept);
    if let Some(late) = search.late {
        judged.assert_late(&late, polished.as_mut());
    }
    for joint in flipped {
        judged.assert_flipped(joint, polished.as_mut());
    }
    let improved = match &polished {
        Some(of) if !of.effects.is_empty() => {
            Improved::new(model, &search.table.mixing, &of.parameters, &of.effects)
        }
        _ => refit.clone(),
    };
    let graded = shrink(held, [model, &refit.applied, &improved.applied]);
    let mut verdict = judged.verdict;
    let missed = graded.joints.iter().filter(|joint| joint.torque > 0.0);
    let missed = missed.map(|joint| joint.model / joint.torque).fold(0.0, f64::max);
    if verdict == Verdict::ParametersOnly && judged.candidates.is_empty() && missed < RIGHT {
        verdict = Verdict::NoGap;
    }
    Diagnosis {
        verdict,
        places: places(&train, model, &refit, &improved),
        effects: judged.effects,
        candidates: judged.candidates,
        anything: judged.anything,
        shrink: graded,
        error: search.error,
        refit,
        improved,
        reasons: judged.reasons,
        channels: Vec::new(),
    }
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
    let mut table = Table::of(train, Vec::new(), &nuisances);
    let error = ERRORS[ERRORS.len() - 1];
    let mut null = table.evidence(error).null;
    for joint in 0..dof {
        table.flip(joint);
        let other = table.evidence(error).null;
        if other > null + FLIP {
            null = other;
            flipped.push(joint);
        } else {
            table.flip(joint);
        }
    }
    for record in train {
        for joint in &flipped {
            record.measured[*joint].iter_mut().for_each(|x| *x = -*x);
        }
    }
    flipped
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

/// What may be said of what was found.
struct Judged {
    verdict: Verdict,
    effects: Vec<Said>,
    candidates: Vec<Said>,
    anything: Vec<Anything>,
    reasons: Vec<String>,
}

impl Judged {
    /// A delay or a lag.
    fn assert_late(&mut self, late: &Late, polished: Option<&mut Polished>) {
        let Some(fitted) = late.fitted() else { return };
        self.effects.push(Said {
            effect: fitted.effect,
            joints: late.joint.into_iter().collect(),
            class: vec!["time_delay", "filter_lag"],
            probability: 1.0 / (1.0 + (-late.nats).exp()),
            parameters: parameters(&[&fitted])[..1].to_vec(),
            share: 1.0,
            nats: late.nats,
        });
        if let Some(polished) = polished {
            polished.effects.push(fitted);
        }
        self.found_more();
    }

    fn found_more(&mut self) {
        self.verdict = match self.verdict {
            Verdict::Unknown | Verdict::Partial => Verdict::Partial,
            _ => Verdict::Effect,
        };
    }

    /// A current of the other sign, which is beyond doubt.
    fn assert_flipped(&mut self, joint: usize, polished: Option<&mut Polished>) {
        let Some(effect) = find("current_sign") else { return };
        if let Some(polished) = polished {
            polished.effects.push(Fitted {
                effect,
                joint: Some(joint),
                coordinates: vec![1.0],
                parameters: vec![1.0],
                deviations: vec![0.0],
                significance: f64::INFINITY,
            });
        }
        match self.effects.iter_mut().find(|said| said.effect.id == effect.id) {
            Some(said) => said.joints.push(joint),
            None => self.effects.push(Said {
                effect,
                joints: vec![joint],
                class: vec![effect.id],
                probability: 1.0,
                parameters: Vec::new(),
                share: 1.0,
                nats: FLIP,
            }),
        }
        self.found_more();
    }
}

fn judged(search: &Search<'_, '_>, found: &Found, polished: Option<&Polished>) -> Judged {
    let mut judged = Judged {
        verdict: Verdict::ParametersOnly,
        effects: Vec::new(),
        candidates: Vec::new(),
        anything: Vec::new(),
        reasons: Vec::new(),
    };
    let Some(polished) = polished else { return judged };
    let drops: Vec<f64> = (0..found.chosen.len())
        .map(|k| {
            let mut less = found.chosen.clone();
            less.remove(k);
            found.score - search.score(&less)
        })
        .collect();
    let mut refusal = false;
    let strongest = drops.iter().copied().fold(0.0, f64::max);
    let all: f64 = drops.iter().map(|drop| drop.max(0.0)).sum::<f64>().max(1e-12);
    for (k, chosen) in found.chosen.iter().enumerate() {
        let family = &search.families[chosen.family];
        let share = drops[k].max(0.0) / all;
        match family.owner {
            Owner::Generic(id) => {
                for piece in &chosen.pieces {
                    let joint = search.table.pieces[*piece].joint;
                    judged.anything.push(Anything { id, joint, share });
                }
            }
            Owner::Effect(effect) => {
                let all_of: Vec<&Fitted> =
                    polished.effects.iter().filter(|of| of.effect.id == effect.id).collect();
                // Joints of which nobody asks are not told beside those that matter.
                let matter: Vec<&Fitted> =
                    all_of.iter().copied().filter(|of| matters(search, of)).collect();
                let fitted = if matter.is_empty() { all_of } else { matter };
                let least = LEAST_NATS.max(OF_STRONGEST * strongest);
                let (class, probability) = if drops[k] < least {
                    (vec![effect.id], 1.0 / (1.0 + (-drops[k]).exp()))
                } else {
                    rivals(search, found, k)
                };
                let said = Said {
                    effect,
                    joints: fitted.iter().filter_map(|of| of.joint).collect(),
                    class,
                    probability,
                    parameters: parameters(&fitted),
                    share,
                    nats: drops[k],
                };
                match refused(search, &said, &fitted, polished, least) {
                    Some(Refused { why, is_open }) => {
                        refusal |= is_open;
                        judged.reasons.push(format!("{}: {why}", effect.id));
                        judged.candidates.push(said);
                    }
                    None => judged.effects.push(said),
                }
            }
        }
    }
    // What drifts is not what stays.
    let drifting: Vec<usize> = judged
        .anything
        .iter()
        .filter(|of| OF_DRIFT.contains(&of.id))
        .filter_map(|of| of.joint)
        .collect();
    let (kept, doubtful): (Vec<Said>, Vec<Said>) = judged.effects.drain(..).partition(|said| {
        said.effect.id == "warm_up" || !said.joints.iter().any(|joint| drifting.contains(joint))
    });
    judged.effects = kept;
    judged.candidates.extend(doubtful);
    // A window that leaves much of what changes with time is none.
    let left: f64 = (0..found.chosen.len())
        .filter(|k| OF_TIME.contains(&search.families[found.chosen[*k].family].owner.id()))
        .map(|k| drops[k])
        .sum();
    let (kept, doubtful): (Vec<Said>, Vec<Said>) = judged
        .effects
        .drain(..)
        .partition(|said| !GATED.contains(&said.effect.id) || left < LEFT * said.nats);
    judged.effects = kept;
    refusal |= !doubtful.is_empty();
    judged.candidates.extend(doubtful);
    let strongest = judged.effects.iter().map(|said| said.nats).fold(0.0, f64::max);
    let unknown: f64 = judged.anything.iter().map(|of| of.share).sum();
    if unknown > 0.5 || (unknown > 0.0 && strongest == 0.0) {
        judged.candidates.append(&mut judged.effects);
    }
    let too_many = judged.candidates.iter().any(|said| said.class.len() > LARGEST_CLASS);
    judged.verdict = match (judged.effects.is_empty(), judged.anything.is_empty()) {
        (false, true) => Verdict::Effect,
        (false, false) => Verdict::Partial,
        (true, false) => Verdict::Unknown,
        (true, true) if too_many => Verdict::NotSeparable,
        (true, true) if refusal => Verdict::Unknown,
        (true, true) => Verdict::ParametersOnly,
    };
    judged
}

/// Why an effect is not asserted.
struct Refused {
    why: String,
    /// Whether something is there all the same that is not known.
    is_open: bool,
}

/// Why an effect is not asserted, if it is not.
fn refused(
    search: &Search<'_, '_>,
    said: &Said,
    fitted: &[&Fitted],
    polished: &Polished,
    least: f64,
) -> Option<Refused> {
    let no = |why: String| Some(Refused { why, is_open: false });
    let open = |why: String| Some(Refused { why, is_open: true });
    let id = said.effect.id;
    if ["link_parameters", "apparent_torque"].contains(&id) {
        return no("a matter of parameters".to_owned());
    }
    if said.class.len() > LARGEST_CLASS {
        return open(format!("cannot be told from {}", said.class.join(", ")));
    }
    let size = size(search, said.effect, fitted);
    let relevant = if said.nats > CLEAR { CLEARLY } else { RELEVANT };
    if size < relevant {
        return no(format!("is less than {} % of the torque", 100.0 * relevant));
    }
    if id == "ripple" && fitted.iter().all(|of| of.parameters[0] < noise(search, of.joint)) {
        return no("is below the noise, as any motor's".to_owned());
    }
    if said.nats < least {
        return no(format!("brings {:.1} nats only", said.nats));
    }
    if fitted.iter().all(|of| of.significance < SIGNIFICANT) {
        return no("is not significant".to_owned());
    }
    for of in fitted {
        for (parameter, (value, sd)) in
            of.effect.parameters.iter().zip(of.parameters.iter().zip(&of.deviations))
        {
            let [low, high] = parameter.bounds;
            if *value < low - SIGNIFICANT * sd || *value > high + SIGNIFICANT * sd {
                return open(format!("{} = {value:.4} cannot be", parameter.name));
            }
        }
    }
    // Without stiffness a spring is an offset.
    if ["cable", "gravity_spring"].contains(&id)
        && fitted.iter().any(|of| of.parameters[0].abs() < SIGNIFICANT * of.deviations[0])
    {
        return open("is no more than an offset".to_owned());
    }
    let of_parameters: &[&str] = match id {
        "friction_level" => &["coulomb", "viscous"],
        "rotor_inertia" => &["rotor_inertia"],
        "payload" => &[],
        _ => return None,
    };
    if search.trust == Trust::Unknown {
        return no("nothing is known of the parameters".to_owned());
    }
    let within = |of: &&&Fitted| {
        let Some(joint) = of.joint else { return false };
        of_parameters.iter().enumerate().all(|(k, name)| {
            let key = format!("joint {} {name}", joint + 1);
            let Some(at) = search.table.parameters.iter().position(|name| *name == key) else {
                return true;
            };
            let total = of.coordinates[k] / search.table.deviations[at].max(1e-12)
                + polished.parameters[at];
            total.abs() <= BEYOND
        })
    };
    if !of_parameters.is_empty() && fitted.iter().filter(within).count() == fitted.len() {
        return no("within what the parameters are believed".to_owned());
    }
    None
}

/// Whether an effect at a joint is large enough to be told.
fn matters(search: &Search<'_, '_>, of: &Fitted) -> bool {
    let is_ripple = of.effect.id == "ripple";
    size(search, of.effect, &[of]) >= CLEARLY
        && !(is_ripple && of.parameters[0] < noise(search, of.joint))
}

/// Ripple of a joint that nobody asks for \[Nm\].
fn noise(search: &Search<'_, '_>, joint: Option<usize>) -> f64 {
    let of = |record: &Record<'_>| {
        let variance = record.variance[joint.unwrap_or(0)];
        variance * if record.kind == RecordKind::Mean { record.repetitions as f64 } else { 1.0 }
    };
    BELOW_NOISE * search.records.iter().map(of).fold(0.0, f64::max).sqrt()
}

/// The largest share that an effect has in the torques of a joint.
fn size(search: &Search<'_, '_>, effect: &Effect, fitted: &[&Fitted]) -> f64 {
    let (mut squares, mut all) = (vec![0.0; MAX_DOF], vec![1e-12; MAX_DOF]);
    let mean = |record: &&Record<'_>| record.kind == RecordKind::Mean;
    for record in search.records.iter().filter(mean) {
        let motion = &record.motion;
        for of in fitted {
            let joint = of
                .joint
                .unwrap_or_else(|| (effect.joints)(motion.model.dof).first().copied().unwrap_or(0));
            for (to, series) in effect.added(motion, joint, &of.coordinates) {
                squares[to] += series.iter().map(|x| x * x).sum::<f64>();
            }
        }
        for (joint, all) in all.iter_mut().enumerate().take(motion.model.dof) {
            *all += record.measured[joint].iter().map(|x| x * x).sum::<f64>();
        }
    }
    squares.iter().zip(&all).map(|(x, all)| (x / all).sqrt()).fold(0.0, f64::max)
}

/// What cannot be told from the effect, and how probable it is.
fn rivals(search: &Search<'_, '_>, found: &Found, place: usize) -> (Vec<&'static str>, f64) {
    let mut rest: Vec<Chosen> = found.chosen.clone();
    let own = rest.remove(place);
    let id = search.families[own.family].owner.id();
    let mut class = vec![id];
    let given = search.given(&rest);
    let mut odds = (search.score(&rest) - found.score).exp();
    for (number, family) in search.families.iter().enumerate() {
        if number == own.family || rest.iter().any(|of| of.family == number) {
            continue;
        }
        let Some(other) = search.with(&given, &rest, number) else { continue };
        let behind = found.score - other.score;
        odds += (-behind).exp();
        if behind < CLASS {
            class.push(family.owner.id());
        }
    }
    (class, 1.0 / (1.0 + odds))
}

fn parameters(fitted: &[&Fitted]) -> Vec<Estimated> {
    let mut all = Vec::new();
    for of in fitted {
        for (parameter, (value, sd)) in
            of.effect.parameters.iter().zip(of.parameters.iter().zip(&of.deviations))
        {
            let name = match of.joint {
                Some(joint) if fitted.len() > 1 => format!("{}_j{}", parameter.name, joint + 1),
                _ => parameter.name.to_owned(),
            };
            all.push(Estimated { name, value: *value, sd: *sd, unit: parameter.unit });
        }
    }
    all
}

/// Shares of the joints in what changes.
fn places(
    records: &[Record<'_>],
    model: &Model,
    refit: &Improved,
    improved: &Improved,
) -> Vec<Place> {
    let n = model.dof;
    let mut shares = vec![0.0; n];
    // The same parameters without the effects, or, where there are none, the nominal ones.
    let mut bare = improved.written.clone();
    if bare == refit.written {
        bare = model.clone();
    } else {
        bare.effects.clone_from(&refit.written.effects);
        bare.sensors.clone_from(&refit.written.sensors);
        bare.laws.clone_from(&refit.written.laws);
    }
    let (mut change, mut size) = (vec![0.0; n], vec![0.0; n]);
    for record in records.iter().filter(|record| record.kind == RecordKind::Mean) {
        let (with, without) = (predicted(record, &improved.applied), predicted(record, &bare));
        for joint in 0..n {
            let both = with[joint].iter().zip(&without[joint]);
            change[joint] += both.map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            size[joint] += record.measured[joint].iter().map(|x| x * x).sum::<f64>();
        }
    }
    for joint in 0..n {
        shares[joint] = change[joint] / size[joint].max(1e-12);
    }
    let sum: f64 = shares.iter().sum::<f64>().max(1e-300);
    (0..n)
        .map(|joint| Place {
            joint: Some(joint),
            regime: "all".to_owned(),
            share: shares[joint] / sum,
            movement: None,
            line: None,
        })
        .collect()
}
