//! Robots by name and by file, and the contract of the catalogue.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::fs;

use insta::assert_snapshot;
use joulepath::arm::dynamics::{Data, Load, gravity};
use joulepath::arm::kinematics::limits_ok;
use joulepath::arm::robot::{self, Model, Provenance, RobotError, Sharing, find, from_toml, load};

const TWO_JOINTS: &str = r#"name = "two"
[kinematics]
source = "a drawing"
provenance = "datasheet"
[[joint]]
origin = [0, 0, 0.5]
axis = [0, 0, 1]
[[joint]]
origin = [0.1, 0, 0]
axis = [0, 1, 0]
[limits]
source = "measured"
provenance = "identified"
position = [[-3.0, 3.0], [-2.0, 2.0]]
velocity = [2, 3]
torque = [10.0, 20.0]
torque_source = "a guess"
torque_provenance = "assumed"
"#;

fn irb1600() -> Model {
    find("IRB1600-10/1.45").unwrap()
}

fn error(text: &str) -> RobotError {
    from_toml("robot.toml", text).unwrap_err()
}

/// The two-jointed robot with one line replaced.
fn changed(from: &str, to: &str) -> String {
    assert!(TWO_JOINTS.contains(from));
    TWO_JOINTS.replacen(from, to, 1)
}

#[test]
fn robot_names_may_be_written_in_several_ways() {
    for name in [
        "IRB1600-10/1.45",
        "IRB 1600-10/1.45",
        "irb 1600 - 10 / 1.45",
        "irb1600_10_145",
        "1600-10/1.45",
        "ROB1_1600_1.45_10",
        "ROB1_1600_1.45_10_TypeA",
    ] {
        assert_eq!(find(name).unwrap().name, "IRB1600-10/1.45", "{name}");
    }
    assert_eq!(find("IRB6640 180/2.55").unwrap().name, "IRB6640-180/2.55");
    assert_eq!(find("ROB1_6640_2.55_180").unwrap().name, "IRB6640-180/2.55");
    for name in ["IRB1600-7/1.45", "IRB1600", "IRB1600ID-10/1.45", "", "-", "IRB", "rob1"] {
        assert!(find(name).is_err(), "{name}");
    }
}

#[test]
fn unknown_names_are_refused_with_the_way_out() {
    assert_snapshot!(find("IRB1600-10/1.54").unwrap_err(), @r#"unknown robot "IRB1600-10/1.54", did you mean "IRB1600-10/1.45"?; joulepath robots list shows the known ones; or give a robot TOML or URDF file"#);
    assert_snapshot!(find("UR10").unwrap_err(), @r#"unknown robot "UR10"; joulepath robots list shows the known ones; or give a robot TOML or URDF file"#);
}

#[test]
fn assumed_numbers_of_the_irb1600() {
    assert_snapshot!(irb1600().assumed().join("\n"));
}

#[test]
fn irb1600_is_complete() {
    let model = irb1600();
    assert!(model.has_dynamics() && model.motors.is_some() && model.brakes.is_some());
    assert!(model.limits.torque.is_some() && model.limits.jerk.is_some());
    assert_eq!(model.drive.sharing, Sharing::Bus);
    assert_eq!(model.friction.viscous[1], 75.0);
    assert!(model.limits.tcp_acceleration.is_none());
}

#[test]
fn axis_2_has_a_wider_range_while_axis_1_points_forward() {
    let model = irb1600();
    let at = |q1: f64, q2: f64| {
        limits_ok(&model, &[q1.to_radians(), q2.to_radians(), 0.0, 0.0, 0.0, 0.0])
    };
    assert!(at(95.0, 150.0).is_ok() && at(-95.0, 120.1).is_ok() && at(170.0, 120.0).is_ok());
    assert!(at(95.1, 120.1).is_err() && at(0.0, 150.1).is_err() && at(0.0, -90.1).is_err());
    assert_snapshot!(at(95.1, 130.0).unwrap_err(), @"joint 2 would be at 130.000 deg, outside -90.000 to 120.000 deg");
}

/// Paes et al. 2014, table 3: holding power of joints 1 to 3, in assumed poses.
#[test]
fn holding_powers_agree_with_the_paper() {
    let model = irb1600();
    let loss = &model.motors.as_ref().unwrap().loss_constant;
    let holding = |degrees: [f64; 6]| -> Vec<f64> {
        let q = degrees.map(f64::to_radians);
        let tau = gravity(&model, &mut Data::new(), &Load::none(), &q);
        (0..3).map(|i| loss[i] * tau[i] * tau[i] + model.standstill.holding_w[i]).collect()
    };
    // Upper arm level, forearm down: 5 + 30 + 0 W.
    let stretched = holding([0.0, 90.0, 0.0, 0.0, 0.0, 0.0]);
    assert!((stretched[0] - 5.0).abs() < 0.1, "{stretched:?}");
    assert!((stretched[1] - 30.0).abs() < 1.0, "{stretched:?}");
    assert!(stretched[2] < 0.5, "{stretched:?}");
    // Upper arm slightly forward, forearm horizontal: 7 + 2 + 4 W.
    let reaching = holding([0.0, 8.0, -8.0, 0.0, 0.0, 0.0]);
    assert!((reaching[1] - 2.0).abs() < 0.7 && (reaching[2] - 4.0).abs() < 0.5, "{reaching:?}");
    // Both up: 5 + 0 + 0 W.
    let folded = holding([0.0, 0.0, -90.0, 0.0, 0.0, 0.0]);
    assert!(folded[1] < 0.5 && folded[2] < 0.5, "{folded:?}");
}

#[test]
fn a_robot_is_read_from_its_text() {
    let model = from_toml("two.toml", TWO_JOINTS).unwrap();
    assert_eq!(model.dof, 2);
    assert!(!model.has_dynamics());
    assert_eq!(model.drive.base_w, 0.0);
    assert_eq!(model.friction.coulomb, [0.0; 2]);
    assert_eq!(model.assumed(), ["limits.torque (assumed): a guess"]);
    let velocity = model.origins.iter().find(|o| o.key == "velocity").unwrap();
    assert_eq!(velocity.provenance, Some(Provenance::Identified));
    assert_eq!(velocity.source.as_deref(), Some("measured"));
}

#[test]
fn base_arm_loads_and_effects_are_read() {
    let text = "extends = \"irb 1600-10/1.45\"\nname = \"hung\"\n\
                [kinematics.base]\norigin = [1, 0, 2]\nrpy = [3.141592653589793, 0, 0]\n\
                [[arm_load]]\njoint = 3\nmass = 4\ncom = [0.1, 0, 0.2]\ninertia = [0, 0, 0, 0, 0, 0]\n\
                [effects.stribeck]\njoint = 2\nstiction = 3\nvelocity = 0.05\n";
    let hung = from_toml("hung.toml", text).unwrap();
    assert!((hung.kinematics.up() + nalgebra::Vector3::z()).norm() < 1e-12);
    let of_joint_2 = |value| robot::Given::Joints(vec![0.0, value, 0.0, 0.0, 0.0, 0.0]);
    let expected =
        [("stiction".to_owned(), of_joint_2(3.0)), ("velocity".to_owned(), of_joint_2(0.05))];
    assert_eq!(
        (hung.effects[0].id.as_str(), hung.effects[0].values.as_slice()),
        ("stribeck", &expected[..])
    );
    let upright = irb1600();
    let (a, b) = (&hung.links[2], &upright.links[2]);
    assert_eq!(a.mass, b.mass + 4.0);
    // For a hanging robot gravity is reversed; without the arm load this is exact.
    let q = [0.2, 0.4, -0.3, 0.1, 0.5, 0.0];
    let mut lighter = hung.clone();
    lighter.links.clone_from(&upright.links);
    let tau = |model: &Model| gravity(model, &mut Data::new(), &Load::none(), &q);
    for (hanging, standing) in tau(&lighter).iter().zip(tau(&upright)) {
        assert!((hanging + standing).abs() < 1e-9);
    }
}

#[test]
fn an_overlay_replaces_numbers_with_their_origin() {
    let text = "extends = \"irb 1600-10/1.45\"\nname = \"ours\"\n[limits]\n\
                torque = [900, 900, 500, 90, 80, 50]\ntorque_source = \"our tuning\"\n";
    let ours = from_toml("ours.toml", text).unwrap();
    assert_eq!(ours.name, "ours");
    assert_eq!(ours.limits.torque.as_ref().unwrap()[0], 900.0);
    assert_eq!(ours.limits.velocity, irb1600().limits.velocity);
    assert!(!ours.assumed().join("\n").contains("limits.torque"));
    let torque = ours.origins.iter().find(|o| o.key == "torque").unwrap();
    assert_eq!((torque.provenance, torque.source.as_deref()), (None, Some("our tuning")));
}

#[test]
fn files_may_extend_files_in_the_same_folder() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    write("base.toml", TWO_JOINTS);
    let top = write("top.toml", "extends = \"base.toml\"\nname = \"top\"\n");
    assert_eq!(load(&top).unwrap().dof, 2);
    let circle = write("circle.toml", "extends = \"circle.toml\"\nname = \"x\"\n");
    let message = load(&circle).unwrap_err().to_string();
    assert!(message.ends_with("nested more than 8 deep; remove the circle"), "{message}");
    let broken = write("broken.toml", "extends = \"absent.toml\"\n");
    assert!(matches!(load(&broken).unwrap_err(), RobotError::Base { .. }));
    let other = write("robot.json", "{}");
    assert!(matches!(load(&other).unwrap_err(), RobotError::Format { .. }));
    assert!(matches!(load("nowhere.toml").unwrap_err(), RobotError::Io { .. }));
    assert_eq!(load("irb1600_10_145").unwrap().name, "IRB1600-10/1.45");
}

#[test]
fn wrong_files_name_the_place_and_the_way_out() {
    const LINK: &str = "[[link]]\nmass = 1\ncom = [0,0,0]\ninertia = [1,1,1,0,0,0]\n";
    let with = |tail: &str| format!("{TWO_JOINTS}{tail}");
    let second_link = |from: &str, to: &str| with(&format!("{LINK}{}", LINK.replace(from, to)));
    let texts = [
        "name = ".into(),
        "name = \"x\"\n".into(),
        "extends = \"IRB9999\"\n".into(),
        changed("velocity =", "velocty ="),
        changed("[2, 3]", "[2, 3, 4]"),
        changed("[2, 3]", "[2, \"3 rad/s\"]"),
        changed("[2, 3]", "[2, -3]"),
        changed("[2, 3]", "[2, nan]"),
        changed("[-2.0, 2.0]", "[2.0, -2.0]"),
        changed("\"identified\"", "\"known\""),
        changed("\"measured\"", "7"),
        changed("axis = [0, 1, 0]", "axis = [0, 0, 0]"),
        changed("axis = [0, 1, 0]", ""),
        changed("[limits]", "[limit]"),
        with(LINK),
        second_link("mass = 1", "mass = -1"),
        second_link("1,1,1,0", "1,1,1,2"),
        second_link("inertia = [1,1,1,0,0,0]", ""),
        with("[drive]\nsharing = true\n"),
        with("[drive]\nsharing = \"all\"\n"),
        with("[drive]\nregeneration = 1.5\n"),
        with("[motors]\nratio = [1,1]\nresistance = [1,1]\n"),
        with("[[limits.position_if]]\njoint = 3\n"),
        changed("[kinematics]", "[kinematics]\ncoupling = \"parallelogram\""),
        // Other units: degrees, millimetres, degrees per second, grams.
        changed("[-2.0, 2.0]", "[-115, 115]"),
        changed("axis = [0, 1, 0]", "axis = [0, 1, 0]\nrpy = [0, 90, 0]"),
        second_link("com = [0,0,0]", "com = [0,0,120]"),
        changed("[2, 3]", "[180, 175]"),
        second_link("mass = 1", "mass = 310000"),
        second_link("mass = 1", "mass = 1e400"),
        second_link("mass = 1", "mass = 99999999999999999999999"),
        second_link("mass = 1", "mass_g = 1000"),
        with(
            "[[arm_load]]\njoint = 1\nmass = 4\ncom = [0,0,0]\ninertia = [3000,3000,3000,0,0,0]\n",
        ),
        with("[[arm_load]]\njoint = 1\nmass = 4\ncom = [0,0,0]\ninertia = [0,0.02,0,0,0,0]\n"),
        with("[motors]\nratio = [1,1]\ntorque_constant = [470, 470]\n"),
        with("[motors]\nratio = [100,100]\nrotor_inertia = [1, 1]\n"),
        with("[brakes]\nenergy_per_release_j = 12\nrelease_s = 200\nengage_s = 0.1\n"),
        with("[controller]\nramp_s = 100\n"),
        with("[motors]\nratio = [1,1]\nloss_constant = [0,0]\nresistance = [1,1]\n"),
        with(
            "[[limits.position_if]]\njoint = 2\nposition = [-1, 1]\nif_joint = 2\n\
             if_within = [-1, 1]\n",
        ),
        changed("axis = [0, 1, 0]", "axis = [0, 1e300, 0]"),
        changed("axis = [0, 1, 0]", "axis = [0, 1e-300, 0]"),
        format!("name=\"x\"\n{}", "[[joint]]\norigin=[0,0,0]\naxis=[0,0,1]\n".repeat(8)),
    ];
    let messages: Vec<String> = texts.iter().map(|text| error(text).to_string()).collect();
    assert_snapshot!(messages.join("\n"));
}

#[test]
fn an_overlay_may_state_motor_losses_in_another_form() {
    let plain = irb1600();
    let overlay = "extends = \"IRB1600-10/1.45\"\n[motors]\nresistance = [1, 1, 1, 1, 1, 1]\n";
    let motors = from_toml("robot.toml", overlay).unwrap().motors.unwrap();
    let per_ampere = motors.ratio[0] * motors.torque_constant.unwrap()[0];
    assert!((motors.loss_constant[0] - 3.0 / per_ampere.powi(2)).abs() < 1e-15);
    assert_eq!(motors.ratio, plain.motors.unwrap().ratio);
}

#[test]
fn robots_without_published_lengths_are_named_as_such() {
    for name in ["IRB6660", "IRB6660-205/1.9", "IRB 8700-800/3.5", "ROB1_8700_3.50_800"] {
        let message = find(name).unwrap_err().to_string();
        assert!(message.contains("not published") && !message.contains("mean"), "{message}");
    }
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig {
        failure_persistence: None, ..Default::default()
    })]

    /// Reading a damaged file gives an error or a robot, but never a panic.
    #[test]
    fn damaged_files_cause_no_panic(
        cuts in proptest::collection::vec((0usize..700, 0usize..12, "[\\[\\]{}=\"a-z0-9.,\n-]{0,6}"), 1..4),
    ) {
        let mut text = TWO_JOINTS.to_owned();
        for (start, len, insert) in cuts {
            let start = start.min(text.len());
            let end = (start + len).min(text.len());
            text.replace_range(start..end, &insert);
        }
        if let Ok(model) = from_toml("damaged.toml", &text) {
            let q = vec![0.1; model.dof];
            std::hint::black_box(joulepath::arm::kinematics::fk(&model, &q));
        }
    }
}
