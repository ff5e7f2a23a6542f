//! What a diagnosis says.

use crate::arm::robot::Model;

use super::calibration::asserted;
use super::findings::{Anything, Place, Said, Verdict};
use super::heldout::Shrink;
use super::improved::Improved;
use super::motion::RunFound;
use super::power::PowerFound;

/// Effects of what measures torques, not of the torques.
const OF_MEASUREMENT: [&str; 9] = [
    "torque_constant",
    "current_saturation",
    "flux_weakening",
    "current_sign",
    "torque_offset",
    "time_delay",
    "filter_lag",
    "ripple",
    "encoder_offset",
];

/// A diagnosis of torques.
#[derive(Clone)]
pub struct Diagnosis {
    /// What was found.
    pub verdict: Verdict,
    /// What is asserted.
    pub effects: Vec<Said>,
    /// What was considered.
    pub candidates: Vec<Said>,
    /// What no law explains.
    pub anything: Vec<Anything>,
    /// Where the gap is.
    pub places: Vec<Place>,
    /// How far it shrinks.
    pub shrink: Shrink,
    /// The model's own error, as a share of its torques.
    pub error: f64,
    /// What the best effect reaches where there is none, but in one of 50 measurements \[nats\].
    pub chance: f64,
    /// The nominal model with its parameters refitted.
    pub refit: Improved,
    /// That with the asserted effects.
    pub improved: Improved,
    /// Why the verdict is what it is.
    pub reasons: Vec<String>,
    /// Rms gaps of other channels: name, unit; noise, before, after.
    pub channels: Vec<(&'static str, &'static str, [f64; 3])>,
    /// Effects that a baseline has already; `None` where it is not compared with.
    pub before: Option<Vec<Said>>,
}

impl Diagnosis {
    /// Of a robot whose torques are not logged.
    #[must_use]
    pub fn without_torques(model: &Model) -> Diagnosis {
        Diagnosis {
            verdict: Verdict::NoGap,
            effects: Vec::new(),
            candidates: Vec::new(),
            anything: Vec::new(),
            places: Vec::new(),
            shrink: Shrink::default(),
            error: 0.0,
            chance: 0.0,
            refit: Improved::same(model),
            improved: Improved::same(model),
            reasons: Vec::new(),
            channels: Vec::new(),
            before: None,
        }
    }

    /// What the power says is a part of it.
    pub fn add_power(&mut self, found: &PowerFound) {
        // Torques that are wrong make wrong powers.
        let is_measured = |said: &Said| OF_MEASUREMENT.contains(&said.effect.id);
        let trusted = match self.verdict {
            Verdict::NoGap | Verdict::ParametersOnly => true,
            Verdict::Effect => !self.effects.iter().any(is_measured),
            _ => false,
        };
        let effects = if trusted { found.effects.as_slice() } else { &[] };
        for of in effects {
            self.effects.push(Said {
                class: of.class.clone(),
                probability: asserted(of.nats),
                parameters: of.parameters.clone(),
                ..Said::alone(of.effect, of.joint.into_iter().collect(), of.nats)
            });
        }
        self.channels.push(("power", "W", found.gap));
        self.add(!effects.is_empty(), found.is_unknown && trusted);
    }

    /// What runs of the program say is a part of it.
    pub fn add_runs(&mut self, found: &RunFound) {
        for of in &found.effects {
            self.effects.push(Said {
                class: of.class.clone(),
                probability: asserted(of.nats),
                parameters: of.parameters.clone(),
                ..Said::alone(of.effect, Vec::new(), of.nats)
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
