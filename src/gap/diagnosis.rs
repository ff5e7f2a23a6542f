//! What a diagnosis says.

use crate::arm::effects::Subject;
use crate::arm::robot::Model;

use super::data::Record;
use super::decision::{Entry, Finding, Gate, Place, Remainder, Verdict, of_odds};
use super::grade::{Budget, Shrink, shrink};
use super::model::Improved;
use super::motion::RunFound;
use super::power::PowerFound;
use super::rivals::Rivals;

/// Probability from which on an effect is sure, and below which it is none.
const SURE: f64 = 0.8;
const POSSIBLE: f64 = 0.2;

/// A diagnosis of torques.
#[derive(Clone)]
pub struct Diagnosis {
    /// What was found.
    pub verdict: Verdict,
    /// What is asserted.
    pub effects: Vec<Finding>,
    /// What was considered.
    pub candidates: Vec<Finding>,
    /// What no law explains.
    pub remainder: Vec<Remainder>,
    /// The answers of the gates.
    pub trail: Vec<Entry>,
    /// Everyday error by joint, of its torque \[1\].
    pub everyday: Vec<f64>,
    /// What the gap is made of, by joint, then of all.
    pub budget: Vec<Budget>,
    /// Where the gap is.
    pub places: Vec<Place>,
    /// How far it shrinks.
    pub shrink: Shrink,
    /// The nominal model with its parameters refitted.
    pub refit: Improved,
    /// That with the asserted effects.
    pub improved: Improved,
    /// Why the verdict is what it is.
    pub reasons: Vec<String>,
    /// Effects that a baseline has already.
    pub before: Vec<Finding>,
    /// Rms gaps of other channels: name, unit; noise, before, after.
    pub channels: Vec<(&'static str, &'static str, [f64; 3])>,
    /// Explanations of the torques that a further motion may tell apart.
    pub rivals: Option<Rivals>,
}

impl Diagnosis {
    /// Of a robot whose torques are not logged.
    #[must_use]
    pub fn without_torques(model: &Model) -> Diagnosis {
        let same = Improved::same(model);
        Diagnosis {
            verdict: Verdict::NoGap,
            effects: Vec::new(),
            candidates: Vec::new(),
            remainder: Vec::new(),
            trail: Vec::new(),
            everyday: Vec::new(),
            budget: Vec::new(),
            places: Vec::new(),
            shrink: Shrink::default(),
            refit: same.clone(),
            improved: same,
            reasons: Vec::new(),
            channels: Vec::new(),
            before: Vec::new(),
            rivals: None,
        }
    }

    /// Of logs whose numbers cannot be compared.
    pub(super) fn failed(model: &Model, held: &[Record<'_>]) -> Diagnosis {
        Diagnosis {
            verdict: Verdict::Unknown,
            shrink: shrink(held, [model, model, model]),
            reasons: vec!["the logs cannot be compared with the model".to_owned()],
            ..Diagnosis::without_torques(model)
        }
    }

    /// Whether a further motion is asked for: nothing is known, or not for sure.
    #[must_use]
    pub fn is_open(&self) -> bool {
        let unsure = |of: &Finding| of.class.len() > 1 || of.probability(true) < SURE;
        // What is too small to be a finding is no question.
        let is_large = |of: &Finding| {
            self.trail.iter().any(|entry| {
                entry.gate == Gate::Size
                    && entry.passed
                    && entry.hypothesis.starts_with(of.effect.id)
            })
        };
        let considered = |of: &Finding| of.probability(false) > POSSIBLE && is_large(of);
        match self.verdict {
            Verdict::Unknown | Verdict::Partial | Verdict::NotSeparable | Verdict::NotExcited => {
                true
            }
            Verdict::Effect => self.effects.iter().any(unsure),
            Verdict::ParametersOnly => self.candidates.iter().any(considered),
            Verdict::NoGap => false,
        }
    }

    /// What the power says is a part of it.
    pub fn add_power(&mut self, found: &PowerFound) {
        // Torques that are wrong make wrong powers.
        let is_measured = |said: &Finding| said.effect.subject == Subject::Measurement;
        let trusted = match self.verdict {
            Verdict::NoGap | Verdict::ParametersOnly => true,
            Verdict::Effect => !self.effects.iter().any(is_measured),
            _ => false,
        };
        let effects = if trusted { found.effects.as_slice() } else { &[] };
        for of in effects {
            self.effects.push(Finding {
                class: of.class.clone(),
                inclusion: of_odds(of.nats),
                parameters: of.parameters.clone(),
                ..Finding::alone(of.effect, of.joint.into_iter().collect(), of.nats)
            });
        }
        self.channels.push(("power", "W", found.gap));
        self.add(!effects.is_empty(), found.is_unknown && trusted);
    }

    /// What runs of the program say is a part of it.
    pub fn add_runs(&mut self, found: &RunFound) {
        for of in &found.effects {
            self.effects.push(Finding {
                class: of.class.clone(),
                inclusion: of_odds(of.nats),
                parameters: of.parameters.clone(),
                ..Finding::alone(of.effect, Vec::new(), of.nats)
            });
            if of.movement.is_some() {
                self.places.push(Place {
                    joint: None,
                    regime: of.effect.id.to_owned(),
                    share: 1.0,
                    movement: of.movement,
                    ..Place::default()
                });
            }
        }
        self.channels.push(("motion", "s", found.gap));
        self.add(!found.effects.is_empty(), found.is_unknown);
        if self.verdict == Verdict::Effect && found.is_ambiguous() {
            self.verdict = Verdict::NotSeparable;
        }
    }

    fn add(&mut self, has_effect: bool, is_unknown: bool) {
        self.verdict = match (self.verdict, has_effect, is_unknown) {
            (Verdict::NoGap | Verdict::ParametersOnly, true, false) => Verdict::Effect,
            (Verdict::NoGap | Verdict::ParametersOnly, false, true) => Verdict::Unknown,
            (Verdict::Effect, _, true) | (Verdict::Unknown, true, _) => Verdict::Partial,
            (verdict, ..) => verdict,
        };
    }
}
