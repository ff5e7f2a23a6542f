//! The result of an identification.

use crate::arm::dynamics::{BaseParameters, JOINT, Load, RIGID};
use crate::arm::robot::Model;

use super::equations::{Equations, Known};
use super::fit::Fit;
use super::misses::Misses;
use super::nearest::base_values;
use super::quality::Quality;
use super::samples::{Samples, Source};

/// An identified model and its fit.
#[derive(Clone, Debug)]
pub struct Identified {
    /// The model with identified parameters.
    pub model: Model,
    /// The free base parameters.
    pub base: BaseParameters,
    /// The fit without constraints.
    pub fit: Fit,
    /// All free parameters of the model, in the order of `among`.
    pub parameters: Vec<f64>,
    /// Their indices, as in `parameter_name`.
    pub among: Vec<usize>,
    /// The wrist coupling found in the data, if the model has none.
    pub coupling: Option<f64>,
    /// Residuals of the model on the training samples.
    pub training: Misses,
    /// Residuals on the validation samples.
    pub validation: Option<Misses>,
    /// Residuals of the unconstrained fit on the validation samples.
    pub unconstrained_validation: Option<Misses>,
    /// Root mean square of each joint's residuals \[Nm\] in cross-validation with consistent
    /// models, on the folds of the fit's `cross_rms`.
    pub cross_rms: Vec<f64>,
    /// Whether every link is physically possible.
    pub physically_consistent: bool,
    /// The payload, if it was free.
    pub payload: Option<Load>,
    /// Joints that were not excited, from 0.
    pub resting: Vec<usize>,
    /// Source of the rates.
    pub source: Source,
    /// Share of the torques that the model explains, and grade.
    pub quality: Quality,
}

impl Identified {
    /// For each instant, the time and `[measured, predicted, rate]` by joint; unusable torques are
    /// NaN.
    #[must_use]
    pub fn traces(&self, nominal: &Model, samples: &Samples) -> Vec<(f64, [Vec<f64>; 3])> {
        let beta = base_values(&self.base, &self.among, &self.parameters);
        let known = match self.payload {
            Some(_) => Known::All,
            None if self.among.len() < (RIGID + JOINT) * nominal.dof => Known::Rigid,
            None => Known::Nothing,
        };
        let mut model = nominal.clone();
        model.wrist = self.model.wrist.clone();
        let equations = Equations { model: &model, base: &self.base, known };
        let layout = equations.layout();
        let mut rows = Vec::new();
        equations.each(samples, &layout, &mut |instant| {
            let mut parts: [Vec<f64>; 3] = Default::default();
            for (joint, columns, place) in layout.joints() {
                let free = instant.predicted(columns, place, &beta);
                let predicted = free + instant.tau[joint] - instant.y[joint];
                let shown = |value: f64| if instant.usable[joint] { value } else { f64::NAN };
                parts[0].push(shown(instant.tau[joint]));
                parts[1].push(shown(predicted));
                parts[2].push(instant.qd[joint]);
            }
            rows.push((instant.t, parts));
        });
        rows
    }
}
