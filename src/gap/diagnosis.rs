//! What a diagnosis says.

use crate::effects::Effect;

use super::heldout::Shrink;
use super::improved::Improved;

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
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Joint, from 0.
    pub joint: Option<usize>,
    /// When.
    pub regime: String,
    /// Share of the gap \[1\].
    pub share: f64,
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
    /// The nominal model with its parameters refitted.
    pub refit: Improved,
    /// That with the asserted effects.
    pub improved: Improved,
    /// Why the verdict is what it is.
    pub reasons: Vec<String>,
}
