//! Effects that another one brings along, as they are not separable beforehand.

use nalgebra::DMatrix;

use crate::arm::dynamics::{JOINT, RIGID};
use crate::arm::effects::{Effect, Form};
use crate::arm::robot::Model;
use crate::gap::data::Record;

/// An effect that another one brings along to a joint; all its coordinates are linear.
#[derive(Clone)]
pub(in crate::gap) struct BroughtEffect {
    /// The effect.
    pub effect: &'static Effect,
    /// Joint, from 0.
    pub joint: usize,
    /// Usual values of its coordinates.
    pub usual: Vec<f64>,
    /// Standard parameters of the model that it changes.
    pub parameters: Vec<usize>,
}

impl BroughtEffect {
    /// An effect that changes numbers of the model; `None` for another one.
    pub(super) fn new(
        effect: &'static Effect,
        joint: usize,
        usual: Vec<f64>,
        records: &[Record<'_>],
    ) -> Option<BroughtEffect> {
        let Form::Model(change) = effect.form else { return None };
        let model = records.first()?.motion.model;
        let mut changed = model.clone();
        change(&mut changed, joint, &usual);
        let of = |model: &Model| {
            [
                model.friction.viscous[joint],
                model.friction.coulomb[joint],
                model.sensors.torque_offset[joint],
            ]
        };
        let first = RIGID * model.dof + JOINT * joint + 1;
        let pairs = of(model).into_iter().zip(of(&changed)).enumerate();
        let parameters = pairs.filter(|(_, (a, b))| a != b).map(|(k, _)| first + k).collect();
        Some(BroughtEffect { effect, joint, usual, parameters })
    }

    /// The least factors of its columns that can be.
    pub(super) fn least(&self, model: &Model) -> Vec<f64> {
        let values = self.effect.parameters.iter().zip(&self.usual);
        let least = values.map(|(parameter, usual)| {
            let there = parameter.there.and_then(|of| of(model, self.joint));
            there.map_or(f64::NEG_INFINITY, |there| -there / usual)
        });
        least.collect()
    }
}

/// Columns that an effect brings along.
#[derive(Default)]
pub(super) struct Brought {
    /// Their prior.
    pub(super) prior: Vec<(f64, f64)>,
    /// Their rows by joint.
    pub(super) rows: Vec<(usize, DMatrix<f64>)>,
    /// What they are.
    pub(super) effects: Vec<BroughtEffect>,
}
