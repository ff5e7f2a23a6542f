//! What the effects of a robot file change in its model.

use nalgebra::{Matrix3, Vector3};

use super::effect::EffectParameters;
use super::error::RobotError;
use super::friction::Stribeck;
use super::link::Link;
use super::model::Model;

/// Joint 6, from 0: its motor turns with axis 5 as well.
const SIXTH: usize = 5;
/// Speed of a Stribeck law at joints that have none of it \[rad/s\].
const ANY_SPEED: f64 = 1.0;

impl EffectParameters {
    /// Adds the effect to the model.
    ///
    /// # Errors
    /// The model lacks what the effect changes, or the change leads to a value that no robot
    /// has.
    pub(super) fn apply(&self, model: &mut Model) -> Result<(), RobotError> {
        let dof = model.dof;
        let zeros = || vec![0.0; dof];
        match self.id.as_str() {
            "friction_level" => {
                self.add("coulomb", &mut model.friction.coulomb)?;
                self.add("viscous", &mut model.friction.viscous)
            }
            "stribeck" => {
                let law = model.friction.stribeck.get_or_insert_with(|| Stribeck {
                    stiction: vec![0.0; dof],
                    velocity: vec![0.0; dof],
                });
                self.change("stiction", &mut law.stiction);
                self.change("velocity", &mut law.velocity);
                for (stiction, velocity) in law.stiction.iter().zip(&mut law.velocity) {
                    if *stiction == 0.0 && *velocity == 0.0 {
                        *velocity = ANY_SPEED;
                    }
                    if *velocity <= 0.0 {
                        return Err(self.wrong("velocity", *velocity, "more than 0"));
                    }
                }
                Ok(())
            }
            "viscous_asymmetry" => {
                let law = model.friction.viscous_asymmetry.get_or_insert_with(zeros);
                self.change("asymmetry", law);
                Ok(())
            }
            "load_friction" => {
                self.add("mu", model.friction.load_friction.get_or_insert_with(zeros))
            }
            "rotor_inertia" => self.add_rotors(model, self.of("inertia").unwrap_or_default()),
            "wrist_coupling" => self.couple(model),
            "payload" => self.carry(model),
            "copper_loss" => match &mut model.motors {
                Some(motors) => self.add("loss", &mut motors.loss_constant),
                None => Err(self.needs("[motors]")),
            },
            "base_load" => self.add_power(&mut model.drive.base_w),
            "brake_power" => match &mut model.brakes {
                Some(brakes) => self.add_power(&mut brakes.power_released_w),
                None => Err(self.needs("[brakes]")),
            },
            "no_regeneration" => {
                model.drive.regeneration = 0.0;
                Ok(())
            }
            "encoder_offset" => {
                self.change("offset", &mut model.sensors.position_offset);
                Ok(())
            }
            "torque_offset" => {
                self.change("offset", &mut model.sensors.torque_offset);
                Ok(())
            }
            "apparent_torque" => {
                self.change("inertia", &mut model.sensors.apparent_inertia);
                self.change("viscous", &mut model.sensors.apparent_viscous);
                Ok(())
            }
            "torque_constant" => {
                self.change("error", &mut model.sensors.torque_error);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Adds a parameter to a value of each joint.
    fn change(&self, name: &str, values: &mut [f64]) {
        for (value, change) in values.iter_mut().zip(self.of(name).unwrap_or_default()) {
            *value += change;
        }
    }

    /// The same where the sums have to be 0 or more.
    fn add(&self, name: &str, values: &mut [f64]) -> Result<(), RobotError> {
        self.change(name, values);
        match values.iter().find(|value| **value < 0.0) {
            Some(value) => Err(self.wrong(name, *value, "0 or more")),
            None => Ok(()),
        }
    }

    fn add_power(&self, power: &mut f64) -> Result<(), RobotError> {
        self.change("power", std::slice::from_mut(power));
        if *power < 0.0 { Err(self.wrong("power", *power, "0 or more")) } else { Ok(()) }
    }

    /// Inertias of rotors, as seen at the joints.
    fn add_rotors(&self, model: &mut Model, at_joints: &[f64]) -> Result<(), RobotError> {
        let Some(motors) = &mut model.motors else { return Err(self.needs("[motors]")) };
        let rotors = motors.rotor_inertia.iter_mut().zip(&motors.ratio);
        for ((rotor, ratio), change) in rotors.zip(at_joints) {
            *rotor += change / (ratio * ratio);
            if *rotor < 0.0 {
                return Err(self.wrong("inertia", *rotor * ratio * ratio, "0 or more"));
            }
        }
        Ok(())
    }

    fn couple(&self, model: &mut Model) -> Result<(), RobotError> {
        if model.dof != SIXTH + 1 {
            return Err(self.needs("six joints"));
        }
        model.wrist.coupling += self.number("coupling");
        let friction = &mut model.friction;
        for (name, value) in
            [("coulomb", &mut friction.coulomb[SIXTH]), ("viscous", &mut friction.viscous[SIXTH])]
        {
            *value += self.number(name);
            if *value < 0.0 {
                return Err(self.wrong(name, *value, "0 or more"));
            }
        }
        if self.number("inertia") == 0.0 {
            return Ok(());
        }
        let mut inertia = [0.0; SIXTH + 1];
        inertia[SIXTH] = self.number("inertia");
        self.add_rotors(model, &inertia)
    }

    /// A point mass in tool0, more or less.
    fn carry(&self, model: &mut Model) -> Result<(), RobotError> {
        let Some(last) = model.links.last_mut() else { return Err(self.needs("[[link]]")) };
        let [mass, x, y, z] = ["mass", "com_x", "com_y", "com_z"].map(|name| self.number(name));
        let point = Link { mass, com: Vector3::new(x, y, z), inertia: Matrix3::zeros() };
        let sum = last.joined(&point.placed(&model.kinematics.flange));
        if last.mass + mass <= 0.0 || !sum.is_consistent() {
            let must = "a load that leaves the last link a body";
            return Err(self.wrong("mass", mass, must));
        }
        *last = sum;
        Ok(())
    }

    fn wrong(&self, name: &str, value: f64, must: &str) -> RobotError {
        RobotError::Value {
            place: self.place.clone(),
            key: format!("effects.{}: with it, {name}", self.id),
            value: value.to_string(),
            must: must.to_owned(),
        }
    }

    fn needs(&self, what: &str) -> RobotError {
        RobotError::Missing {
            place: self.place.clone(),
            table: "the robot".into(),
            key: format!("{what} (for effects.{})", self.id),
            instead: None,
        }
    }
}
