//! The model with what was found of it.

use nalgebra::DVector;

use crate::arm::dynamics::{JOINT, RIGID, link_of, link_parameters};
use crate::arm::effects::{Effect, Form, Nature, Scope, applied};
use crate::arm::robot::{EffectParameters, Given, Model};

use super::fitted::Fitted;
use super::possible::{possible, possible_load};

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

    /// A model with changes of its standard parameters, of which `sizes` are usual, with those that
    /// effects bring along, and with effects. Effects that no robot file can have are left out.
    #[must_use]
    pub fn new(
        model: &Model,
        [change, sizes]: [&DVector<f64>; 2],
        [brought, effects]: [&[Fitted]; 2],
    ) -> Improved {
        let mut written = model.clone();
        refit(&mut written, change, sizes);
        for of in brought {
            of.change(&mut written);
        }
        let mut result = Improved::of(written);
        // What dry friction there is bounds how far it may fall.
        let is_parameter = |of: &&Fitted| of.effect.nature != Nature::Law;
        let laws = effects.iter().filter(|of| !is_parameter(of));
        for fitted in effects.iter().filter(is_parameter).chain(laws) {
            let mut next = result.written.clone();
            add(&mut next, &result.applied, fitted);
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
fn refit(model: &mut Model, change: &DVector<f64>, sizes: &DVector<f64>) {
    if change.iter().all(|x| *x == 0.0) {
        return;
    }
    let n = model.dof;
    let mut all = DVector::zeros(change.len());
    for (number, link) in model.links.iter().enumerate() {
        all.rows_mut(RIGID * number, RIGID).copy_from_slice(&link_parameters(link));
    }
    for joint in 0..n {
        let at = RIGID * n + JOINT * joint;
        all[at] = match model.rotors() {
            Some(motors) => motors.reflected_inertia(joint),
            None => model.sensors.apparent_inertia[joint],
        };
        all[at + 1] = model.friction.viscous[joint];
        all[at + 2] = model.friction.coulomb[joint];
        all[at + 3] = model.sensors.torque_offset[joint];
    }
    let found = possible(model, &(&all + change), sizes);
    for (number, link) in model.links.iter_mut().enumerate() {
        let of = RIGID * number..RIGID * (number + 1);
        if of.clone().any(|k| found[k] != all[k]) {
            *link = link_of(&found.as_slice()[of]);
        }
    }
    for joint in 0..n {
        let at = RIGID * n + JOINT * joint;
        match model.rotors_mut() {
            Some(motors) => motors.rotor_inertia[joint] = found[at] / motors.ratio[joint].powi(2),
            None => model.sensors.apparent_inertia[joint] = found[at],
        }
        model.friction.viscous[joint] = found[at + 1];
        model.friction.coulomb[joint] = found[at + 2];
        model.sensors.torque_offset[joint] = found[at + 3];
    }
}

fn add(model: &mut Model, now: &Model, fitted: &Fitted) {
    let effect = fitted.effect;
    if effect.is_of_sensors() && fitted.joint.is_some() {
        fitted.change(model);
        return;
    }
    let dof = model.dof;
    let known = model.effects.iter().position(|of| of.id == effect.id);
    let at = known.unwrap_or_else(|| {
        model.effects.push(empty(effect, dof));
        model.effects.len() - 1
    });
    if effect.is_load() {
        carry(model, at, fitted);
        return;
    }
    for (parameter, value) in effect.parameters.iter().zip(&fitted.parameters) {
        let value = value.clamp(parameter.bounds[0], parameter.bounds[1]);
        // As much as there is may be gone.
        let joint = fitted.joint.unwrap_or(0);
        let there = parameter.there.and_then(|there| there(now, joint)).unwrap_or(f64::INFINITY);
        let value = value.max(-there);
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

impl Fitted {
    /// Changes the numbers of a model, as far as there is something.
    fn change(&self, model: &mut Model) {
        let (Form::Model(change), Some(joint)) = (&self.effect.form, self.joint) else { return };
        let least = self.effect.parameters.iter().map(|of| {
            let there = of.there.and_then(|there| there(model, joint));
            there.map_or(f64::NEG_INFINITY, |there| -there)
        });
        let values = self.coordinates.iter().zip(least).map(|(value, least)| value.max(least));
        change(model, joint, &values.collect::<Vec<_>>());
    }
}

/// Adds a load to what is carried: masses and moments add up, centres do not.
fn carry(model: &mut Model, at: usize, fitted: &Fitted) {
    let effect = fitted.effect;
    let carried = |name: &str| {
        let listed = model.effects[at].values.iter().find(|(of, _)| of == name);
        listed.map_or(0.0, |(_, given)| if let Given::Robot(value) = given { *value } else { 0.0 })
    };
    let carried: Vec<f64> = effect.parameters.iter().map(|of| carried(of.name)).collect();
    let carried = effect.coordinates_of(&carried);
    let both: Vec<f64> = carried.iter().zip(&fitted.coordinates).map(|(a, b)| a + b).collect();
    let both = possible_load(model, effect, &effect.parameters_of(&both));
    model.effects[at].values = effect
        .parameters
        .iter()
        .zip(both)
        .map(|(parameter, value)| (parameter.name.to_owned(), Given::Robot(value)))
        .collect();
}

fn empty(effect: &Effect, dof: usize) -> EffectParameters {
    let given = match effect.scope {
        Scope::Robot => Given::Robot(0.0),
        Scope::Joint => Given::Joints(vec![0.0; dof]),
    };
    let values = effect.parameters.iter().map(|p| (p.name.to_owned(), given.clone())).collect();
    EffectParameters { id: effect.id.to_owned(), values, place: "diagnosis".to_owned() }
}
