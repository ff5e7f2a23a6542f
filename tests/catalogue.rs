//! The robots of the crate: their contract, and errors of the sources that must not recur.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::f64::consts::{FRAC_PI_2, PI};

use joulepath::arm::dynamics::Load;
use joulepath::arm::kinematics::{conf_of, fk, ik_all, ik_conf, limits_ok};
use joulepath::arm::robot::{Coupling, Link, Model, Provenance, find, from_toml, names, to_toml};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

fn robot(name: &str) -> Model {
    find(name).unwrap()
}

fn robots() -> impl Iterator<Item = Model> {
    names().map(robot)
}

fn range(model: &Model, axis: usize) -> [f64; 2] {
    model.limits.position[axis - 1].map(|angle| (angle.to_degrees() * 1e6).round() / 1e6)
}

fn speeds(model: &Model) -> Option<Vec<i64>> {
    let velocity = model.limits.velocity.as_ref()?;
    Some(velocity.iter().map(|speed| speed.to_degrees().round() as i64).collect())
}

#[test]
fn every_robot_states_its_sources_and_has_consistent_data() {
    let mut count = 0;
    for name in names() {
        let model = robot(name);
        assert_eq!(model.name, name);
        for origin in &model.origins {
            assert!(origin.source.is_some() && origin.provenance.is_some(), "{name}: {origin:?}");
        }
        assert!(model.links.iter().all(Link::is_consistent), "{name}");
        assert_eq!(model.limits.velocity.is_some(), model.limits.jerk.is_some() || model.dof != 6);
        assert!(limits_ok(&model, &vec![0.0; model.dof]).is_ok(), "{name}");
        count += 1;
    }
    assert!(count >= 60, "{count}");
    assert!(names().is_sorted());
}

#[test]
fn a_written_robot_is_read_as_the_same_robot() {
    let text = "extends = \"IRB6640-180/2.55\"\nname = \"own\"\n[controller]\nramp_core = 0.5\nclosing = 0.2";
    let own = from_toml("own.toml", text).unwrap();
    assert_eq!((own.controller.ramp_core, own.controller.closing), (Some(0.5), Some(0.2)));
    for model in robots().chain([own]) {
        let name = &model.name;
        let read = from_toml("written.toml", &to_toml(&model)).unwrap();
        assert_eq!(read.limits, model.limits, "{name}");
        assert_eq!(read.controller, model.controller, "{name}");
        assert_eq!(read.links, model.links, "{name}");
        assert_eq!(read.friction, model.friction, "{name}");
        assert_eq!(read.motors, model.motors, "{name}");
        assert_eq!(read.drive, model.drive, "{name}");
        assert_eq!(read.brakes, model.brakes, "{name}");
        assert_eq!(read.wrist, model.wrist, "{name}");
        assert_eq!(read.standstill, model.standstill, "{name}");
        assert_eq!(read.sensors, model.sensors, "{name}");
        assert_eq!(read.effects.len(), model.effects.len(), "{name}");
        assert_eq!([read.mass, read.payload], [model.mass, model.payload], "{name}");
    }
}

#[test]
fn figures_without_a_checkable_source_are_assumed() {
    for model in robots() {
        for origin in &model.origins {
            let source = origin.source.as_deref().unwrap();
            let doubtful = source.contains("without a source")
                || source.contains("copies of other robots")
                || source.contains("nothing is published");
            assert!(!doubtful || origin.provenance == Some(Provenance::Assumed), "{origin:?}");
        }
    }
}

/// `RobotComponents` has the ranges of the two arm lengths swapped.
#[test]
fn each_arm_length_of_the_irb1600_has_its_own_ranges() {
    for name in ["IRB1600-6/1.2", "IRB1600-10/1.2"] {
        let model = robot(name);
        assert_eq!((range(&model, 2), range(&model, 3)), ([-63.0, 110.0], [-235.0, 55.0]));
    }
    for name in ["IRB1600-6/1.45", "IRB1600-8/1.45", "IRB1600-10/1.45"] {
        let model = robot(name);
        assert_eq!((range(&model, 2), range(&model, 3)), ([-90.0, 120.0], [-245.0, 65.0]));
    }
}

#[test]
fn axis_2_of_every_irb1600_has_a_wider_range_while_axis_1_points_forward() {
    for (name, wide, within) in [
        ("IRB1600-6/1.2", 136.0_f64, 100.0_f64),
        ("IRB1600-10/1.2", 136.0, 100.0),
        ("IRB1600-6/1.45", 150.0, 95.0),
        ("IRB1600-8/1.45", 150.0, 95.0),
        ("IRB1600-10/1.45", 150.0, 95.0),
    ] {
        let model = robot(name);
        let at = |q1: f64, q2: f64| {
            limits_ok(&model, &[q1.to_radians(), q2.to_radians(), 0.0, 0.0, 0.0, 0.0]).is_ok()
        };
        assert!(at(within, wide) && at(-within, wide), "{name}");
        assert!(!at(within + 0.1, wide) && !at(within, wide + 0.1), "{name}");
    }
}

/// The data sheet has priority; the URDF has 450 deg/s for axis 6.
#[test]
fn data_sheets_come_before_other_sources() {
    assert_eq!(speeds(&robot("IRB1600-6/1.2")), Some(vec![150, 160, 170, 320, 400, 460]));
    assert_eq!(speeds(&robot("IRB1600-8/1.45")), Some(vec![180, 180, 200, 400, 400, 460]));
    assert_eq!(speeds(&robot("IRB6650S-200/3.0")), Some(vec![110, 90, 90, 150, 120, 235]));
}

/// The URDFs have the flange in a fixed joint, so that c4 seems to be 0.
#[test]
fn the_flange_belongs_to_axis_6() {
    for (name, c4) in [("IRB2400-12/1.55", 0.085), ("IRB2400", 0.085), ("IRB4400L-30/2.43", 0.14)] {
        assert_eq!(robot(name).kinematics.opw.unwrap().c4, c4, "{name}");
    }
}

#[test]
fn the_wrist_of_a_gofa_is_offset() {
    let gofas: Vec<Model> = robots().filter(|model| model.name.starts_with("CRB15000")).collect();
    assert_eq!(gofas.len(), 3);
    for model in &gofas {
        assert!(model.kinematics.opw.is_none(), "{}", model.name);
        // 80 mm between axes 4 and 6.
        let zero = fk(model, &[0.0; 6]).translation.vector;
        let raised: f64 =
            model.kinematics.joints[..4].iter().map(|joint| joint.translation.z).sum();
        assert!((zero.z - raised - 0.08).abs() < 1e-12, "{}", model.name);
    }
    assert_eq!(range(&robot("GoFa 5"), 6), [-270.0, 270.0]);
}

#[test]
fn inverse_kinematics_of_a_gofa_recover_the_angles() {
    let model = robot("CRB15000-5/0.95");
    let mut missed = 0;
    for n in 0..200 {
        let turn = |k: f64| 2.6 * (f64::from(n) * k).sin();
        let q =
            [turn(1.3), 0.6 * turn(2.1), -1.2 + 0.5 * turn(0.7), turn(3.3), turn(1.9), turn(2.7)];
        let pose = fk(&model, &q);
        for solution in ik_all(&model, &pose).unwrap() {
            let back = fk(&model, &solution);
            assert!((back.translation.vector - pose.translation.vector).norm() < 1e-8);
        }
        let found = ik_conf(&model, &pose, conf_of(&model, &q));
        let same = |p: [f64; 6]| p.iter().zip(&q).all(|(a, b)| (a - b).abs() < 1e-6);
        missed += usize::from(!found.is_ok_and(same));
    }
    assert!(missed <= 4, "{missed} of 200");
}

/// The dimensions of `irb6640` in ROS come from meshes (b = 11 mm, c3 = 1395 mm).
#[test]
fn no_arm_has_dimensions_measured_on_meshes() {
    for model in robots() {
        if let Some(opw) = &model.kinematics.opw {
            assert_eq!(opw.b, 0.0, "{}", model.name);
            assert!((opw.c3 - 1.395).abs() > 1e-6, "{}", model.name);
        }
    }
    let ambiguous = find("IRB6640").unwrap_err().to_string();
    assert!(
        ambiguous.contains("IRB6640-180/2.55, IRB6640-185/2.8, IRB6640-235/2.55"),
        "{ambiguous}"
    );
}

/// ROS states −155…95.
#[test]
fn axis_2_of_the_irb2600_has_the_right_sign() {
    for name in ["IRB2600-12/1.65", "IRB2600-20/1.65", "IRB2600-12/1.85"] {
        assert_eq!(range(&robot(name), 2), [-95.0, 155.0], "{name}");
    }
}

/// `RobotComponents` states −120…125, a controller −125…120.
#[test]
fn axis_5_of_the_irb4600_has_the_range_of_the_controller() {
    let model = robot("IRB4600-40/2.55");
    assert!(
        (range(&model, 5)[0] + 125.0).abs() < 1e-3 && (range(&model, 5)[1] - 120.0).abs() < 1e-3
    );
}

/// ROS states 180 deg/s for every axis, and no other source has speeds.
#[test]
fn dummy_speeds_are_left_out() {
    for name in ["IRB52-7/1.2", "IRB52-7/1.45"] {
        assert_eq!(speeds(&robot(name)), None, "{name}");
    }
}

/// ARTE has the speeds of the IRB140 and one set of masses for many robots.
#[test]
fn copied_figures_are_left_out() {
    for model in robots() {
        if model.name != "IRB140-6/0.81" {
            assert_ne!(speeds(&model), Some(vec![200, 200, 260, 360, 360, 450]), "{}", model.name);
        }
        let masses: Vec<f64> = model.links.iter().map(|link| link.mass).collect();
        assert_ne!(masses, [25.0, 27.0, 15.0, 10.0, 2.5, 1.5], "{}", model.name);
    }
}

/// The controller numbers the joint between axes 2 and 3 as the seventh.
#[test]
fn the_joints_of_a_yumi_are_in_the_order_of_the_chain() {
    for name in ["IRB14000 left", "IRB14000 right"] {
        let model = robot(name);
        assert_eq!(model.dof, 7);
        assert_eq!(range(&model, 3), [-168.5, 168.5]);
        assert_eq!(range(&model, 4), [-123.5, 80.0]);
    }
}

/// The Denavit–Hartenberg table that the files cite.
#[test]
fn the_kinematics_of_a_yumi_agree_with_its_table() {
    const SAME: f64 = 1e-12;
    /// Offset of the angle [rad], d [m], a [m], alpha [rad].
    const TABLE: [[f64; 4]; 7] = [
        [0.0, 0.166, -0.03, -FRAC_PI_2],
        [0.0, 0.0, 0.03, FRAC_PI_2],
        [0.0, 0.2515, 0.0405, -FRAC_PI_2],
        [-FRAC_PI_2, 0.0, 0.0405, -FRAC_PI_2],
        [PI, 0.265, 0.027, -FRAC_PI_2],
        [PI, 0.0, 0.027, -FRAC_PI_2],
        [0.0, 0.036, 0.0, 0.0],
    ];
    for name in ["IRB14000 left", "IRB14000 right"] {
        let model = robot(name);
        for n in 0..20 {
            let q: [f64; 7] =
                std::array::from_fn(|i| (f64::from(n) * (1.3 + 0.4 * i as f64)).sin());
            let expected = q.iter().zip(TABLE).fold(
                Isometry3::identity(),
                |pose, (angle, [offset, d, a, alpha])| {
                    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle + offset);
                    let twist = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), alpha);
                    pose * turn * Translation3::new(a, 0.0, d) * twist
                },
            );
            let miss = fk(&model, &q).inverse() * expected;
            assert!(miss.translation.vector.norm() < SAME, "{name} at {q:?}");
            assert!(miss.rotation.angle() < SAME, "{name} at {q:?}");
        }
    }
}

#[test]
fn robots_with_rods_report_the_angle_of_the_forearm() {
    for model in robots() {
        let rods = ["IRB2400", "IRB4400"].iter().any(|kind| model.name.starts_with(kind));
        assert_eq!(model.kinematics.coupling == Coupling::Parallelogram, rods, "{}", model.name);
    }
    // The forearm keeps its direction while axis 2 turns.
    let model = robot("IRB2400");
    let [a, b] = [0.0, 0.5].map(|q2| fk(&model, &[0.0, q2, 0.2, 0.0, 0.3, 0.0]).rotation);
    assert!(a.angle_to(&b) < 1e-12);
}

/// The Robot Web Services manual: at zero joint angles, [515, 0, 712] mm.
#[test]
fn an_irb140_has_the_zero_pose_of_the_manual() {
    let t = fk(&robot("IRB140-6/0.81"), &[0.0; 6]).translation.vector;
    assert!((t.x - 0.515).abs() < 1e-12 && t.y.abs() < 1e-12 && (t.z - 0.712).abs() < 1e-12);
}

#[test]
fn robots_are_found_by_controller_and_catalogue_names() {
    for (asked, name) in [
        ("ROB1_6700_2.80_205", "IRB6700-205/2.8"),
        ("ROB1_120_0.58_3", "IRB120-3/0.58"),
        ("ROB1_1200_0.9_5_TypeB", "IRB1200-5/0.9"),
        ("ROB1_2600ID_2.00_8", "IRB2600ID-8/2.0"),
        ("ROB2_7600_2.55_400", "IRB7600-400/2.55"),
        ("IRB 4600-40/2.55 Type C", "IRB4600-40/2.55"),
        ("IRB 120-3/0.6", "IRB120-3/0.58"),
        ("irb1010_1_5_037", "IRB1010-1.5/0.37"),
        ("irb1100_4_0475", "IRB1100-4/0.475"),
        ("irb5710_70_270_lid", "IRB5710-70/2.7-LID"),
        ("IRB2400", "IRB2400"),
        ("irb 4400", "IRB4400"),
        ("IRB140", "IRB140-6/0.81"),
        ("GoFa 12", "CRB15000-12/1.27"),
        ("gofa12", "CRB15000-12/1.27"),
        ("IRB14000 right", "IRB14000 right"),
        ("YuMi left", "IRB14000 left"),
    ] {
        assert_eq!(find(asked).unwrap().name, name, "{asked}");
    }
    for name in names() {
        assert_eq!(find(&name.to_lowercase()).unwrap().name, name);
        assert_eq!(find(&name.replace(['-', '/', ' '], "_")).unwrap().name, name);
    }
}

#[test]
fn robots_without_dynamics_have_no_torques() {
    let model = robot("IRB2600-12/1.65");
    let tau = joulepath::arm::dynamics::gravity(
        &model,
        &mut joulepath::arm::dynamics::Data::new(),
        &Load::none(),
        &[0.5; 6],
    );
    assert_eq!(tau, [0.0; 7]);
}
