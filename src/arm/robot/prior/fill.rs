//! Fills the gaps of a model with estimates.

use super::bodies::{links, rated_inertia, stretched_moment};
use super::known::{ARM, Known, type_name};
use super::rules::{self, Maker, Rough, Size};
use crate::arm::robot::drive::{Brakes, Drive, Sharing};
use crate::arm::robot::effect::{EffectParameters, Given};
use crate::arm::robot::geometry::GRAVITY;
use crate::arm::robot::model::Model;
use crate::arm::robot::motors::Motors;
use crate::arm::robot::provenance::{Origin, Provenance};

/// Share of the gravity torque of axis 2 of the stretched arm that a balancer compensates with the
/// axis at 90 degrees; assumed.
const BALANCED: f64 = 0.7;
/// Brake times, independent of size \[s\].
const RELEASE_S: f64 = 0.2;
const ENGAGE_S: f64 = 0.1;
/// Rise time of the acceleration of the planner \[s\].
const RAMP_S: f64 = 0.1;

/// The model with estimates of its missing dynamics, limits and powers. Stated numbers stay. A
/// chain of fewer than 5 joints is returned unchanged.
#[must_use]
pub fn estimated(model: Model) -> Model {
    let known = Known::from_model(&model);
    if !ARM.contains(&model.dof) {
        return model;
    }
    let size = known.size(&model);
    let mut fill = Filling { stated: model.origins.clone(), model };
    fill.bodies(&known, size);
    fill.speeds(&known, size);
    fill.friction(size);
    fill.motors(size);
    fill.power(size);
    fill.limits(size);
    fill.model
}

struct Filling {
    model: Model,
    /// Origins of the stated numbers.
    stated: Vec<Origin>,
}

impl Filling {
    fn has(&self, table: &str, key: &str) -> bool {
        self.stated.iter().any(|origin| origin.table == table && origin.key == key)
    }

    fn note(&mut self, table: &str, key: &str, source: &str, sd: Option<Vec<f64>>) {
        self.model.origins.push(Origin {
            table: table.to_owned(),
            key: key.to_owned(),
            provenance: Some(Provenance::Estimated),
            source: Some(source.to_owned()),
            sd,
        });
    }

    /// Adds one number per joint if the list is missing.
    fn by_joint(
        &mut self,
        (table, key): (&str, &str),
        source: &str,
        rough: &dyn Fn(usize) -> Rough,
    ) -> Option<Vec<f64>> {
        if self.has(table, key) {
            return None;
        }
        let all: Vec<Rough> = (0..self.model.dof).map(rough).collect();
        let sd = all.iter().map(Rough::deviation).collect();
        self.note(table, key, source, Some(sd));
        Some(all.into_iter().map(|rough| rough.value).collect())
    }

    fn one(&mut self, (table, key): (&str, &str), source: &str, rough: Rough) -> Option<f64> {
        if self.has(table, key) {
            return None;
        }
        self.note(table, key, source, Some(vec![rough.deviation()]));
        Some(rough.value)
    }

    fn bodies(&mut self, known: &Known, size: Size) {
        if !self.model.links.is_empty() {
            return;
        }
        let (links, source) = links(known, &self.model.kinematics, size);
        self.model.links = links;
        for i in 1..=self.model.dof {
            for key in ["mass", "com", "inertia"] {
                self.note(&format!("link {i}"), key, &source, None);
            }
        }
        if known.balanced {
            // Gravity torque of the stretched arm with a level upper arm.
            let gravity = GRAVITY * stretched_moment(&self.model);
            let stiffness = BALANCED * gravity / std::f64::consts::FRAC_PI_2;
            let stiffness = Given::one_joint(1, stiffness, self.model.dof);
            self.model.effects.push(EffectParameters {
                id: "gravity_spring".into(),
                values: vec![("stiffness".into(), stiffness)],
                place: "the estimate".into(),
            });
            let source =
                "a balancer that carries 0.7 of the gravity torque of the level arm: a proposal";
            self.note("effects.gravity_spring", "stiffness", source, None);
        }
    }

    fn speeds(&mut self, known: &Known, size: Size) {
        if self.model.limits.velocity.is_some() {
            return;
        }
        if let Some((velocity, source)) = &known.velocity {
            self.model.limits.velocity = Some(velocity.clone());
            self.note("limits", "velocity", source, None);
            if let Some(origin) = self.model.origins.last_mut() {
                origin.provenance = Some(Provenance::Datasheet);
            }
            return;
        }
        let dof = self.model.dof;
        let speeds = self.by_joint(
            ("limits", "velocity"),
            "speeds of the catalogue's robots over their size",
            &|j| size.speed(j, dof),
        );
        self.model.limits.velocity = speeds;
    }

    fn friction(&mut self, size: Size) {
        let dof = self.model.dof;
        let speeds = self.model.limits.velocity.clone().unwrap_or_default();
        let maker = Maker::from_name(type_name(&self.model));
        let source = match maker {
            Maker::Abb => {
                "friction over the largest torque, as of eleven ABB configurations and two identifications"
            }
            Maker::Other => {
                "friction over the largest torque, as of five identified arms of five makers"
            }
        };
        let part = |j: usize, share: f64| {
            let friction = size.friction(maker, j, dof);
            Rough { value: share * friction.value, sd: friction.sd }
        };
        let coulomb = self.by_joint(("friction", "coulomb"), source, &|j| part(j, rules::COULOMB));
        let viscous = self.by_joint(("friction", "viscous"), source, &|j| {
            let half = 0.5 * speeds.get(j).copied().unwrap_or(3.0);
            part(j, (1.0 - rules::COULOMB) / half)
        });
        let friction = &mut self.model.friction;
        friction.coulomb = coulomb.unwrap_or_else(|| friction.coulomb.clone());
        friction.viscous = viscous.unwrap_or_else(|| friction.viscous.clone());
    }

    fn motors(&mut self, size: Size) {
        let dof = self.model.dof;
        let speeds = self.model.limits.velocity.clone().unwrap_or_default();
        let ratio = self.by_joint(
            ("motors", "ratio"),
            "motors turn at 420 rad/s at the axis speed",
            &|j| rules::ratio(speeds.get(j).copied().unwrap_or(3.0)),
        );
        let motors = self.model.motors.take();
        let ratio = ratio.or_else(|| motors.as_ref().map(|m| m.ratio.clone())).unwrap_or_default();
        let peak = |j: usize| size.torque(j, dof).value / ratio[j];
        let source = "motors of ABB's 9C series with the joint's largest torque over its gear";
        let rotor = self.by_joint(("motors", "rotor_inertia"), source, &|j| rules::rotor(peak(j)));
        let given = self.has("motors", "resistance");
        let loss = if given {
            None
        } else {
            self.by_joint(("motors", "loss_constant"), source, &|j| {
                let loss = rules::loss(peak(j));
                Rough { value: loss.value / (ratio[j] * ratio[j]), sd: loss.sd }
            })
        };
        let mut new = motors.unwrap_or_else(|| Motors {
            ratio,
            torque_constant: None,
            rotor_inertia: vec![0.0; dof],
            loss_constant: vec![0.0; dof],
            peak_current: None,
            rated_current: None,
        });
        new.rotor_inertia = rotor.unwrap_or(new.rotor_inertia);
        new.loss_constant = loss.unwrap_or(new.loss_constant);
        self.model.motors = Some(new);
    }

    fn power(&mut self, size: Size) {
        let base = self.one(
            ("drive", "base_w"),
            "powers at standstill that are known of three robots, over their mass",
            size.standby(),
        );
        if let Some(base_w) = base {
            self.model.drive.base_w = base_w;
        }
        if !self.has("drive", "sharing") {
            self.model.drive = Drive { sharing: Sharing::Bus, ..self.model.drive.clone() };
            self.note("drive", "sharing", "IRC5 and OmniCore: one bus for all axes", None);
        }
        self.brakes(size);
    }

    fn brakes(&mut self, size: Size) {
        let source = "the power of open brakes of two robots of ABB, a release of an IRB1600";
        let coils = self.one(("brakes", "power_released_w"), source, size.coils());
        let release = self.one(("brakes", "energy_per_release_j"), source, size.release());
        let mut time = |key: &str, value: f64| {
            let is_missing = !self.has("brakes", key);
            if is_missing {
                self.note("brakes", key, "comparable holding brakes", None);
            }
            is_missing.then_some(value)
        };
        let [opens, closes] =
            [("release_s", RELEASE_S), ("engage_s", ENGAGE_S)].map(|(key, value)| time(key, value));
        let stated = self.model.brakes.take();
        let or = |estimate: Option<f64>, key: fn(&Brakes) -> f64| {
            estimate.or(stated.as_ref().map(key)).unwrap_or_default()
        };
        self.model.brakes = Some(Brakes {
            energy_per_release_j: or(release, |brakes| brakes.energy_per_release_j),
            release_s: or(opens, |brakes| brakes.release_s),
            engage_s: or(closes, |brakes| brakes.engage_s),
            power_released_w: or(coils, |brakes| brakes.power_released_w),
        });
    }

    fn limits(&mut self, size: Size) {
        let dof = self.model.dof;
        if self.model.limits.torque.is_none() {
            let source = "torque limits of 38 robots of KUKA, over mass, reach and payload";
            let torque = self.by_joint(("limits", "torque"), source, &|j| size.torque(j, dof));
            self.model.limits.torque = torque;
        }
        if self.model.limits.acceleration.is_none() {
            let share = size.acceleration_share();
            let inertia = rated_inertia(&self.model, size.payload);
            let source = "the torque that the foundation bears in operation, over the inertia of the stretched arm with its rated load";
            let acceleration = self.by_joint(("limits", "acceleration"), source, &|j| {
                let torque = size.torque(j, dof);
                Rough {
                    value: (share * torque.value / inertia[j]).min(MOST_ACCELERATION),
                    sd: torque.sd,
                }
            });
            self.model.limits.acceleration = acceleration;
        }
        if self.model.limits.jerk.is_none() {
            let acceleration = self.model.limits.acceleration.clone().unwrap_or_default();
            let ramp = self.model.controller.ramp_s.unwrap_or(RAMP_S);
            let jerk: Vec<f64> = acceleration.iter().map(|a| 2.0 * a / ramp).collect();
            self.note(
                "limits",
                "jerk",
                "from one acceleration limit to the other within the ramp",
                None,
            );
            self.model.limits.jerk = Some(jerk);
        }
    }
}

/// Largest acceleration of a small wrist, measured on an IRB1200 \[rad/s²\].
const MOST_ACCELERATION: f64 = 150.0;
