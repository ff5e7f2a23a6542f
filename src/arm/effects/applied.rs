//! Robot files with effects.

use crate::arm::robot::prior::Plausible;
use crate::arm::robot::{self, EffectParameters, Given, Law, Model, RobotError, nearest};

use super::effect::{Effect, Form, Parameter, Scope, padded};
use super::motion::Motion;
use super::register::{ALL, find};

/// The robot of a file or of the catalogue with its effects.
///
/// # Errors
/// As for [`robot::load`]; an effect is unknown or its result is impossible.
pub fn load(name_or_path: &str) -> Result<Model, RobotError> {
    applied(robot::load(name_or_path)?)
}

/// The same with estimates for unknown numbers of an arm.
///
/// # Errors
/// As for [`load`].
pub fn load_estimated(name_or_path: &str) -> Result<Model, RobotError> {
    with_estimates(robot::load(name_or_path)?)
}

/// A model with estimates for unknown numbers of an arm and with its effects.
///
/// # Errors
/// An effect is unknown, or its result or the stated mass is impossible.
pub fn with_estimates(model: Model) -> Result<Model, RobotError> {
    robot::prior::check_mass(&model)?;
    let model = applied(robot::prior::estimated(model))?;
    robot::prior::check_deviations(&model)?;
    robot::prior::check_calibration(&model)?;
    Ok(model)
}

/// A plausible robot as a model.
///
/// # Errors
/// The result of its effects is impossible.
pub fn drawn(model: &Model, robot: &Plausible) -> Result<Model, RobotError> {
    // The laws depend on the effects and are computed again.
    applied(Model { laws: Vec::new(), ..robot.applied(model) })
}

/// The robot of a Robot TOML text with its effects; `file` is its name in messages.
///
/// # Errors
/// As for [`load`].
pub fn from_toml(file: &str, text: &str) -> Result<Model, RobotError> {
    applied(robot::from_toml(file, text)?)
}

/// Applies the effects of a model to its numbers and laws; effects that are not numbers of the
/// model stay in its list.
///
/// # Errors
/// An effect is unknown or its result is impossible.
pub fn applied(mut model: Model) -> Result<Model, RobotError> {
    let mut kept = Vec::new();
    for given in std::mem::take(&mut model.effects) {
        let effect = find(&given.id).ok_or_else(|| unknown(&given))?;
        check_names(effect, &given, model.dof)?;
        for joint in (effect.joints)(model.dof) {
            let Some(coordinates) = coordinates(effect, &given, joint) else { continue };
            match effect.form {
                Form::Model(change) => change(&mut model, joint, &coordinates),
                Form::Law { dissipates, torque } => {
                    let values = padded(&coordinates);
                    model.laws.push(Law { joint, values, dissipates, torque });
                }
                Form::Series(_) | Form::Timing(_) | Form::Elsewhere => {}
            }
            if effect.scope == Scope::Robot {
                break;
            }
        }
        check_bounds(effect, &given, model.dof)?;
        check_model(&model, &given)?;
        if !matches!(effect.form, Form::Model(_)) {
            kept.push(given);
        }
    }
    // After the other effects, which change the Coulomb friction.
    kept.iter().try_for_each(|given| check_breakaway(&model, given))?;
    model.effects = kept;
    Ok(model)
}

/// Additional logged torques of effects of the whole motion, per joint \[Nm\].
#[must_use]
pub fn of_the_whole_motion(motion: &Motion<'_>) -> Vec<Vec<f64>> {
    let model = motion.model;
    let mut sum = vec![vec![0.0; motion.rows()]; model.dof];
    for given in &model.effects {
        let Some(effect) = find(&given.id) else { continue };
        if !matches!(effect.form, Form::Series(_)) {
            continue;
        }
        for joint in (effect.joints)(model.dof) {
            let Some(coordinates) = coordinates(effect, given, joint) else { continue };
            for (to, added) in effect.added(motion, joint, &coordinates) {
                sum[to].iter_mut().zip(added).for_each(|(sum, x)| *sum += x);
            }
            // An effect of the robot occurs once, not per joint.
            if effect.scope == Scope::Robot {
                break;
            }
        }
    }
    sum
}

/// Coordinates of an effect at a joint; `None` if the joint does not have it.
fn coordinates(effect: &Effect, given: &EffectParameters, joint: usize) -> Option<Vec<f64>> {
    let parameters: Vec<f64> =
        effect.parameters.iter().map(|parameter| value(given, parameter.name, joint)).collect();
    let named = effect.scope == Scope::Robot || parameters.iter().any(|value| *value != 0.0);
    named.then(|| effect.coordinates_of(&parameters))
}

fn unknown(given: &EffectParameters) -> RobotError {
    let ids = ALL.iter().map(|effect| effect.id);
    RobotError::Effect {
        place: given.place.clone(),
        id: given.id.clone(),
        suggestion: nearest(&given.id, ids.clone()).map(str::to_owned),
        known: ids.map(str::to_owned).collect(),
    }
}

fn check_names(effect: &Effect, given: &EffectParameters, dof: usize) -> Result<(), RobotError> {
    for (name, values) in &given.values {
        let key = format!("effects.{}.{name}", given.id);
        if effect.parameters.iter().all(|parameter| parameter.name != name) {
            return Err(RobotError::UnknownKey {
                place: given.place.clone(),
                key: name.clone(),
                table: format!("[effects.{}]", given.id),
                known: effect.parameters.iter().map(|p| p.name.to_owned()).collect(),
            });
        }
        let (found, expected) = match (effect.scope, values) {
            (Scope::Joint, Given::Robot(_)) => {
                ("a number".to_owned(), format!("{dof}, one for each joint, or `joint`"))
            }
            (Scope::Robot, Given::Joints(_)) => ("of joints".to_owned(), "a number".to_owned()),
            _ => continue,
        };
        return Err(RobotError::Type { place: given.place.clone(), key, found, expected });
    }
    Ok(())
}

fn check_bounds(effect: &Effect, given: &EffectParameters, dof: usize) -> Result<(), RobotError> {
    for joint in (effect.joints)(dof) {
        // All 0: a joint without the effect.
        let named = |p: &&Parameter| value(given, p.name, joint) != 0.0;
        if effect.parameters.iter().all(|p| !named(&p)) {
            continue;
        }
        for parameter in effect.parameters {
            let [low, high] = parameter.bounds;
            let value = value(given, parameter.name, joint);
            if !(low..=high).contains(&value) {
                let must = if high.is_finite() {
                    format!("from {low} to {high}")
                } else {
                    format!("{low} or more")
                };
                return Err(wrong(given, parameter.name, value, &must));
            }
        }
    }
    Ok(())
}

/// Rejects negative friction at breakaway, which would drive the joint.
fn check_breakaway(model: &Model, given: &EffectParameters) -> Result<(), RobotError> {
    if given.id != "stribeck" {
        return Ok(());
    }
    for (joint, coulomb) in model.friction.coulomb.iter().enumerate() {
        let stiction = value(given, "stiction", joint);
        if stiction < -coulomb {
            let least = format!(
                "{} or more, no less than the Coulomb friction of joint {}",
                -coulomb,
                joint + 1
            );
            return Err(wrong(given, "stiction", stiction, &least));
        }
    }
    Ok(())
}

/// The given value of a parameter at a joint; 0 without one.
fn value(given: &EffectParameters, name: &str, joint: usize) -> f64 {
    let found = given.values.iter().find(|(known, _)| known == name);
    found.map_or(0.0, |(_, given)| match given {
        Given::Robot(value) => *value,
        Given::Joints(list) => list.get(joint).copied().unwrap_or(0.0),
    })
}

/// Rejects impossible numbers.
fn check_model(model: &Model, given: &EffectParameters) -> Result<(), RobotError> {
    let friction = &model.friction;
    for (name, list) in [("coulomb", &friction.coulomb), ("viscous", &friction.viscous)] {
        if let Some(value) = list.iter().find(|value| **value < 0.0) {
            return Err(wrong(given, name, *value, "0 or more"));
        }
    }
    if let Some(motors) = &model.motors {
        for (joint, rotor) in motors.rotor_inertia.iter().enumerate() {
            if *rotor < 0.0 {
                return Err(wrong(given, "inertia", motors.reflected_inertia(joint), "0 or more"));
            }
        }
    }
    if let Some(last) = model.links.last()
        && given.id == "payload"
        && !(last.mass > 0.0 && last.is_consistent())
    {
        let must = "a load that leaves the last link a body";
        return Err(wrong(given, "mass", value(given, "mass", 0), must));
    }
    if model.drive.base_w < 0.0 {
        return Err(wrong(given, "power", model.drive.base_w, "0 or more"));
    }
    Ok(())
}

fn wrong(given: &EffectParameters, name: &str, value: f64, must: &str) -> RobotError {
    RobotError::Value {
        place: given.place.clone(),
        key: format!("effects.{}: with it, {name}", given.id),
        value: value.to_string(),
        must: must.to_owned(),
    }
}
