//! Effects with fitted parameters.

use nalgebra::DVector;

use crate::arm::effects::Effect;

/// An effect at a joint, with its parameters.
#[derive(Clone)]
pub struct Fitted {
    /// The effect.
    pub effect: &'static Effect,
    /// Joint, from 0; `None` of the robot.
    pub joint: Option<usize>,
    /// Its coordinates.
    pub coordinates: Vec<f64>,
    /// Its parameters, as they are written.
    pub parameters: Vec<f64>,
    /// Their standard deviations.
    pub deviations: Vec<f64>,
    /// The largest of its linear coordinates over their deviation; infinite where the effect
    /// acts without them.
    pub significance: f64,
}

impl Fitted {
    /// Whether a parameter is so many deviations beyond what can be.
    #[must_use]
    pub fn is_impossible(&self, deviations: f64) -> bool {
        let values = self.parameters.iter().zip(&self.deviations);
        self.effect.parameters.iter().zip(values).any(|(parameter, (value, sd))| {
            let [low, high] = parameter.bounds;
            *value < low - deviations * sd || *value > high + deviations * sd
        })
    }
}

/// All effects that were found, and the parameters of the model with them.
pub struct Polished {
    /// Effects joint by joint.
    pub effects: Vec<Fitted>,
    /// Changes of the model's parameters, in deviations.
    pub parameters: DVector<f64>,
    /// Joints whose friction came out below nothing and was held there.
    pub bounded: Vec<usize>,
}
