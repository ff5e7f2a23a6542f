//! What a diagnosis says.

use crate::arm::effects::Effect;

use super::calibration::asserted;
use super::heldout::Shrink;
use super::improved::Improved;
use super::power::PowerFound;
use super::runs::RunFound;

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

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The model is right.
    NoGap,
    /// Other parameters of the model explain the gap.
    ParametersOnly,
    /// Effects explain it.
    Effect,
    /// Effects explain a part, the rest is not known.
    Partial,
    /// No known law explains it.
    Unknown,
    /// More laws explain it than can be told apart.
    NotSeparable,
    /// The motion shows too little.
    NotExcited,
}

impl Verdict {
    /// As JSON has it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Verdict::NoGap => "no_gap",
            Verdict::ParametersOnly => "parameters_only",
            Verdict::Effect => "effect",
            Verdict::Partial => "partial",
            Verdict::Unknown => "unknown",
            Verdict::NotSeparable => "not_separable",
            Verdict::NotExcited => "not_excited",
        }
    }
}

/// A parameter with its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimated {
    /// Name, with the joint behind it where there are several.
    pub name: String,
    /// Value, SI.
    pub value: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Unit.
    pub unit: &'static str,
}

/// An effect that is asserted or was considered.
#[derive(Clone)]
pub struct Said {
    /// The effect.
    pub effect: &'static Effect,
    /// Joints, from 0; empty where it is of the robot.
    pub joints: Vec<usize>,
    /// Effects that these data cannot tell from it, itself among them.
    pub class: Vec<&'static str>,
    /// Posterior probability.
    pub probability: f64,
    /// Its parameters.
    pub parameters: Vec<Estimated>,
    /// Share of what all effects and functions explain \[1\].
    pub share: f64,
    /// Logarithm of the odds that it brings.
    pub nats: f64,
    /// The largest share that it has of a joint's torque \[1\].
    pub size: f64,
}

impl Said {
    /// Of an effect that has its channel to itself and cannot be taken for another one.
    pub(super) fn alone(effect: &'static Effect, joints: Vec<usize>, nats: f64) -> Said {
        Said {
            effect,
            joints,
            class: vec![effect.id],
            probability: 1.0 / (1.0 + (-nats).exp()),
            parameters: Vec::new(),
            share: 1.0,
            nats,
            size: 1.0,
        }
    }
}

/// A smooth function that explains what no law does.
#[derive(Clone, Debug, PartialEq)]
pub struct Anything {
    /// What it is of.
    pub id: &'static str,
    /// Joint, from 0.
    pub joint: Option<usize>,
    /// Share of what all explain \[1\].
    pub share: f64,
}

/// Where the gap is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Place {
    /// Joint, from 0.
    pub joint: Option<usize>,
    /// When: `all`, or a piece of the speed, position, load or time.
    pub regime: String,
    /// Share of the gap \[1\].
    pub share: f64,
    /// What of it each effect has, where it is told; below 0 where it makes up for another one.
    pub by_effect: Vec<(&'static str, f64)>,
    /// Times of a piece of the motion \[s\].
    pub span: Option<[f64; 2]>,
    /// The movement behind which it is, from 1.
    pub movement: Option<usize>,
    /// File and line of the program.
    pub line: Option<(String, usize)>,
}

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
