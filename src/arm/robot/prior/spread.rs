//! The prior of the numbers of a model, and draws of plausible robots.

use nalgebra::Vector3;
use rayon::prelude::*;

use super::hypercube::standard_normals;
use super::latents::{Latent, SPRING_EFFECT, Target, has_shared_mass, latents};
use crate::arm::robot::calibration::Calibration;
use crate::arm::robot::effect::Given;
use crate::arm::robot::error::RobotError;
use crate::arm::robot::link::Link;
use crate::arm::robot::model::Model;

/// Seed of the draws.
const SEED: u64 = 27;

/// The prior of the numbers of a model.
#[derive(Clone, Debug)]
pub struct Spread {
    /// Independent unknowns.
    pub latents: Vec<Latent>,
    /// Whether the sum of the link masses is known better than each.
    shared_mass: bool,
}

/// Draws of plausible robots.
#[derive(Clone, Debug)]
pub struct Draws {
    /// The latent variables: `[latent][draw]`.
    pub latents: Vec<Vec<f64>>,
    /// The robots.
    pub robots: Vec<Plausible>,
}

/// The numbers of a plausible robot that may differ from the model.
#[derive(Clone, Debug)]
pub struct Plausible {
    /// Links in the joint frames.
    pub links: Vec<Link>,
    /// Coulomb friction \[Nm\].
    pub coulomb: Vec<f64>,
    /// Viscous friction \[Nm s/rad\].
    pub viscous: Vec<f64>,
    /// Inertia of the rotors at the joints \[kg m²\].
    pub rotors: Vec<f64>,
    /// Copper loss over squared torque at the joints \[W/(Nm)²\].
    pub loss: Vec<f64>,
    /// Base power \[W\].
    pub base_w: f64,
    /// Power of the coils of released brakes \[W\].
    pub coils_w: f64,
    /// Energy of one brake release \[J\].
    pub release_j: f64,
    /// Spring torques relative to those of the model.
    pub spring: f64,
}

impl Spread {
    /// The prior of a model with dynamics, from the provenance and the stated deviations of its
    /// numbers.
    #[must_use]
    pub fn new(model: &Model) -> Spread {
        Spread { latents: latents(model), shared_mass: has_shared_mass(model) }
    }

    /// `count` plausible robots, reproducible; for a calibrated robot the draws of its calibration.
    #[must_use]
    pub fn draws(&self, model: &Model, count: usize) -> Draws {
        let latents = match &model.calibration {
            Some(calibration) => self.calibrated(calibration),
            None => standard_normals(self.latents.len(), count, SEED),
        };
        let count = latents.first().map_or(0, Vec::len);
        let robots = (0..count)
            .into_par_iter()
            .map(|draw| self.robot(model, |k| latents[k][draw]))
            .collect();
        Draws { latents, robots }
    }

    /// The draws of a calibration; latent variables that it does not name are 0.
    fn calibrated(&self, calibration: &Calibration) -> Vec<Vec<f64>> {
        let draws_of = |latent: &Latent| {
            let found = calibration.draws.iter().find(|(name, _)| *name == latent.name);
            found.map_or_else(|| vec![0.0; calibration.robots], |(_, draws)| draws.clone())
        };
        self.latents.iter().map(draws_of).collect()
    }

    /// The robot at these latent variables.
    pub fn robot(&self, model: &Model, z: impl Fn(usize) -> f64) -> Plausible {
        let dof = model.links.len();
        let mut robot = Plausible::nominal(model);
        let mut all = 1.0;
        let mut centres = vec![Vector3::zeros(); dof];
        for (k, latent) in self.latents.iter().enumerate() {
            for (target, sd) in &latent.terms {
                let factor = (sd * z(k)).exp();
                match *target {
                    Target::AllMasses => all *= factor,
                    Target::Mass(i) => {
                        robot.links[i].mass *= factor;
                        robot.links[i].inertia *= factor;
                    }
                    Target::Centre(i, axis) => centres[i][axis] += sd * z(k),
                    Target::Inertia(i) => robot.links[i].inertia *= factor,
                    Target::Friction(j) => {
                        robot.coulomb[j] *= factor;
                        robot.viscous[j] *= factor;
                    }
                    Target::Coulomb(j) => robot.coulomb[j] *= factor,
                    Target::Viscous(j) => robot.viscous[j] *= factor,
                    Target::Rotor(j) => robot.rotors[j] *= factor,
                    Target::Loss(j) => robot.loss[j] *= factor,
                    Target::Standby => robot.base_w *= factor,
                    Target::Coils => robot.coils_w *= factor,
                    Target::Release => robot.release_j *= factor,
                    Target::Spring => robot.spring *= factor,
                }
            }
        }
        if self.shared_mass {
            let sum = |links: &[Link]| links.iter().map(|link| link.mass).sum::<f64>();
            let scale = all * sum(&model.links) / sum(&robot.links).max(f64::MIN_POSITIVE);
            for link in &mut robot.links {
                link.mass *= scale;
                link.inertia *= scale;
            }
        }
        for (link, shift) in robot.links.iter_mut().zip(centres) {
            link.com += shift;
        }
        robot
    }
}

/// Checks that a calibration belongs to the robot: all its latent variables exist.
///
/// # Errors
/// A latent variable is missing.
pub fn check_calibration(model: &Model) -> Result<(), RobotError> {
    let Some(calibration) = &model.calibration else { return Ok(()) };
    let known: Vec<String> = Spread::new(model).latents.into_iter().map(|l| l.name).collect();
    let unknown = calibration.draws.iter().find(|(name, _)| !known.contains(name));
    let Some((name, _)) = unknown else { return Ok(()) };
    Err(RobotError::UnknownKey {
        place: calibration.place.clone(),
        key: name.clone(),
        table: "[calibration.draws]".into(),
        known,
    })
}

/// Largest standard deviation of a logarithm.
const UNKNOWN: f64 = 3.0;

/// Checks the standard deviations: with very large ones, means over robots do not converge.
///
/// # Errors
/// One is too large.
pub fn check_deviations(model: &Model) -> Result<(), RobotError> {
    let is_scaled = |target: &Target| !matches!(target, Target::Centre(..));
    let spread = Spread::new(model);
    let mut terms = spread.latents.iter().flat_map(|latent| {
        latent.terms.iter().map(|(target, sd)| (latent.group.as_str(), target, *sd))
    });
    match terms.find(|(_, target, sd)| is_scaled(target) && *sd > UNKNOWN) {
        Some((group, _, sd)) => Err(RobotError::Value {
            place: model.file.clone().unwrap_or_else(|| model.name.clone()),
            key: format!("standard deviation of the {group}"),
            value: format!("{sd:.3} times the figure"),
            must: format!(
                "at most {UNKNOWN} times the figure; leave figure and deviation out if nothing is known"
            ),
        }),
        None => Ok(()),
    }
}

impl Plausible {
    /// The model with these numbers; its effects must be applied again (`effects::applied`).
    #[must_use]
    pub fn applied(&self, model: &Model) -> Model {
        let mut new = model.clone();
        new.links.clone_from(&self.links);
        new.friction.coulomb.clone_from(&self.coulomb);
        new.friction.viscous.clone_from(&self.viscous);
        if let Some(motors) = &mut new.motors {
            let rotors = self.rotors.iter().zip(&motors.ratio);
            motors.rotor_inertia = rotors.map(|(inertia, n)| inertia / (n * n)).collect();
            motors.loss_constant.clone_from(&self.loss);
        }
        new.drive.base_w = self.base_w;
        for effect in new.effects.iter_mut().filter(|effect| effect.id == SPRING_EFFECT) {
            for (_, given) in effect.values.iter_mut().filter(|(name, _)| name == "stiffness") {
                match given {
                    Given::Robot(value) => *value *= self.spring,
                    Given::Joints(values) => values.iter_mut().for_each(|x| *x *= self.spring),
                }
            }
        }
        if let Some(brakes) = &mut new.brakes {
            brakes.power_released_w = self.coils_w;
            brakes.energy_per_release_j = self.release_j;
        }
        new
    }

    /// The model itself.
    #[must_use]
    pub fn nominal(model: &Model) -> Plausible {
        let motors = model.motors.as_ref();
        let by_joint = |value: &dyn Fn(usize) -> f64| (0..model.dof).map(value).collect();
        Plausible {
            links: model.links.clone(),
            coulomb: model.friction.coulomb.clone(),
            viscous: model.friction.viscous.clone(),
            rotors: by_joint(&|j| motors.map_or(0.0, |m| m.reflected_inertia(j))),
            loss: by_joint(&|j| motors.map_or(0.0, |m| m.loss_constant[j])),
            base_w: model.drive.base_w,
            coils_w: model.brakes.as_ref().map_or(0.0, |brakes| brakes.power_released_w),
            release_j: model.brakes.as_ref().map_or(0.0, |brakes| brakes.energy_per_release_j),
            spring: 1.0,
        }
    }
}
