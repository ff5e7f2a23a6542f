//! The unknowns of a model: independent latent variables and their effects.

use super::known::{Known, type_name};
use super::rules::{self, Maker, Size};
use super::skeleton;
use crate::arm::robot::geometry::Coupling;
use crate::arm::robot::model::Model;
use crate::arm::robot::provenance::Provenance;

/// Standard deviations of the logarithms of the link masses (first three, then outer ones) before
/// they are scaled to the moving mass, and of the moments of inertia. Together with the deviation
/// of the centres they reproduce the deviations between meshes and published masses: 0.13 and 0.20
/// for gravity moments about axes 2 and 3, 0.14 to 0.25 for inertias.
const LINK_MASS: [f64; 2] = [0.18, 0.33];
const LINK_INERTIA: f64 = 0.35;
/// The same for links estimated from the axes alone, and the exponent of the remaining path length
/// by which all links vary together. All are the deviations of ABB meshes from the rule times 1.3,
/// as needed for 17 arms of seven other makers (docs/robots.md).
const AXES_LINK_MASS: [f64; 2] = [0.33, 0.78];
const TILT: f64 = 0.21;
/// The same if the payload, an input of the rule, is unknown.
const TILT_WITHOUT_PAYLOAD: f64 = 0.34;
/// Standard deviation of a centre of mass relative to the joint distance.
const CENTRE: f64 = 0.03;
/// Deviation of the logarithm of the masses of links 2 and 3 of a parallelogram robot, whose rods
/// carry a part of the forearm and its motor; assumed.
const RODS: f64 = 0.15;
/// Smallest joint distance for this, relative to the arm length.
const SHORTEST: f64 = 0.1;
/// Deviation of the logarithm of the moving mass, in addition to that of the total mass.
const MOVING: f64 = 0.05;
const AXES_MOVING: f64 = 0.10;
/// Deviation of centres estimated from the axes alone.
const AXES_CENTRE: f64 = 0.065;
/// Factor on the deviation of a number from a paper, or identified without stated deviations;
/// assumed.
const PAPER: f64 = 0.3;
const IDENTIFIED: f64 = 0.15;
/// Standard deviation of the logarithm of the balancer torque.
const SPRING: f64 = 0.3;
/// Id of the balancer effect.
pub(super) const SPRING_EFFECT: &str = "gravity_spring";

/// Deviations of logarithms do not depend on the size.
const UNIT_SIZE: Size = Size { mass: 1.0, reach: 1.0, payload: 1.0 };

/// The quantity that a latent variable changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Target {
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

/// A standard normal variable for an unknown of the robot.
#[derive(Clone, Debug)]
pub struct Latent {
    /// Name in reports.
    pub group: String,
    /// The group, numbered if it has several: `masses of link 2, 3`.
    pub name: String,
    /// Changed quantities with standard deviations, of logarithms or in m.
    pub(super) terms: Vec<(Target, f64)>,
}

/// The latent variables of a model with dynamics.
pub(super) fn latents(model: &Model) -> Vec<Latent> {
    let known = Known::from_model(model);
    let shared_mass = has_shared_mass(model);
    let by_axes = shared_mass && known.links.is_empty();
    let mut latents = Latents(Vec::new());
    if shared_mass {
        latents.total_mass(model, &known, by_axes);
    }
    latents.links(model, by_axes);
    latents.friction(model);
    latents.motors(model);
    latents.power(model);
    latents.0
}

/// Whether all link masses are estimated, so that their sum is known better than each.
pub(super) fn has_shared_mass(model: &Model) -> bool {
    let is_estimated =
        |i| model.provenance_of(&format!("link {i}"), "mass") == Some(Provenance::Estimated);
    (1..=model.links.len()).all(is_estimated)
}

struct Latents(Vec<Latent>);

impl Latents {
    /// Adds a variable that changes the targets by these deviations; zeros are omitted.
    fn add(&mut self, group: &str, mut terms: Vec<(Target, f64)>) {
        terms.retain(|(_, sd)| *sd > 0.0);
        if terms.is_empty() {
            return;
        }
        let name = match self.0.iter().filter(|known| known.group == group).count() {
            0 => group.to_owned(),
            n => format!("{group}, {}", n + 1),
        };
        self.0.push(Latent { group: group.to_owned(), name, terms });
    }

    /// The total mass and its distribution over the links.
    fn total_mass(&mut self, model: &Model, known: &Known, by_axes: bool) {
        let total = known.mass.as_ref().map_or(rules::MASS_BY_SIZE, |(_, sd, _)| *sd);
        let moving = if by_axes { AXES_MOVING } else { MOVING };
        self.add("total mass", vec![(Target::AllMasses, total.hypot(moving))]);
        if model.kinematics.coupling == Coupling::Parallelogram {
            let rods = [1, 2].map(|i| (Target::Mass(i), RODS)).to_vec();
            self.add("rods of the parallelogram", rods);
        }
        if by_axes {
            let power = if known.payload.is_some() { TILT } else { TILT_WITHOUT_PAYLOAD };
            let middles = skeleton::middles(&model.kinematics);
            let tilt = middles.iter().enumerate();
            let tilt = tilt.map(|(i, way)| (Target::Mass(i), -power * way.ln()));
            self.add("masses of the links towards the flange", tilt.collect());
        }
    }

    /// Mass, centre of mass and inertia of each link.
    fn links(&mut self, model: &Model, by_axes: bool) {
        let dof = model.links.len();
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
                rough * deviation_factor(model, &table, "mass")
            });
            let group = format!("masses of link {}", i + 1);
            self.add(&group, vec![(Target::Mass(i), mass)]);
            for axis in 0..3 {
                let own = stated(model, &table, "com", axis, 1.0);
                let centre = if by_axes { AXES_CENTRE } else { CENTRE };
                let rough = centre * distance * deviation_factor(model, &table, "com");
                self.add(&group, vec![(Target::Centre(i, axis), own.unwrap_or(rough))]);
            }
            let inertia = LINK_INERTIA * deviation_factor(model, &table, "inertia");
            self.add(&group, vec![(Target::Inertia(i), inertia)]);
        }
    }

    fn friction(&mut self, model: &Model) {
        let dof = model.links.len();
        let maker = Maker::from_name(type_name(model));
        // Measured values of a joint are independent of the other joints.
        let coulomb = |j: usize| stated(model, "friction", "coulomb", j, model.friction.coulomb[j]);
        let viscous = |j: usize| stated(model, "friction", "viscous", j, model.friction.viscous[j]);
        let rough = |j: usize| match coulomb(j) {
            Some(_) => 0.0,
            None => {
                UNIT_SIZE.friction(maker, j, dof).sd
                    * deviation_factor(model, "friction", "coulomb")
            }
        };
        let (common, own) = split_deviation(rules::common_friction(maker));
        let all = (0..dof).map(|j| (Target::Friction(j), common * rough(j))).collect();
        self.add("friction of all joints", all);
        for j in 0..dof {
            let group = format!("friction of joint {}", j + 1);
            match (coulomb(j), viscous(j)) {
                (None, None) => {
                    self.add(&group, vec![(Target::Friction(j), own * rough(j))]);
                    let share = rules::COULOMB_SD * deviation_factor(model, "friction", "coulomb");
                    self.add(&group, vec![(Target::Coulomb(j), share)]);
                }
                (coulomb, viscous) => {
                    let either = coulomb.or(viscous).unwrap_or(0.0);
                    self.add(&group, vec![(Target::Coulomb(j), coulomb.unwrap_or(either))]);
                    self.add(&group, vec![(Target::Viscous(j), viscous.unwrap_or(either))]);
                }
            }
        }
    }

    fn motors(&mut self, model: &Model) {
        let dof = model.links.len();
        let (common, own) = split_deviation(rules::COMMON_MOTORS);
        let rotor = rules::rotor(1.0).sd.hypot(2.0 * rules::ratio(1.0).sd);
        let rotor = rotor * deviation_factor(model, "motors", "rotor_inertia");
        let loss = rules::loss(1.0).sd * deviation_factor(model, "motors", "loss_constant");
        self.add("rotors", (0..dof).map(|j| (Target::Rotor(j), common * rotor)).collect());
        self.add("copper losses", (0..dof).map(|j| (Target::Loss(j), common * loss)).collect());
        for j in 0..dof {
            self.add(&format!("rotor of joint {}", j + 1), vec![(Target::Rotor(j), own * rotor)]);
            self.add(
                &format!("copper loss of joint {}", j + 1),
                vec![(Target::Loss(j), own * loss)],
            );
        }
    }

    /// Base power, brakes and balancer.
    fn power(&mut self, model: &Model) {
        let given = |table: &str, key: &str, value: f64, rough: f64| {
            let own = stated(model, table, key, 0, value);
            own.unwrap_or_else(|| rough * deviation_factor(model, table, key))
        };
        let standby = given("drive", "base_w", model.drive.base_w, UNIT_SIZE.standby().sd);
        self.add("base power", vec![(Target::Standby, standby)]);
        let brakes = model.brakes.as_ref();
        let coils_w = brakes.map_or(0.0, |brakes| brakes.power_released_w);
        let coils = given("brakes", "power_released_w", coils_w, UNIT_SIZE.coils().sd);
        self.add("brake coils", vec![(Target::Coils, coils)]);
        let release_j = brakes.map_or(0.0, |brakes| brakes.energy_per_release_j);
        let release = given("brakes", "energy_per_release_j", release_j, UNIT_SIZE.release().sd);
        self.add("release of the brakes", vec![(Target::Release, release)]);
        if model.effects.iter().any(|effect| effect.id == SPRING_EFFECT) {
            let sd = SPRING * deviation_factor(model, "effects.gravity_spring", "stiffness");
            self.add("balancer of axis 2", vec![(Target::Spring, sd)]);
        }
    }
}

/// Standard deviations of the common part and of the part of one joint, for a variance share
/// `common` of the common part.
fn split_deviation(common: f64) -> (f64, f64) {
    (common.sqrt(), (1.0 - common).sqrt())
}

/// The stated deviation of one number of a list, over `scale`; `None` for an estimate, whose
/// deviations have several parts.
fn stated(model: &Model, table: &str, key: &str, index: usize, scale: f64) -> Option<f64> {
    let origin = model.origin_of(table, key)?;
    let sd = origin.sd.as_ref().filter(|_| origin.provenance != Some(Provenance::Estimated))?;
    let sd = sd.get(index).or(sd.first())?;
    (scale > 0.0).then(|| sd / scale)
}

/// Factor on the standard deviation of an estimate by the provenance of a number.
fn deviation_factor(model: &Model, table: &str, key: &str) -> f64 {
    match model.provenance_of(table, key) {
        Some(Provenance::Estimated | Provenance::Assumed) => 1.0,
        Some(Provenance::Paper) | None => PAPER,
        Some(Provenance::Identified) => IDENTIFIED,
        Some(Provenance::Datasheet) => 0.0,
    }
}
