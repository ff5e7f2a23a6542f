//! Faults of a robot or its log, each in several functional forms.

mod compliance;
mod electrical;
mod environment;
mod friction;
mod hysteresis;
mod laws;
mod outside;
mod power;
mod sensing;

use super::fault::Disturbance;
use super::random::Random;
use super::scale::{Draw, Scale};

/// Torque effects: id and function that draws one.
const TORQUE: [(&str, Draw); 29] = [
    ("payload", environment::payload),
    ("rotor_inertia", environment::rotor_inertia),
    ("gravity_spring", environment::gravity_spring),
    ("base_tilt", environment::base_tilt),
    ("encoder_offset", sensing::encoder_offset),
    ("cable", environment::cable),
    ("friction_level", friction::friction_level),
    ("torque_offset", sensing::torque_offset),
    ("stribeck", friction::stribeck),
    ("nonlinear_viscous", friction::nonlinear_viscous),
    ("viscous_asymmetry", friction::viscous_asymmetry),
    ("load_friction", friction::load_friction),
    ("gear_efficiency", friction::gear_efficiency),
    ("warm_up", friction::warm_up),
    ("position_friction", friction::position_friction),
    ("presliding", hysteresis::presliding),
    ("backlash", compliance::backlash),
    ("elasticity", compliance::elasticity),
    ("ripple", electrical::ripple),
    ("wrist_coupling", environment::wrist_coupling),
    ("brake_drag", friction::brake_drag),
    ("torque_constant", electrical::torque_constant),
    ("current_saturation", electrical::current_saturation),
    ("flux_weakening", electrical::flux_weakening),
    ("time_delay", sensing::time_delay),
    ("filter_lag", sensing::filter_lag),
    ("current_sign", electrical::current_sign),
    ("contact", environment::contact),
    // Doubled probability: the payload changes most often.
    ("payload", environment::payload),
];

/// Power effects.
const POWER: [(&str, Draw); 6] = [
    ("copper_loss", power::copper_loss),
    ("inverter_loss", power::inverter_loss),
    ("iron_loss", power::iron_loss),
    ("no_regeneration", power::no_regeneration),
    ("base_load", power::base_load),
    ("brake_power", power::brake_power),
];

/// A torque effect.
pub(super) fn torque_effect(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    TORQUE[random.below(TORQUE.len())].1(scale, random)
}

/// A power effect.
pub(super) fn power_effect(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    POWER[random.below(POWER.len())].1(scale, random)
}

/// Bodies that differ much more than their assumed spread.
pub(super) fn link_parameters(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    environment::link_parameters(scale, random)
}

/// A fault without a corresponding effect in the library.
pub(super) fn outside(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    outside::outside(scale, random)
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use std::collections::{BTreeMap, BTreeSet};

    use super::super::fourier::fourier;
    use super::super::model_error::ModelError;
    use super::super::motion::Motion;
    use super::super::plant::Plant;
    use super::super::robots;
    use super::super::simulate::{Robot, Row, Supply, simulate};
    use super::super::trust::Trust;
    use super::super::workspace::Workspace;
    use super::laws::NONE;
    use super::*;
    use crate::arm::robot::MAX_DOF;

    /// Draws per effect.
    const DRAWS: usize = 24;
    /// Least number of functional forms of an effect.
    const FORMS: usize = 3;
    /// Bound of the torques relative to the robot's own.
    const ABSURD: f64 = 20.0;

    struct Bench {
        plant: Plant,
        workspace: Workspace,
        motion: Motion,
        error: ModelError,
        supply: Supply,
    }

    fn bench() -> Bench {
        let mut random = Random::new(1, 1, "test");
        let model = robots::robot(&mut random).unwrap();
        let workspace = Workspace::new(&model);
        let motion = fourier(&workspace, 4.0, &mut random);
        let nothing = [0.0; MAX_DOF];
        Bench {
            plant: Plant::new(&model),
            workspace,
            motion,
            error: ModelError::drawn(0, &nothing, &nothing, &nothing, &nothing, &mut random),
            supply: Supply { base: 100.0, loss: [1e-3; MAX_DOF], regeneration: 0.7 },
        }
    }

    impl Bench {
        fn run(&self, disturbances: Vec<&Disturbance>) -> Vec<Row> {
            let Bench { plant, error, supply, .. } = self;
            let robot = Robot { plant, error, supply, disturbances };
            simulate(&robot, &self.motion, 0.0, &[[1.0; MAX_DOF]; 2])
        }

        fn scale(&self) -> Scale<'_> {
            let (mut peak, mut fastest) = (NONE, NONE);
            for sample in &self.motion.samples {
                let tau = self.plant.torque(&sample.q, &sample.qd, &sample.qdd);
                for joint in 0..self.plant.dof {
                    peak[joint] = f64::max(peak[joint], tau[joint].abs());
                    fastest[joint] = f64::max(fastest[joint], sample.qd[joint].abs());
                }
            }
            Scale {
                nominal: &self.plant,
                plant: &self.plant,
                workspace: &self.workspace,
                trust: Trust::COMMISSIONED,
                period_s: 4.0,
                ratio: [100.0; MAX_DOF],
                rms: peak.map(|x| 0.5 * x),
                peak,
                fastest,
                load: peak.map(|x| 0.4 * x),
                power: 500.0,
            }
        }
    }

    /// Each effect has several forms, changes the log and keeps plausible torques.
    #[test]
    fn every_effect_shows_in_several_forms() {
        let bench = bench();
        let (scale, plain) = (bench.scale(), bench.run(Vec::new()));
        let mut forms: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
        for (id, draw) in TORQUE.iter().chain(&POWER) {
            for k in 0..DRAWS {
                let disturbance = draw(&scale, &mut Random::new(2, k as u64, id));
                let form = disturbance.truth.form.clone();
                assert_eq!(disturbance.truth.id, *id);
                if !forms.entry(id).or_default().insert(form.clone()) {
                    continue;
                }
                let rows = bench.run(vec![&disturbance]);
                let name = format!("{id} {form}");
                let mut changed = 0.0;
                for (row, plain) in rows.iter().zip(&plain) {
                    assert!(row.power.is_finite(), "{name}");
                    changed += (row.power - plain.power).abs() / scale.power;
                    for joint in 0..bench.plant.dof {
                        let tau = row.tau[joint];
                        assert!(tau.abs() < ABSURD * scale.peak[joint], "{name}: {tau}");
                        changed += (tau - plain.tau[joint]).abs() / scale.peak[joint]
                            + (row.q[joint] - plain.q[joint]).abs();
                    }
                }
                assert!(changed > 0.0, "{name}");
            }
        }
        assert_eq!(forms.len(), TORQUE.len() - 1 + POWER.len());
        for (id, forms) in forms {
            assert!(forms.len() >= FORMS, "{id}: {forms:?}");
        }
    }

    /// A delay only shifts the torques; a lag does so at low frequencies.
    #[test]
    fn delays_are_exact() {
        let bench = bench();
        let (scale, plain) = (bench.scale(), bench.run(Vec::new()));
        let mut checked = 0;
        for k in 0..60 {
            let disturbance = sensing::time_delay(&scale, &mut Random::new(3, k, "delay"));
            let truth = &disturbance.truth;
            if truth.form != "constant" || !truth.joints.is_empty() {
                continue;
            }
            checked += 1;
            let late = bench.run(vec![&disturbance]);
            let steps = truth.parameters[0].value / 0.01;
            let (whole, part) = (steps.floor() as usize, steps.fract());
            // The start has no influence on the second period. Only friction makes the torque of
            // axis 2 jump, and interpolation between rows of 10 ms smears these jumps.
            let misses = (plain.len() / 2..plain.len()).filter(|&i| {
                let (newer, older) = (plain[i - whole].tau[1], plain[i - whole - 1].tau[1]);
                (late[i].tau[1] - (newer + part * (older - newer))).abs() > 0.01 * scale.peak[1]
            });
            assert!(misses.count() < 20);
        }
        assert!(checked > 3);
    }
}
