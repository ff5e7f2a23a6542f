//! What may be said of the effects that were found.

use crate::arm::effects::find;

use super::chosen::{Chosen, Found};
use super::column::Owner;
use super::effect_ids::{COUPLING, GATED, OF_TIME, OF_WRIST};
use super::findings::{Anything, Estimated, Said, Verdict};
use super::fitted::{Fitted, Polished};
use super::generic::OF_DRIFT;
use super::refused::{LARGEST_CLASS, Refused, SIGNIFICANT, drags_always, matters, refused};
use super::search::Search;
use super::sizes::size;

/// Odds below which two explanations cannot be told apart: 1 to 100.
pub(super) const CLASS: f64 = 4.6;
/// What another sign has to bring.
pub(super) const FLIP: f64 = 50.0;
/// What a function of time may still bring beside a gated effect, of what that does.
const LEFT: f64 = 0.3;
/// What an effect has to bring, of what the strongest does that has another form than its law's at
/// the same joint, if it is no body's.
const OF_STRONGEST: f64 = 0.01;
const OF_BODIES: [&str; 2] = ["payload", "link_parameters"];
/// What an effect has to bring.
pub(super) const LEAST_NATS: f64 = 8.0;
/// The same of what changes with time, as all friction does a little.
const LEAST_OF_TIME: f64 = 25.0;
/// A joint at which an effect is so much smaller than at another one is not told.
const OF_LARGEST: f64 = 0.15;
/// Probability below which an effect is not asserted, whatever it brings.
const IMPROBABLE: f64 = 0.05;
/// Spread of a parameter where functions follow the form, of the share that they have.
const FORM_SPREAD: f64 = 0.5;
/// The same where nothing follows it: no robot obeys a law to the last digit.
const LEAST_SPREAD: f64 = 0.03;
/// Change of a joint's friction.
const LEVEL: &str = "friction_level";

/// What may be said of what was found.
#[derive(Clone)]
pub(super) struct Judged {
    pub(super) verdict: Verdict,
    pub(super) effects: Vec<Said>,
    pub(super) candidates: Vec<Said>,
    pub(super) anything: Vec<Anything>,
    pub(super) reasons: Vec<String>,
}

impl Judged {
    /// With these effects and candidates and nothing else.
    pub(super) fn of(effects: Vec<Said>, candidates: Vec<Said>) -> Judged {
        let verdict = if effects.is_empty() { Verdict::ParametersOnly } else { Verdict::Effect };
        Judged { verdict, effects, candidates, anything: Vec::new(), reasons: Vec::new() }
    }

    /// Takes back what was asserted.
    pub(super) fn withdraw(&mut self, verdict: Verdict, why: &str) {
        self.candidates.append(&mut self.effects);
        self.verdict = verdict;
        self.reasons.insert(0, why.to_owned());
    }

    pub(super) fn found_more(&mut self) {
        self.verdict = match self.verdict {
            Verdict::Unknown | Verdict::Partial => Verdict::Partial,
            _ => Verdict::Effect,
        };
    }

    /// A current of the other sign, which is beyond doubt.
    pub(super) fn assert_flipped(&mut self, joint: usize) {
        let Some(effect) = find("current_sign") else { return };
        match self.effects.iter_mut().find(|said| said.effect.id == effect.id) {
            Some(said) => said.joints.push(joint),
            None => self.effects.push(Said::alone(effect, vec![joint], FLIP)),
        }
        self.found_more();
    }
}

/// What may be said of a set; `chance` is what the best family reaches where nothing is \[nats\].
pub(super) fn judged(
    search: &Search<'_, '_>,
    found: &Found,
    polished: Option<&Polished>,
    chance: f64,
) -> Judged {
    let mut judged = Judged::of(Vec::new(), Vec::new());
    let Some(polished) = polished else { return judged };
    let mut drops: Vec<f64> = (0..found.chosen.len())
        .map(|k| {
            let mut less = found.chosen.clone();
            less.remove(k);
            found.score - search.score(&less)
        })
        .collect();
    // Functions beside a law that explains most of what they do together are its form.
    let form: Vec<f64> = (0..found.chosen.len())
        .map(|k| match search.families[found.chosen[k].family].owner {
            Owner::Effect(_) => {
                let (form, alone) = search.share_of_form(found, k);
                drops[k] = drops[k].max(alone);
                form
            }
            Owner::Generic(_) => 1.0,
        })
        .collect();
    let mut followed: Vec<Option<usize>> = Vec::new();
    let mut refusal = false;
    let late = search.late.map_or(0.0, |late| late.nats);
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
                // Not what others bring.
                let own = |of: &&Fitted| {
                    let joint = |piece: &usize| search.table.pieces[*piece].joint == of.joint;
                    chosen.pieces.iter().any(joint)
                };
                let all_of: Vec<&Fitted> = polished
                    .effects
                    .iter()
                    .filter(|of| of.effect.id == effect.id && own(of))
                    .collect();
                // Joints of which nobody asks are not told beside those that matter.
                let largest = all_of.iter().map(|of| size(search, effect, &[of]));
                let least = OF_LARGEST * largest.fold(0.0, f64::max);
                let tells = |of: &&Fitted| {
                    matters(search, polished, of)
                        && of.significance >= SIGNIFICANT
                        && size(search, effect, &[of]) >= least
                };
                let matter: Vec<&Fitted> = all_of.iter().copied().filter(tells).collect();
                let fitted = if matter.is_empty() { all_of } else { matter };
                // How repetitions drift is measured by itself, whatever else there is.
                let least = if effect.id == "warm_up" {
                    LEAST_OF_TIME
                } else {
                    let strongest = search.strongest_there(found, k, &drops).max(late);
                    LEAST_NATS.max(OF_STRONGEST * strongest)
                };
                let least = least.max(chance);
                let (mut class, probability) = if drops[k] < least && form[k] == 0.0 {
                    (vec![effect.id], 1.0 / (1.0 + (-drops[k]).exp()))
                } else {
                    rivals(search, found, k, form[k])
                };
                if fitted.iter().any(|of| drags_always(of)) && !class.contains(&LEVEL) {
                    class.push(LEVEL);
                }
                let said = Said {
                    effect,
                    joints: if effect.id == COUPLING {
                        OF_WRIST.to_vec()
                    } else {
                        fitted.iter().filter_map(|of| of.joint).collect()
                    },
                    class,
                    probability,
                    parameters: of_form(parameters(&fitted), form[k]),
                    share,
                    nats: drops[k],
                    size: size(search, effect, &fitted),
                };
                let refused = if form[k] > search.largest_form(found, k) {
                    let why = "functions follow it better than its law".to_owned();
                    Some(Refused { why, is_open: true })
                } else if form[k] == 0.0 && said.probability < IMPROBABLE {
                    let why = "something else is far more probable".to_owned();
                    Some(Refused { why, is_open: true })
                } else {
                    refused(search, &said, &fitted, polished, least)
                };
                if let Some(Refused { why, is_open }) = refused {
                    refusal |= is_open;
                    judged.reasons.push(format!("{}: {why}", effect.id));
                    judged.candidates.push(said);
                } else {
                    if form[k] > 0.0 {
                        let of = &chosen.pieces;
                        followed.extend(of.iter().map(|p| search.table.pieces[*p].joint));
                    }
                    judged.effects.push(said);
                }
            }
        }
    }
    judged.demote_lesser(search, found);
    judged.demote_second_window();
    refusal |= judged.demote_too_many(search);
    let is_form = |of: &Anything| followed.contains(&of.joint) || followed.contains(&None);
    let forms = judged.anything.iter().filter(|of| is_form(of)).map(|of| of.share).sum::<f64>();
    // What drifts is not what stays.
    let drifting: Vec<usize> = judged
        .anything
        .iter()
        .filter(|of| OF_DRIFT.contains(&of.id) && !is_form(of))
        .filter_map(|of| of.joint)
        .collect();
    judged.demote_levels_that_fade();
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
    let unknown = judged.anything.iter().map(|of| of.share).sum::<f64>() - forms;
    if unknown > 0.5 || (unknown > 0.0 && strongest == 0.0) {
        judged.candidates.append(&mut judged.effects);
    }
    let too_many = judged.candidates.iter().any(|said| said.class.len() > LARGEST_CLASS);
    let nothing_else = judged.anything.iter().all(is_form);
    judged.verdict = match (judged.effects.is_empty(), nothing_else) {
        (false, true) => Verdict::Effect,
        (false, false) => Verdict::Partial,
        (true, false) => Verdict::Unknown,
        (true, true) if too_many => Verdict::NotSeparable,
        (true, true) if refusal => Verdict::Unknown,
        (true, true) => Verdict::ParametersOnly,
    };
    judged
}

impl Search<'_, '_> {
    /// The most that one of the set brings, `place` among them, that acts at a joint of `place`; a body
    /// has no other form than its law's, which `place` could be a part of.
    fn strongest_there(&self, found: &Found, place: usize, drops: &[f64]) -> f64 {
        let joints = |of: &Chosen| -> Vec<Option<usize>> {
            if self.families[of.family].owner.id() == COUPLING {
                return OF_WRIST.map(Some).to_vec();
            }
            of.pieces.iter().map(|piece| self.table.pieces[*piece].joint).collect()
        };
        let own = joints(&found.chosen[place]);
        let acts_there = |of: &Chosen| {
            let id = self.families[of.family].owner.id();
            let there = joints(of).iter().any(|joint| joint.is_none() || own.contains(joint));
            !OF_BODIES.contains(&id) && (there || own.contains(&None))
        };
        let there = found.chosen.iter().zip(drops).filter(|(of, _)| acts_there(of));
        there.map(|(_, drop)| *drop).fold(0.0, f64::max)
    }
}

/// What cannot be told from the effect, and how probable it is.
/// Functions that follow its form bring the share `form` of what it does with them.
fn rivals(
    search: &Search<'_, '_>,
    found: &Found,
    place: usize,
    form: f64,
) -> (Vec<&'static str>, f64) {
    let mut rest: Vec<Chosen> = found.chosen.clone();
    let own = rest.remove(place);
    let id = search.families[own.family].owner.id();
    let mut class = vec![id];
    if form > 0.0 {
        class.extend(search.rival_forms(found, place));
        let probability = (1.0 - form) / class.len() as f64;
        return (class, probability);
    }
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

/// Parameters depend on the form that a law is taken to have.
fn of_form(mut parameters: Vec<Estimated>, form: f64) -> Vec<Estimated> {
    for of in &mut parameters {
        of.sd = of.sd.hypot((FORM_SPREAD * form).max(LEAST_SPREAD) * of.value);
    }
    parameters
}

pub(super) fn parameters(fitted: &[&Fitted]) -> Vec<Estimated> {
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
