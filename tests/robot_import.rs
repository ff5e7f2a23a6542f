//! Robots from URDF files, motion configurations and backups, and the messages for invalid ones.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;
use std::process::Output;

use command::{parsed, stderr, stdout, written};
use insta::assert_snapshot;
use joulepath::arm::dynamics::{Data, Load, gravity};
use joulepath::arm::kinematics::{conf_of, fk, ik_all, ik_conf, limits_ok};
use joulepath::arm::robot::{Model, Use, find, from_toml, import_moc, import_urdf, load, ready};
use nalgebra::Vector3;

const INERTIAL: &str = "<inertial><origin xyz=\"0 0 0.1\"/><mass value=\"2\"/>\
     <inertia ixx=\"0.02\" iyy=\"0.02\" izz=\"0.01\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";

fn link(name: &str) -> String {
    format!("<link name=\"{name}\">{INERTIAL}</link>\n")
}

fn joint(name: &str, kind: &str, [parent, child]: [&str; 2], rest: &str) -> String {
    format!(
        "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
         {rest}</joint>\n"
    )
}

fn turning(name: &str, links: [&str; 2], axis: &str) -> String {
    let rest = format!(
        "<origin xyz=\"0 0 0.3\"/><axis xyz=\"{axis}\"/>\
         <limit lower=\"-2\" upper=\"2.5\" effort=\"50\" velocity=\"3\"/>\
         <dynamics damping=\"0.5\" friction=\"1.5\"/>"
    );
    joint(name, "revolute", links, &rest)
}

/// A base, two revolute joints, a part fixed to the last link, and a flange.
fn arm() -> String {
    let reduction = |joint: &str, ratio: u32| {
        format!(
            "<transmission name=\"t{joint}\"><type>x</type><joint name=\"{joint}\"/>\
             <actuator name=\"m\"><mechanicalReduction>{ratio}</mechanicalReduction></actuator>\
             </transmission>\n"
        )
    };
    let links: String = ["base", "upper", "fore", "valve"].map(link).concat();
    format!(
        "<robot name=\"arm\">\n{links}<link name=\"flange\"/>\n{}{}{}{}{}{}</robot>\n",
        turning("j1", ["base", "upper"], "0 0 1"),
        turning("j2", ["upper", "fore"], "0 2 0"),
        joint(
            "f1",
            "fixed",
            ["fore", "valve"],
            "<origin xyz=\"0.2 0 0\" rpy=\"0 0 1.5707963267948966\"/>"
        ),
        joint(
            "f2",
            "fixed",
            ["fore", "flange"],
            "<origin xyz=\"0 0 0.4\" rpy=\"0 1.5707963267948966 0\"/>"
        ),
        reduction("j1", 100),
        reduction("j2", 80),
    )
}

fn model(urdf: &str) -> Model {
    from_toml("arm.urdf", &import_urdf("arm.urdf", urdf).unwrap()).unwrap()
}

fn changed(from: &str, to: &str) -> String {
    let arm = arm();
    assert!(arm.contains(from), "{from}");
    arm.replacen(from, to, 1)
}

#[test]
fn a_urdf_is_read_with_limits_friction_and_gears() {
    let model = model(&arm());
    assert_eq!((model.name.as_str(), model.dof), ("arm", 2));
    assert_eq!(model.limits.position, [[-2.0, 2.5]; 2]);
    assert_eq!(model.limits.velocity, Some(vec![3.0; 2]));
    assert_eq!(model.limits.torque, Some(vec![50.0; 2]));
    assert_eq!(model.friction.coulomb, [1.5; 2]);
    assert_eq!(model.friction.viscous, [0.5; 2]);
    assert_eq!(model.motors.unwrap().ratio, [100.0, 80.0]);
    assert_eq!(model.origins[0].source.as_deref(), Some("arm.urdf"));
}

#[test]
fn the_chain_of_a_urdf_ends_at_its_flange() {
    let model = model(&arm());
    let pose = fk(&model, &[0.0, 0.5]);
    let expected = Vector3::new(0.4 * 0.5_f64.sin(), 0.0, 0.6 + 0.4 * 0.5_f64.cos());
    assert!((pose.translation.vector - expected).norm() < 1e-12);
    let out = pose.rotation * Vector3::z();
    assert!((out - Vector3::new(0.5_f64.cos(), 0.0, -0.5_f64.sin())).norm() < 1e-9);
}

#[test]
fn a_fixed_part_adds_to_the_mass_of_its_link() {
    let model = model(&arm());
    let fore = &model.links[1];
    assert_eq!(fore.mass, 4.0);
    assert!((fore.com - Vector3::new(0.1, 0.0, 0.1)).norm() < 1e-12);
    // Both moments about the common centre of mass, 0.1 m from each.
    assert!((fore.inertia.m33 - (0.02 + 4.0 * 0.01)).abs() < 1e-12);
    let tau = gravity(&model, &mut Data::new(), &Load::none(), &[0.0, 0.0]);
    assert!((tau[1] + 4.0 * 9.81 * 0.1).abs() < 1e-12, "{tau:?}");
}

#[test]
fn a_urdf_without_inertias_has_kinematics_only() {
    let model = model(&arm().replace(INERTIAL, ""));
    assert!(!model.has_dynamics());
    assert_eq!(model.dof, 2);
}

#[test]
fn a_urdf_may_have_seven_joints() {
    let names: Vec<String> = (0..8).map(|i| format!("l{i}")).collect();
    let mut urdf = String::from("<robot name=\"seven\">\n");
    urdf.extend(names.iter().map(|name| link(name)));
    for i in 0..7 {
        let axis = if i % 2 == 0 { "0 0 1" } else { "0 1 0" };
        urdf.push_str(&turning(&format!("j{i}"), [&names[i], &names[i + 1]], axis));
    }
    let model = model(&(urdf + "</robot>"));
    assert_eq!((model.dof, model.links.len()), (7, 7));
}

/// A URDF of an ABB arm has the closed inverse and the same configurations.
#[test]
fn a_urdf_of_an_abb_arm_has_closed_inverse_kinematics() {
    let known = find("IRB1600-10/1.45").unwrap();
    let [a1, c1, c2, c3, c4] = {
        let opw = known.kinematics.opw.as_ref().unwrap();
        [opw.a1, opw.c1, opw.c2, opw.c3, opw.c4]
    };
    let limits = known.limits.position.clone();
    let mut urdf = String::from("<robot name=\"irb\"><link name=\"l0\"/>\n");
    let steps = [
        ([0.0, 0.0, 0.0], "0 0 1"),
        ([a1, 0.0, c1], "0 1 0"),
        ([0.0, 0.0, c2], "0 1 0"),
        ([0.25, 0.0, 0.0], "1 0 0"),
        ([c3 - 0.25, 0.0, 0.0], "0 1 0"),
        ([c4, 0.0, 0.0], "1 0 0"),
    ];
    for (i, ([x, y, z], axis)) in steps.iter().enumerate() {
        let [low, high] = limits[i];
        urdf.extend(["<link name=\"l", &(i + 1).to_string(), "\"/>"]);
        let rest = format!(
            "<origin xyz=\"{x} {y} {z}\"/><axis xyz=\"{axis}\"/>\
             <limit lower=\"{low}\" upper=\"{high}\" effort=\"0\" velocity=\"0\"/>"
        );
        let links = [format!("l{i}"), format!("l{}", i + 1)];
        urdf.push_str(&joint(&format!("j{i}"), "revolute", [&links[0], &links[1]], &rest));
    }
    urdf.push_str("<link name=\"tool0\"/>");
    urdf.push_str(&joint(
        "t",
        "fixed",
        ["l6", "tool0"],
        "<origin rpy=\"0 1.5707963267948966 0\"/>",
    ));
    let model = model(&(urdf + "</robot>"));
    assert!(model.kinematics.opw.is_some());
    for n in 0..200 {
        let q: [f64; 6] = std::array::from_fn(|i| {
            let share = 0.5 + 0.49 * (f64::from(n) * (1.1 + i as f64) + i as f64).sin();
            limits[i][0] + share * (limits[i][1] - limits[i][0])
        });
        let pose = fk(&model, &q);
        assert!((pose.translation.vector - fk(&known, &q).translation.vector).norm() < 1e-9);
        assert_eq!(conf_of(&model, &q), conf_of(&known, &q));
        assert_eq!(ik_all(&model, &pose).unwrap().len(), ik_all(&known, &pose).unwrap().len());
        if limits_ok(&model, &q).is_ok() {
            let found = ik_conf(&model, &pose, conf_of(&model, &q)).unwrap();
            assert!(found.iter().zip(&q).all(|(a, b)| (a - b).abs() < 1e-6), "{found:?} {q:?}");
        }
    }
}

/// The arm with other moments of the link "upper".
fn with_moments(moments: &str) -> String {
    let upper = link("upper").replace("ixx=\"0.02\" iyy=\"0.02\" izz=\"0.01\" ixy=\"0\"", moments);
    changed(&link("upper"), &upper)
}

#[test]
fn inertias_that_no_body_has_become_the_nearest_ones() {
    for (moments, nearest, said) in [
        // More than the sum of the others; negative; not positive definite; none.
        (
            "ixx=\"0.02\" iyy=\"0.02\" izz=\"0.07\" ixy=\"0\"",
            [0.03, 0.03, 0.06],
            "1.732e-2 kg m2 (22.94 %)",
        ),
        (
            "ixx=\"-0.02\" iyy=\"0.02\" izz=\"0.01\" ixy=\"0\"",
            [0.0, 0.015, 0.015],
            "2.121e-2 kg m2",
        ),
        ("ixx=\"0.02\" iyy=\"0.02\" izz=\"0.01\" ixy=\"0.05\"", [0.02, 0.02, 0.04], "exceeds"),
        ("ixx=\"0\" iyy=\"0\" izz=\"0\" ixy=\"0\"", [0.0; 3], "2 kg, but no inertia; a point mass"),
        ("ixx=\"0.02\" iyy=\"0.02\" izz=\"0\" ixy=\"0\"", [0.02, 0.02, 0.0], "a thin rod"),
    ] {
        let model = model(&with_moments(moments));
        let assumed = model.assumed();
        assert_eq!(assumed.len(), 1, "{assumed:?}");
        let named = assumed[0].contains("link \"upper\" in line 3") && assumed[0].contains(said);
        assert!(named, "{assumed:?}");
        assert!(model.links[0].is_consistent());
        assert_eq!(model.links[0].com, Vector3::new(0.0, 0.0, 0.1));
        if !moments.contains("0.05") {
            let found = model.links[0].inertia.diagonal();
            assert!((found - Vector3::from(nearest)).norm() < 1e-12, "{found}");
        }
    }
    assert!(model(&arm()).assumed().is_empty());
}

#[test]
fn every_command_tells_of_a_changed_inertia() {
    let folder = tempfile::tempdir().unwrap();
    let moments = "ixx=\"0.02\" iyy=\"0.02\" izz=\"0.07\" ixy=\"0\"";
    let urdf = written(&folder, "arm.urdf", with_moments(moments));
    let row = |i: u32| {
        let (sin, cos) = (0.1 * f64::from(i)).sin_cos();
        format!("{},{sin},{cos},{},{}\n", 0.02 * f64::from(i), 10.0 * cos, 5.0 - 7.0 * sin)
    };
    let rows: String = (0..400).map(row).collect();
    let log = written(&folder, "log.csv", "t,q1,q2,tau1,tau2\n".to_owned() + &rows);
    for args in [
        &["robots", "check", &urdf][..],
        &["robots", "import", &urdf],
        &["predict", "--robot", &urdf, "--log", &log],
        &["identify", "--robot", &urdf, "--log", &log, "--free", "friction"],
        &["diagnose", "--robot", &urdf, "--log", &log],
    ] {
        let notes = stderr(&command::joulepath(args));
        assert!(notes.contains("the inertia of link \"upper\" in line 3"), "{args:?}: {notes}");
    }
    assert!(robots(&["check", &urdf]).status.success());
}

#[test]
fn wrong_urdfs_name_the_line_and_the_way_out() {
    let eight: String = (0..9).map(|i| link(&format!("l{i}"))).collect::<String>()
        + &(0..8)
            .map(|i| turning(&format!("j{i}"), [&format!("l{i}"), &format!("l{}", i + 1)], "0 0 1"))
            .collect::<String>();
    let texts = [
        // Loops: a link with two parents, and a missing base.
        changed("</robot>", &(turning("j3", ["valve", "fore"], "1 0 0") + "</robot>")),
        changed("</robot>", &(turning("j3", ["fore", "base"], "1 0 0") + "</robot>")),
        changed(&link("upper"), "<link name=\"upper\"/>\n"),
        changed("<mass value=\"2\"/>", ""),
        changed("</joint>", "<mimic joint=\"j2\"/></joint>"),
        changed("value=\"2\"", "value=\"-2\"").replace("base", "fundament"),
        arm().replace("value=\"2\"", "value=\"-2\""),
        format!("<robot name=\"eight\">\n{eight}</robot>"),
        changed("type=\"revolute\"", "type=\"prismatic\""),
        changed("lower=\"-2\"", "lower=\"3\""),
        changed("<axis xyz=\"0 2 0\"/>", "<axis xyz=\"0 0 0\"/>"),
        changed("friction=\"1.5\"", "friction=\"-1\""),
        changed("<mechanicalReduction>80</mechanicalReduction>", ""),
        changed(">80<", ">eighty<"),
        changed("link=\"valve\"", "link=\"vlave\""),
        changed("name=\"valve\"", "name=\"fore\""),
        changed("<robot name=\"arm\">", "<robot name=\"arm\"><xacro:property name=\"a\"/>"),
        arm()[..900].to_owned(),
        // Invalid attributes: missing, not a number, in other units.
        changed("<robot name=\"arm\">", "<robot>"),
        changed("<mass value=\"2\"/>", "<mass/>"),
        changed("value=\"2\"", "value=\"2,5 kg\""),
        changed("value=\"2\"", "value=\"1e400\""),
        changed("ixx=\"0.02\"", "ixx=\"nan\""),
        changed("ixx=\"0.02\" ", ""),
        changed("<origin xyz=\"0 0 0.3\"/>", "<origin xyz=\"0 0 300\"/>"),
        changed("<origin xyz=\"0 0 0.3\"/>", "<origin xyz=\"0 0 0.3\" rpy=\"0 90 0\"/>"),
        changed("<origin xyz=\"0 0 0.3\"/>", "<origin xyz=\"0 nan 0.3\"/>"),
        changed("<origin xyz=\"0 0 0.3\"/>", "<origin xyz=\"0 0.3\"/>"),
        changed("lower=\"-2\" upper=\"2.5\"", "lower=\"-115\" upper=\"115\""),
        changed("lower=\"-2\"", "lower=\"nan\""),
        changed("velocity=\"3\"", "velocity=\"-3\""),
        changed("type=\"revolute\"", "type=\"revolve\""),
        changed("<parent link=\"base\"/>", ""),
        changed(">80<", ">-80<"),
        changed("<joint name=\"j2\"/>", "<joint name=\"j3\"/>"),
        changed("izz=\"0.01\"", "izz=\"10000\"").replacen("0.02", "10000", 2),
        changed(
            "<link name=\"flange\"/>",
            "<link name=\"flange\"><visual><geometry><mesh/></geometry></visual></link>",
        ),
        changed("<joint name=\"j1\"", "<joint"),
        changed("</robot>", &format!("{}{}</robot>", "<a>".repeat(9000), "</a>".repeat(9000))),
        "<model/>".to_owned(),
        String::new(),
        "<robot name=\"empty\"><link name=\"base\"/></robot>".to_owned(),
    ];
    let messages: Vec<String> = texts
        .iter()
        .map(|text| match import_urdf("arm.urdf", text) {
            Ok(_) => "none".to_owned(),
            Err(error) => error.to_string(),
        })
        .collect();
    assert_snapshot!(messages.join("\n"));
}

fn configuration() -> String {
    fs::read_to_string("fixtures/backup/SYSPAR/MOC.cfg").unwrap()
}

#[test]
fn a_motion_configuration_is_an_overlay_of_its_robot() {
    let model =
        from_toml("MOC.cfg", &import_moc("MOC.cfg", &configuration(), None).unwrap()).unwrap();
    let plain = find("IRB1600-10/1.45").unwrap();
    assert_eq!(model.name, plain.name);
    assert_eq!(model.kinematics.base.translation.vector, Vector3::new(0.0, 0.0, 0.2));
    assert_eq!(model.limits.position[2], [-4.27606, 1.13446]);
    assert_eq!(model.limits.tcp_speed, Some(5.5));
    assert!(model.limits.position_if.is_empty() && !plain.limits.position_if.is_empty());
    assert_eq!(model.limits.velocity, plain.limits.velocity);
    assert_eq!(model.controller.friction_level.as_ref().unwrap()[1], 0.22);
    // The load of the upper arm belongs to link 3.
    assert!((model.links[2].mass - plain.links[2].mass - 4.5).abs() < 1e-12);
    let range = model.origins.iter().find(|origin| origin.table == "limits").unwrap();
    assert_eq!(range.source.as_deref(), Some("MOC.cfg, ROB1_1600_1.45_10"));
}

#[test]
fn rods_limit_the_angle_between_the_arms() {
    let text = configuration()
        .replace("ROB1_1600_1.45_10", "ROB1_4400L_2.43_30")
        .replace("1.13446", "1.13446 -upper_joint_coupl_bound 0.9 -lower_joint_coupl_bound -0.8");
    let model = from_toml("MOC.cfg", &import_moc("MOC.cfg", &text, None).unwrap()).unwrap();
    assert_eq!(model.limits.coupled, Some([-0.8, 0.9]));
    let at = |q2: f64, q3: f64| limits_ok(&model, &[0.0, q2, q3, 0.0, 0.0, 0.0]).is_ok();
    assert!(at(0.2, 1.0) && at(0.2, -0.5) && !at(0.2, 1.11) && !at(0.2, -0.7));
}

#[test]
fn wrong_configurations_name_the_place_and_the_way_out() {
    let whole = configuration();
    let second = "\r\n      -name \"ROB_2\" -use_robot_type \"ROB2_120_0.58_3\"\r\n#\r\nARM:";
    let two = whole.replace("#\r\nARM:", second);
    let texts = [
        whole[..whole.len() / 2].to_owned(),
        whole[..whole.find("-name \"rob1_4\"").unwrap()].to_owned(),
        whole[..whole.find("ARM:").unwrap()].to_owned(),
        whole[..whole.find("ROBOT:").unwrap()].to_owned(),
        whole.replace("-upper_joint_bound 2.0944", "-upper_joint_bound two"),
        whole.replace(" -upper_joint_bound 2.0944", ""),
        whole.replace("-use_robot_type \"ROB1_1600_1.45_10\"", ""),
        whole.replace("ROB1_1600_1.45_10", "ROB1_1600_1.54_10"),
        two.clone(),
        "EIO:CFG_1.0:6:0::\n".to_owned(),
        String::new(),
        // Truncated at the end of a line, between sections and inside one.
        whole.replace(
            "MOTION_PLANNER:",
            "MOTION_SYSTEM:\r\n\r\n -name \"s\"\r\n#\r\nMOTION_PLANNER:",
        ),
        whole[..whole.find("      -name \"r1_CFric_5\"").unwrap()].to_owned(),
        whole.replace("-upper_joint_bound 2.0944", "-upper_joint_bound -2.0944"),
    ];
    let messages: Vec<String> = texts
        .iter()
        .map(|text| match import_moc("MOC.cfg", text, None) {
            Ok(_) => "none".to_owned(),
            Err(error) => error.to_string(),
        })
        .collect();
    assert_snapshot!(messages.join("\n"));
    assert!(import_moc("MOC.cfg", &two, Some("rob_1")).is_ok());
    // Any truncation inside a line is detected.
    for end in (1..whole.len()).filter(|end| !whole[..*end].ends_with(['\n', '\r'])) {
        assert!(import_moc("MOC.cfg", &whole[..end], None).is_err(), "{end}");
    }
}

/// Every message has the line of the file, the key, and the permitted values.
#[test]
fn wrong_values_of_a_configuration_are_refused_with_their_line() {
    let whole = configuration();
    let cut = |end: &str| whole[..whole.find(end).unwrap() + end.len()].to_owned();
    let load = "-mass 4.5";
    let uses = |name: &str| format!("-name \"rob1_2\" -use_customer_arm_load \"{name}\"");
    for (text, place, words) in [
        (
            whole.replace("speed 5.5", "speed -5"),
            5,
            "-linear_max_speed of MOTION_PLANNER is \"-5\"",
        ),
        (
            whole.replace("2.0944", "120"),
            17,
            "-upper_joint_bound of rob1_2 is \"120\"; it must be an",
        ),
        (whole.replace("-1.5708", "2.5"), 17, "rob1_2 turns from 2.5 to 2.0944 rad"),
        (whole.replace(load, "-mass -4.5"), 36, "-mass of r1_load_3 is \"-4.5\""),
        (whole.replace("-inertia_y 0.02", "-inertia_y 0.2"), 37, "r1_load_3: no body has"),
        (
            whole.replace("r1_load_1\"", "r1_load_9\" -mass 2"),
            34,
            "no arm carries the load r1_load_9",
        ),
        (whole.replace("-name \"rob1_2\"", &uses("valve")), 17, "is \"valve\", which the section"),
        (cut("ARM_LOAD:\r\n"), 32, "is cut off here"),
        (cut("CFRIC_BLOCK:\r\n"), 39, "is cut off here"),
        (whole.replace("_1600_1.45_10", "_9999_1.45_10"), 9, "unknown robot"),
        (whole.replace("-inertia_y", "-mass 3 -inertia_y"), 37, "a second -mass"),
        (whole.repeat(2), 56, "a second \"motion_planner_1\" in MOTION_PLANNER"),
        (
            whole.replace(
                "_pos_z 0.2",
                "_pos_z 0.2 -base_frame_orient_u0 3 -base_frame_orient_u1 2",
            ),
            10,
            "a quaternion of length 3.606",
        ),
    ] {
        let message = import_moc("MOC.cfg", &text, None).unwrap_err().to_string();
        assert!(message.starts_with(&format!("MOC.cfg:{place}: ")), "{place}: {message}");
        assert!(message.contains(words), "{words}: {message}");
    }
}

#[test]
fn a_load_is_added_once_to_the_arm_that_names_it() {
    let plain = find("IRB1600-10/1.45").unwrap();
    let added = |text: &str| -> Vec<f64> {
        let toml = import_moc("MOC.cfg", text, None).unwrap();
        let model = from_toml("MOC.cfg", &toml).unwrap();
        model.links.iter().zip(&plain.links).map(|(link, own)| link.mass - own.mass).collect()
    };
    let whole = configuration();
    let uses = "-name \"rob1_2\" -use_customer_arm_load \"r1_load_3\"";
    assert_eq!(added(&whole), [0.0, 0.0, 4.5, 0.0, 0.0, 0.0]);
    let moved = whole.replace("-name \"rob1_2\"", uses);
    assert_eq!(added(&moved), [0.0, 4.5, 0.0, 0.0, 0.0, 0.0]);
}

/// The check detects wrong units that no bound of a single value reveals.
#[test]
fn the_check_reports_values_in_other_units() {
    let folder = tempfile::tempdir().unwrap();
    let link =
        "[[link]]\nmass = 31\ncom = [0, 0, 0]\ninertia = [530000, 540000, 120000, 0, 0, 0]\n";
    for (more, place) in [
        (link.repeat(6), "[[link]] 1"),
        (
            "[limits]\nacceleration = [859, 802, 1031, 2000, 2000, 2000]\n".into(),
            "joint 1: 859 rad/s2",
        ),
        ("[limits]\nvelocity = [90, 90, 90, 90, 90, 90]\n".into(), "joint 1: 90 rad/s"),
        (format!("[limits]\nposition = [{}]\n", "[-45, 45],".repeat(6)), "joint 1: up to 45 rad"),
        ("[kinematics.opw]\na1 = 15\n".into(), "m long"),
    ] {
        let text = format!("extends = \"IRB1600-10/1.45\"\n{more}");
        let path = written(&folder, "robot.toml", text);
        let output = robots(&["check", &path]);
        assert_eq!(output.status.code(), Some(1), "{more}");
        assert!(stdout(&output).contains(place), "{}", stdout(&output));
    }
}

#[test]
fn missing_data_are_added_by_extending_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, "arm.urdf", arm().replace(INERTIAL, ""));
    let message = ready(&load(&path).unwrap(), Use::Predict).unwrap_err().to_string();
    let extends = format!("extends = \"{path}\"");
    assert!(message.contains(&extends), "{message}");
    let link = "[[link]]\nmass = 1\ncom = [0, 0, 0]\ninertia = [1, 1, 1, 0, 0, 0]\n";
    let overlay = written(&folder, "more.toml", format!("{extends}\n{}", link.repeat(2)));
    assert!(ready(&load(&overlay).unwrap(), Use::Predict).is_ok());
}

#[test]
fn show_prints_exact_position_ranges() {
    let shown = stdout(&robots(&["show", "IRB14000 right"]));
    assert!(shown.contains("-143.5…43.5 ") && shown.contains("-123.5…80 "), "{shown}");
}

#[test]
fn the_robot_of_the_backup_passes_the_check() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("cell.toml").display().to_string();
    assert!(robots(&["import", "fixtures/backup", "--out", &out]).status.success());
    let output = robots(&["check", &out]);
    assert_eq!(output.status.code(), Some(0), "{}", stdout(&output));
}

fn robots(args: &[&str]) -> Output {
    command::joulepath(&[&["robots"], args].concat())
}

#[test]
fn every_known_robot_passes_the_check() {
    let output = robots(&["check", "--format", "json"]);
    assert_eq!(output.status.code(), Some(0));
    let found = parsed(&output);
    assert!(found["passed"].as_u64().unwrap() >= 60);
    let all = found["robots"].as_array().unwrap();
    assert!(all.iter().all(|robot| robot["sound"] == true));
    let entry = |name: &str| all.iter().find(|robot| robot["name"] == name).unwrap();
    assert_eq!(entry("IRB1600-10/1.45")["lacks"]["optimize"], serde_json::json!([]));
    // Missing data are estimated; RAPID has six axes.
    assert_eq!(entry("IRB52-7/1.2")["lacks"]["optimize"], serde_json::json!([]));
    let lacks = &entry("IRB14000 left")["lacks"]["simulate"];
    assert!(!lacks.as_array().unwrap().is_empty(), "{lacks}");
}

#[test]
fn show_prints_each_value_with_its_interval() {
    let output = robots(&["show", "IRB2600-20/1.65", "--format", "json"]);
    let found = parsed(&output);
    let figures = found["figures"].as_array().unwrap();
    for figure in figures {
        let bound = |i: usize| figure["interval"][i].as_f64().unwrap();
        let value = figure["value"].as_f64().unwrap();
        assert!(bound(0) < value && value < bound(1), "{figure}");
    }
    assert!(figures.iter().any(|figure| figure["figure"] == "link 2: mass, kg"));
    let text = stdout(&robots(&["show", "IRB2600-20/1.65"]));
    assert!(text.contains("link 2: mass, kg") && text.contains("base power, W"), "{text}");
}

#[test]
fn imported_robots_can_be_used_and_extended() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    fs::write(at("arm.urdf"), arm()).unwrap();
    fs::write(
        at("ours.toml"),
        "extends = \"arm.urdf\"\nname = \"ours\"\n[limits]\ntcp_speed = 2\n",
    )
    .unwrap();
    assert_eq!(load(&at("ours.toml")).unwrap().limits.tcp_speed, Some(2.0));
    for (source, name) in [(at("arm.urdf"), "arm"), ("fixtures/backup".into(), "IRB1600-10/1.45")] {
        let out = at("out.toml");
        let output = robots(&["import", &source, "--out", &out]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        assert_eq!(load(&out).unwrap().name, name);
        assert!(stdout(&robots(&["import", &source])).contains(name));
    }
    assert_eq!(load(&at("arm.urdf")).unwrap().links, model(&arm()).links);
}

#[test]
fn wrong_files_give_exit_code_2_and_one_message() {
    let folder = tempfile::tempdir().unwrap();
    let urdf = written(&folder, "arm.urdf", arm().replace("value=\"2\"", "value=\"-2\""));
    let cut = written(&folder, "MOC.cfg", &configuration()[..700]);
    let unit =
        written(&folder, "unit.toml", "extends = \"IRB140\"\n[limits]\ntcp_speed_mm = 250\n");
    let key = written(
        &folder,
        "key.toml",
        "extends = \"IRB140\"\n[limits]\nvelocity = [\"200 deg/s\"]\n",
    );
    for args in [
        ["check", &urdf],
        ["import", &urdf],
        ["show", &urdf],
        ["import", &cut],
        ["check", &unit],
        ["check", &key],
        ["show", "IRB140-6/0.18"],
        ["import", "nowhere.urdf"],
        ["import", "Cargo.toml"],
        ["import", "fixtures/hard"],
    ] {
        let output = robots(&args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        let message = stderr(&output);
        assert_eq!(message.trim_end().lines().count(), 1, "{message}");
        assert!(message.starts_with("error: ") && output.stdout.is_empty(), "{message}");
    }
}
