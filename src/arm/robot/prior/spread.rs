//! How well the numbers of a model are known, and robots that are as plausible.

use nalgebra::Vector3;
use rayon::prelude::*;

use super::hypercube::standard_normals;
use super::known::{Known, type_name};
use super::rules;
use super::skeleton;
use crate::arm::robot::calibration::Calibration;
use crate::arm::robot::effect::Given;
use crate::arm::robot::error::RobotError;
use crate::arm::robot::geometry::Coupling;
use crate::arm::robot::link::Link;
use crate::arm::robot::model::Model;
use crate::arm::robot::provenance::Provenance;

/// Standard deviations of the logarithm of the masses of links, before they are brought to the mass
/// that moves, of the first three and of those behind, and of their moments of inertia. With the
/// deviation of the centres they give about the deviations that moments of gravity and inertia have between
/// meshes and makers' masses: 0.13 and 0.20 about axes 2 and 3, 0.14 to 0.25 of inertias.
const LINK_MASS: [f64; 2] = [0.18, 0.33];
const LINK_INERTIA: f64 = 0.35;
/// The same of links that follow from the axes alone; and the power of the way that is left to the flange
/// by which all links vary together. All four are the deviations of ABB's meshes from the rule times 1.3,
/// which the bodies of 17 arms of seven other makers ask for (docs/robots.md).
const AXES_LINK_MASS: [f64; 2] = [0.33, 0.78];
const TILT: f64 = 0.21;
/// The same where the payload is not known, which the rule asks for.
const TILT_WITHOUT_PAYLOAD: f64 = 0.34;
/// Standard deviation of a centre of mass over the distance of the joints.
const CENTRE: f64 = 0.03;
/// Deviation of the logarithm of the masses of links 2 and 3 by the rods beside them, which share the
/// weight of the forearm and its motor otherwise than a serial arm does; chosen.
const RODS: f64 = 0.15;
/// The shortest such distance over the length of the arm.
const SHORTEST: f64 = 0.1;
/// Deviation of the logarithm of the mass that moves, beside that of the total mass.
const MOVING: f64 = 0.05;
const AXES_MOVING: f64 = 0.10;
/// The same of centres that follow from the axes alone.
const AXES_CENTRE: f64 = 0.065;
/// Part of a deviation that is left of one that a paper states, or an identification without its own
/// deviations; chosen.
const PAPER: f64 = 0.3;
const IDENTIFIED: f64 = 0.15;
/// Draws start here.
const SEED: u64 = 27;

/// What one latent number changes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    AllMasses,
    Mass(usize),
    Centre(usize, usize),
    Inertia(usize),
    Friction(usize),
    Coulomb(usize),
    Viscous(usize),
    Rotor(usize),
    Loss(usize),
    Standby,
    Coils,
    Release,
    Spring,
}

/// A standard normal number that stands for something that is not known.
#[derive(Clone, Debug)]
pub struct Latent {
    /// What it is, as reports name it.
    pub group: String,
    /// The group, with a number where it has several: `masses of link 2, 3`.
    pub name: String,
    /// What it changes, and by how much: standard deviations of logarithms, or m.
    terms: Vec<(Target, f64)>,
}

/// How well a model is known.
#[derive(Clone, Debug)]
pub struct Spread {
    /// What is not known, each independent of the others.
    pub latents: Vec<Latent>,
    /// Whether the masses of the links add up to a sum that is known better.
    shared_mass: bool,
}

/// Robots that are as plausible as the model.
#[derive(Clone, Debug)]
pub struct Draws {
    /// The latent numbers: `[latent][draw]`.
    pub latents: Vec<Vec<f64>>,
    /// The robots.
    pub robots: Vec<Plausible>,
}

/// What differs from the model in a plausible robot.
#[derive(Clone, Debug)]
pub struct Plausible {
    /// Bodies in the joints' frames.
    pub links: Vec<Link>,
    /// Nm.
    pub coulomb: Vec<f64>,
    /// Nm s/rad.
    pub viscous: Vec<f64>,
    /// Inertia of the rotors at the joints \[kg m²\].
    pub rotors: Vec<f64>,
    /// Copper loss over squared torque at the joints \[W/(Nm)²\].
    pub loss: Vec<f64>,
    /// W.
    pub base_w: f64,
    /// Power of the coils of open brakes \[W\].
    pub coils_w: f64,
    /// J.
    pub release_j: f64,
    /// Torques of springs over those of the model.
    pub spring: f64,
}

impl Spread {
    /// Of a model with dynamics, by the provenance of its numbers and the deviations that it states.
    #[must_use]
    pub fn of(model: &Model) -> Spread {
        let known = Known::of(model);
        let mut latents = Vec::new();
        let mut add = |group: &str, terms: Vec<(Target, f64)>| {
            let terms: Vec<(Target, f64)> = terms.into_iter().filter(|(_, sd)| *sd > 0.0).collect();
            if !terms.is_empty() {
                let before = latents.iter().filter(|known: &&Latent| known.group == group).count();
                let name = match before {
                    0 => group.to_owned(),
                    n => format!("{group}, {}", n + 1),
                };
                latents.push(Latent { group: group.to_owned(), name, terms });
            }
        };
        let dof = model.links.len();
        let estimated = |i: usize| {
            let table = format!("link {}", i + 1);
            model.provenance_of(&table, "mass") == Some(Provenance::Estimated)
        };
        let shared_mass = (0..dof).all(estimated);
        let by_axes = shared_mass && known.links.is_empty();
        if shared_mass {
            let total = known.mass.as_ref().map_or(rules::MASS_BY_SIZE, |(_, sd, _)| *sd);
            let moving = if by_axes { AXES_MOVING } else { MOVING };
            add("total mass", vec![(Target::AllMasses, total.hypot(moving))]);
            if model.kinematics.coupling == Coupling::Parallelogram {
                let rods = [1, 2].map(|i| (Target::Mass(i), RODS)).to_vec();
                add("rods of the parallelogram", rods);
            }
            if by_axes {
                let power = if known.payload.is_some() { TILT } else { TILT_WITHOUT_PAYLOAD };
                let middles = skeleton::middles(&model.kinematics);
                let tilt = middles.iter().enumerate();
                let tilt = tilt.map(|(i, way)| (Target::Mass(i), -power * way.ln()));
                add("masses of the links towards the flange", tilt.collect());
            }
        }
        let length: f64 = model.kinematics.joints.iter().map(|j| j.translation.norm()).sum();
        for i in 0..dof {
            let table = format!("link {}", i + 1);
            let next = model.kinematics.joints.get(i + 1).map_or(0.0, |j| j.translation.norm());
            let distance = next.max(SHORTEST * length);
            let mass = stated(model, &table, "mass", 0, model.links[i].mass);
            let mass = mass.unwrap_or_else(|| {
                let rough = if by_axes {
                    AXES_LINK_MASS[usize::from(i + 2 >= dof)]
                } else {
                    LINK_MASS[usize::from(i >= 3)]
                };
                rough * looseness(model, &table, "mass")
            });
            let group = format!("masses of link {}", i + 1);
            add(&group, vec![(Target::Mass(i), mass)]);
            for axis in 0..3 {
                let own = stated(model, &table, "com", axis, 1.0);
                let centre = if by_axes { AXES_CENTRE } else { CENTRE };
                let rough = centre * distance * looseness(model, &table, "com");
                add(&group, vec![(Target::Centre(i, axis), own.unwrap_or(rough))]);
            }
            let inertia = LINK_INERTIA * looseness(model, &table, "inertia");
            add(&group, vec![(Target::Inertia(i), inertia)]);
        }
        let maker = rules::Maker::of(type_name(model));
        let size = rules::Size { mass: 1.0, reach: 1.0, payload: 1.0 };
        // What somebody measured of a joint has nothing in common with the others.
        let coulomb = |j: usize| stated(model, "friction", "coulomb", j, model.friction.coulomb[j]);
        let viscous = |j: usize| stated(model, "friction", "viscous", j, model.friction.viscous[j]);
        let rough = |j: usize| match coulomb(j) {
            Some(_) => 0.0,
            None => size.friction(maker, j, dof).sd * looseness(model, "friction", "coulomb"),
        };
        let (common, own) = parted(rules::common_friction(maker));
        let all = (0..dof).map(|j| (Target::Friction(j), common * rough(j))).collect();
        add("friction of all joints", all);
        for j in 0..dof {
            let group = format!("friction of joint {}", j + 1);
            match (coulomb(j), viscous(j)) {
                (None, None) => {
                    add(&group, vec![(Target::Friction(j), own * rough(j))]);
                    let share = rules::COULOMB_SD * looseness(model, "friction", "coulomb");
                    add(&group, vec![(Target::Coulomb(j), share)]);
                }
                (coulomb, viscous) => {
                    let either = coulomb.or(viscous).unwrap_or(0.0);
                    add(&group, vec![(Target::Coulomb(j), coulomb.unwrap_or(either))]);
                    add(&group, vec![(Target::Viscous(j), viscous.unwrap_or(either))]);
                }
            }
        }
        let (common, own) = parted(rules::COMMON_MOTORS);
        let rotor = rules::rotor(1.0).sd.hypot(2.0 * rules::ratio(1.0).sd);
        let rotor = rotor * looseness(model, "motors", "rotor_inertia");
        let loss = rules::loss(1.0).sd * looseness(model, "motors", "loss_constant");
        add("rotors", (0..dof).map(|j| (Target::Rotor(j), common * rotor)).collect());
        add("copper losses", (0..dof).map(|j| (Target::Loss(j), common * loss)).collect());
        for j in 0..dof {
            add(&format!("rotor of joint {}", j + 1), vec![(Target::Rotor(j), own * rotor)]);
            add(&format!("copper loss of joint {}", j + 1), vec![(Target::Loss(j), own * loss)]);
        }
        let given = |table: &str, key: &str, value: f64, rough: f64| {
            let own = stated(model, table, key, 0, value);
            own.unwrap_or_else(|| rough * looseness(model, table, key))
        };
        let standby = given("drive", "base_w", model.drive.base_w, size.standby().sd);
        add("base power", vec![(Target::Standby, standby)]);
        let brakes = model.brakes.as_ref();
        let coils_w = brakes.map_or(0.0, |brakes| brakes.power_released_w);
        let coils = given("brakes", "power_released_w", coils_w, size.coils().sd);
        add("brake coils", vec![(Target::Coils, coils)]);
        let release_j = brakes.map_or(0.0, |brakes| brakes.energy_per_release_j);
        let release = given("brakes", "energy_per_release_j", release_j, size.release().sd);
        add("release of the brakes", vec![(Target::Release, release)]);
        if model.effects.iter().any(|effect| effect.id == SPRING_EFFECT) {
            let sd = SPRING * looseness(model, "effects.gravity_spring", "stiffness");
            add("balancer of axis 2", vec![(Target::Spring, sd)]);
        }
        Spread { latents, shared_mass }
    }

    /// So many plausible robots, the same each time; of a calibrated robot those that fit its log.
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

    /// The draws of a calibration; what it does not name is as it is.
    fn calibrated(&self, calibration: &Calibration) -> Vec<Vec<f64>> {
        let of = |latent: &Latent| {
            let found = calibration.draws.iter().find(|(name, _)| *name == latent.name);
            found.map_or_else(|| vec![0.0; calibration.robots], |(_, draws)| draws.clone())
        };
        self.latents.iter().map(of).collect()
    }

    /// The robot at these latent numbers.
    pub fn robot(&self, model: &Model, z: impl Fn(usize) -> f64) -> Plausible {
        let dof = model.links.len();
        let mut robot = Plausible::of(model);
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

/// Standard deviation of the logarithm of what a balancer carries.
const SPRING: f64 = 0.3;
const SPRING_EFFECT: &str = "gravity_spring";

/// A calibration that names what the spread of its robot does not have belongs to another one.
///
/// # Errors
/// It does.
pub fn check_calibration(model: &Model) -> Result<(), RobotError> {
    let Some(calibration) = &model.calibration else { return Ok(()) };
    let known: Vec<String> = Spread::of(model).latents.into_iter().map(|l| l.name).collect();
    match calibration.draws.iter().find(|(name, _)| !known.contains(name)) {
        Some((name, _)) => Err(RobotError::UnknownKey {
            place: calibration.place.clone(),
            key: name.clone(),
            table: "[calibration.draws]".into(),
            known,
        }),
        None => Ok(()),
    }
}

/// Deviations of the part that all have in common, and of the own one, for a share of the variance.
fn parted(common: f64) -> (f64, f64) {
    (common.sqrt(), (1.0 - common).sqrt())
}

/// The deviation that a file states of one number of a list, over `scale`; of an estimate none, whose
/// deviations are made of parts.
fn stated(model: &Model, table: &str, key: &str, index: usize, scale: f64) -> Option<f64> {
    let origin = model.origin_of(table, key)?;
    let sd = origin.sd.as_ref().filter(|_| origin.provenance != Some(Provenance::Estimated))?;
    let sd = sd.get(index).or(sd.first())?;
    (scale > 0.0).then(|| sd / scale)
}

/// Standard deviation of a logarithm beyond which nothing is known.
const UNKNOWN: f64 = 3.0;

/// A deviation of many times its figure says nothing of it, and sums over robots have no end.
///
/// # Errors
/// There is one.
pub fn check_deviations(model: &Model) -> Result<(), RobotError> {
    let is_scaled = |target: &Target| !matches!(target, Target::Centre(..));
    let spread = Spread::of(model);
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

/// How much of the deviation of an estimate a number has.
fn looseness(model: &Model, table: &str, key: &str) -> f64 {
    match model.provenance_of(table, key) {
        Some(Provenance::Estimated | Provenance::Assumed) => 1.0,
        Some(Provenance::Paper) | None => PAPER,
        Some(Provenance::Identified) => IDENTIFIED,
        Some(Provenance::Datasheet) => 0.0,
    }
}

impl Plausible {
    /// The model with these numbers. What its effects do is worked out anew from the changed ones
    /// (`effects::applied`).
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
    pub fn of(model: &Model) -> Plausible {
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
