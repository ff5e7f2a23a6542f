//! What a diagnosis can say: a verdict, effects, places.

use super::calibration::{Calibration, of_odds};
use crate::arm::effects::Effect;

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
pub struct Finding {
    /// The effect.
    pub effect: &'static Effect,
    /// Joints, from 0; empty where it is of the robot.
    pub joints: Vec<usize>,
    /// Effects that these data cannot tell from it, itself among them.
    pub class: Vec<&'static str>,
    /// Probability by the evidence alone, over all sets that were fitted.
    pub inclusion: f64,
    /// Its parameters.
    pub parameters: Vec<Estimated>,
    /// Logarithm of the odds that it brings.
    pub nats: f64,
    /// The largest share that it has of a joint's torque \[1\].
    pub size: f64,
}

impl Finding {
    /// Of an effect that has its channel to itself and cannot be taken for another one.
    pub(in crate::gap) fn alone(effect: &'static Effect, joints: Vec<usize>, nats: f64) -> Finding {
        Finding {
            effect,
            joints,
            class: vec![effect.id],
            inclusion: of_odds(nats),
            parameters: Vec::new(),
            nats,
            size: 1.0,
        }
    }

    /// How often such an effect is there, if it is asserted or only considered.
    #[must_use]
    pub fn probability(&self, is_asserted: bool) -> f64 {
        Calibration::used().stated(self.inclusion, is_asserted)
    }
}

/// What no known law explains of a joint's torque.
#[derive(Clone, Debug, PartialEq)]
pub struct Remainder {
    /// What most of it is a smooth function of, or `other`.
    pub id: &'static str,
    /// Joint, from 0.
    pub joint: usize,
    /// Share of the joint's torque \[1\].
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
