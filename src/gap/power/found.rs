//! What is said of the power.

use crate::arm::effects::Effect;
use crate::gap::decision::Estimated;

/// What was found of the power.
#[derive(Clone)]
pub struct PowerFound {
    /// The effects, the strongest first.
    pub effects: Vec<PowerEffect>,
    /// Whether there is a difference that no known effect explains.
    pub is_unknown: bool,
    /// Rms on the held-out data, noise taken off: noise, reference, with the effect \[W\].
    pub gap: [f64; 3],
}

/// An effect of the power.
#[derive(Clone)]
pub struct PowerEffect {
    /// The effect.
    pub effect: &'static Effect,
    /// Joint, from 0.
    pub joint: Option<usize>,
    /// Ids that cannot be told apart.
    pub class: Vec<&'static str>,
    /// Its parameter, where it has one.
    pub parameters: Vec<Estimated>,
    /// Logarithm of the odds.
    pub nats: f64,
}
