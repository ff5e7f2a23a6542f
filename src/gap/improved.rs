//! The model with what was found of it.

use nalgebra::{DMatrix, DVector, Matrix3, SymmetricEigen, Vector3};

use crate::dynamics::{JOINT, RIGID, link_parameters};
use crate::effects::{Effect, Of, applied};
use crate::robot::{EffectParameters, Given, Link, Model};

use super::polish::Fitted;

/// Effects of the log, which robot files keep as numbers of their own.
pub(super) const OF_LOG: [&str; 4] =
    ["apparent_torque", "encoder_offset", "torque_offset", "torque_constant"];
/// Least spread of a body's mass along an axis, of the largest.
const LEAST_SPREAD: f64 = 1e-4;

/// A model as it is written, and as it predicts.
#[derive(Clone, Debug)]
pub struct Improved {
    /// With its effects listed: what a robot file has.
    pub written: Model,
    /// With its effects in it.
    pub applied: Model,
}

impl Improved {
    /// A model as it is.
    #[must_use]
    pub fn same(model: &Model) -> Improved {
        Improved { written: model.clone(), applied: model.clone() }
    }

    /// A model that lists its effects.
    #[must_use]
    pub fn of(written: Model) -> Improved {
        Improved { applied: reapplied(&written), written }
    }

    /// A model with changes `parameters` (in deviations, which `mixing` turns into standard
    /// parameters) and with effects. Effects that no robot file can have are left out.
    #[must_use]
    pub fn new(
        model: &Model,
        mixing: &DMatrix<f64>,
        parameters: &DVector<f64>,
        effects: &[Fitted],
    ) -> Improved {
        let mut written = model.clone();
        let count = mixing.ncols().min(parameters.len());
        refit(&mut written, &(mixing.columns(0, count) * parameters.rows(0, count)));
        let mut result = Improved::of(written);
        for fitted in effects {
            let mut next = result.written.clone();
            add(&mut next, fitted);
            let mut bare = next.clone();
            bare.laws.clear();
            if let Ok(applied) = applied(bare) {
                result = Improved { written: next, applied };
            }
        }
        result
    }
}

/// The model with the effects that it lists.
fn reapplied(written: &Model) -> Model {
    let mut bare = written.clone();
    bare.laws.clear();
    applied(bare).unwrap_or_else(|_| written.clone())
}

/// Changes of the standard parameters, as far as a robot can have them.
fn refit(model: &mut Model, change: &DVector<f64>) {
    let n = model.dof;
    for (number, link) in model.links.iter_mut().enumerate() {
        let before = link_parameters(link);
        let more = change.rows(RIGID * number, RIGID);
        if more.iter().all(|x| *x == 0.0) {
            continue;
        }
        let after: Vec<f64> = before.iter().zip(more.iter()).map(|(a, b)| a + b).collect();
        if after[0] > 0.0 {
            *link = body(&after);
        }
    }
    for joint in 0..n {
        let at = RIGID * n + JOINT * joint;
        if let Some(motors) = &mut model.motors {
            let ratio = motors.ratio[joint];
            let rotor = &mut motors.rotor_inertia[joint];
            *rotor = (*rotor + change[at] / (ratio * ratio)).max(0.0);
        }
        let friction = &mut model.friction;
        friction.viscous[joint] = (friction.viscous[joint] + change[at + 1]).max(0.0);
        friction.coulomb[joint] = (friction.coulomb[joint] + change[at + 2]).max(0.0);
        model.sensors.torque_offset[joint] += change[at + 3];
    }
}

fn body(parameters: &[f64]) -> Link {
    let m = parameters[0];
    let com = Vector3::new(parameters[1], parameters[2], parameters[3]) / m.max(1e-12);
    let [xx, yy, zz, xy, xz, yz] = std::array::from_fn(|k| parameters[4 + k]);
    let about = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let steiner = (Matrix3::identity() * com.norm_squared() - com * com.transpose()) * m;
    let link = Link { mass: m, com, inertia: about - steiner };
    if link.is_consistent() {
        return link;
    }
    // The nearest body: its mass is spread along each axis, by no less than nothing.
    let spread = Matrix3::identity() * (0.5 * link.inertia.trace()) - link.inertia;
    let mut eigen = SymmetricEigen::new(spread);
    let least = LEAST_SPREAD * eigen.eigenvalues.amax();
    for value in eigen.eigenvalues.iter_mut() {
        *value = value.max(least);
    }
    let spread = eigen.recompose();
    Link { inertia: Matrix3::identity() * spread.trace() - spread, ..link }
}

fn add(model: &mut Model, fitted: &Fitted) {
    let effect = fitted.effect;
    if OF_LOG.contains(&effect.id)
        && let (crate::effects::Form::Model(change), Some(joint)) = (&effect.form, fitted.joint)
    {
        change(model, joint, &fitted.coordinates);
        return;
    }
    let dof = model.dof;
    let known = model.effects.iter().position(|of| of.id == effect.id);
    let at = known.unwrap_or_else(|| {
        model.effects.push(empty(effect, dof));
        model.effects.len() - 1
    });
    for (parameter, value) in effect.parameters.iter().zip(&fitted.parameters) {
        let value = value.clamp(parameter.bounds[0], parameter.bounds[1]);
        let values = &mut model.effects[at].values;
        let Some((_, given)) = values.iter_mut().find(|(name, _)| name == parameter.name) else {
            continue;
        };
        match given {
            Given::Robot(of) => *of += value,
            Given::Joints(list) => {
                if let Some(of) = fitted.joint.and_then(|joint| list.get_mut(joint)) {
                    *of = value;
                }
            }
        }
    }
}

fn empty(effect: &Effect, dof: usize) -> EffectParameters {
    let given = match effect.of {
        Of::Robot => Given::Robot(0.0),
        Of::Joint => Given::Joints(vec![0.0; dof]),
    };
    let values = effect.parameters.iter().map(|p| (p.name.to_owned(), given.clone())).collect();
    EffectParameters { id: effect.id.to_owned(), values, place: "diagnosis".to_owned() }
}
