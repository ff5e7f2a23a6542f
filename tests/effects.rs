//! The effects in a robot file change every torque and power.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use insta::assert_snapshot;
use joulepath::arm::dynamics::{Data, Load, torque};
use joulepath::arm::effects::from_toml;
use joulepath::arm::robot::{MAX_DOF, Model};
use nalgebra::{Matrix3, Vector3};

/// Relative tolerance of torques.
const SAME: f64 = 1e-12;

fn robot(more: &str) -> Model {
    let text = format!("extends = \"IRB1600-10/1.45\"\nname = \"changed\"\n{more}");
    from_toml("robot.toml", &text).unwrap()
}

fn torques(model: &Model, load: &Load) -> [f64; MAX_DOF] {
    let q = [0.3, 0.5, -0.4, 0.8, 0.9, -0.2];
    let qd = [1.0, -0.05, 0.7, 2.0, -1.0, 3.0];
    let qdd = [5.0, 4.0, -6.0, 10.0, 20.0, -30.0];
    let found = torque(model, &mut Data::new(), load, &q, &qd, &qdd);
    std::array::from_fn(|j| found.rigid[j] + found.friction[j])
}

fn same(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * a.abs().max(1.0))
}

/// Each form of an effect changes the corresponding parameter.
#[test]
fn an_effect_acts_like_the_parameter_that_it_changes() {
    let plain = torques(&robot(""), &Load::none());
    for (effect, figures) in [
        (
            "[effects.friction_level]\ncoulomb_j2 = 3.0\nviscous_j3 = -2.0",
            "[friction]\ncoulomb = [25, 15, 7, 5.8, 6.6, 5.0]\nviscous = [48, 75, 30, 5.3, 3.5, 1.3]",
        ),
        (
            "[effects.stribeck]\njoint = 2\nstiction = 9.0\nvelocity = 0.1",
            "[friction]\nstribeck = { stiction = [0, 9, 0, 0, 0, 0], velocity = [1, 0.1, 1, 1, 1, 1] }",
        ),
        (
            "[effects.viscous_asymmetry]\nasymmetry = [3, 0, 0, 0, 0, 1]",
            "[friction]\nviscous_asymmetry = { asymmetry = [3, 0, 0, 0, 0, 1] }",
        ),
        (
            "[effects.load_friction]\nmu_j1 = 0.05\nmu_j2 = 0.06",
            "[friction]\nload_friction = { mu = [0.05, 0.06, 0, 0, 0, 0] }",
        ),
        ("[effects.wrist_coupling]\ncoupling = 0.8", "[wrist]\ncoupling = 0.8"),
    ] {
        let (with, expected) = (robot(effect), robot(figures));
        let found = torques(&with, &Load::none());
        assert!(same(&found, &torques(&expected, &Load::none())), "{effect}: {found:?}");
        assert!(!same(&found, &plain), "{effect} changes nothing");
    }
}

#[test]
fn the_payload_effect_acts_like_a_load() {
    let effect = "[effects.payload]\nmass = 4.0\ncom_x = 0.05\ncom_z = 0.12";
    let load = Load { mass: 4.0, com: Vector3::new(0.05, 0.0, 0.12), inertia: Matrix3::zeros() };
    let (found, expected) = (torques(&robot(effect), &Load::none()), torques(&robot(""), &load));
    assert!(same(&found, &expected), "{found:?} {expected:?}");
}

#[test]
fn effects_change_rotors_losses_and_sensors() {
    let changed = robot(
        "[effects.rotor_inertia]\ninertia_j4 = 0.9\n[effects.copper_loss]\nloss_j2 = 1e-4\n\
         [effects.base_load]\npower = 40\n[effects.brake_power]\npower = 5\n\
         [effects.no_regeneration]\n[effects.encoder_offset]\noffset_j3 = 0.001\n\
         [effects.torque_offset]\noffset_j1 = 2\n[effects.torque_constant]\nerror_j2 = 0.05\n",
    );
    let plain = robot("");
    let [new, old] = [&changed, &plain].map(|model| model.motors.clone().unwrap());
    assert!((new.reflected_inertia(3) - old.reflected_inertia(3) - 0.9).abs() < 1e-12);
    assert!((new.loss_constant[1] - old.loss_constant[1] - 1e-4).abs() < 1e-15);
    assert_eq!(changed.drive.base_w, plain.drive.base_w + 40.0);
    let coils = |model: &Model| model.brakes.as_ref().unwrap().power_released_w;
    assert_eq!(coils(&changed), coils(&plain) + 5.0);
    assert_eq!(changed.sensors.position_offset[2], 0.001);
    assert_eq!(changed.sensors.torque_offset[0], 2.0);
    assert_eq!(changed.sensors.torque_error[1], 0.05);
}

/// The bound of an effect does not depend on the values of another effect.
#[test]
fn breakaway_friction_may_decrease_to_zero() {
    let text = "extends = \"IRB1600-10/1.45\"\nname = \"changed\"\n\
                [effects.cable]\nstiffness_j2 = -100\n\
                [effects.stribeck]\nstiction_j2 = -12\nvelocity_j2 = 0.1\n";
    let model = from_toml("robot.toml", text).unwrap();
    assert_eq!(model.friction.coulomb[1], 12.0);
}

#[test]
fn wrong_effects_are_refused_with_the_reason() {
    let messages = [
        "[effects.backlash]\ngap = 0.001",
        "[effects.stribek]\nstiction = 1",
        "[effects.stribeck]\nstiction = 1",
        "[effects.stribeck]\njoint = 7\nstiction = 1",
        "[effects.stribeck]\nstiction_j2 = 1\nvelocity_j2 = 0",
        "[effects.stribeck]\nstiction_j2 = 1\nvelocity_j7 = 0.1",
        "[effects.stribeck]\nstiction_j2 = -13\nvelocity_j2 = 0.1",
        "[effects.stribeck]\nstiction_j2 = -11\nvelocity_j2 = 0.1\n[effects.friction_level]\ncoulomb_j2 = -2",
        "[effects.friction_level]\ncoulomb_j2 = -1000",
        "[effects.payload]\nmass = -50",
        "[effects.payload]\nmas = 5",
    ]
    .map(|text| {
        let text = format!("extends = \"IRB1600-10/1.45\"\nname = \"changed\"\n{text}\n");
        from_toml("robot.toml", &text).unwrap_err().to_string()
    });
    assert_snapshot!(messages.join("\n"));
}
